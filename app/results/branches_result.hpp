#pragma once
/// A sweep of a nonlinear model as text, JSON and tables.
#include <drev/solvers/nonlinear_sweep.hpp>

#include <string>
#include <vector>

#include "app/base/json_values.hpp"
#include "app/run/model_request.hpp"

namespace drev::app {

/// Sentences on errors, stability, unbalanced mean torque, couplings, and motions that were not found.
std::vector<std::string> branches_notes(const System& system, const NonlinearSweepOptions& options,
                                        const NonlinearSweep& sweep);
/// Of these the sentences on unbalanced mean torque, and on loads that no curve contains.
std::vector<std::string> excitation_notes(const NonlinearSweepOptions& options, const NonlinearSweep& sweep);
std::string branches_as_text(const ModelRequest& model, const NonlinearSweepOptions& options,
                             const NonlinearSweep& sweep);
/// The result as an object of kind "branches" of docs/results.schema.json.
Json branches_object(const ModelRequest& model, const NonlinearSweepOptions& options,
                     const NonlinearSweep& sweep);
/// One row for each motion along each curve: half range, maximum, minimum, mean, heat and deflection of each
/// section.
std::string motions_as_csv(const NonlinearSweep& sweep);
/// One row for each order of each motion at the given speeds: amplitude and phase of each section.
std::string motion_orders_as_csv(const NonlinearSweep& sweep);
/// One row for each fold, period doubling, branching, torus and opening of a contact.
std::string changes_as_csv(const NonlinearSweep& sweep);

}  // namespace drev::app
