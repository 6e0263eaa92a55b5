#pragma once
/// A sweep of a nonlinear model as text, JSON and tables.
#include <drev/solvers/nonlinear_sweep.hpp>

#include <string>
#include <vector>

#include "app/base/json_values.hpp"
#include "app/run/model_request.hpp"

namespace drev::app {

/// Sentences on errors, stability, mean torque that does not balance, and what was not found.
std::vector<std::string> branches_notes(const NonlinearSweepOptions& options, const NonlinearSweep& sweep);
std::string branches_as_text(const ModelRequest& model, const NonlinearSweepOptions& options,
                             const NonlinearSweep& sweep);
/// As docs/results.schema.json describes it, kind "branches".
Json branches_object(const ModelRequest& model, const NonlinearSweepOptions& options,
                     const NonlinearSweep& sweep);
/// A row a motion, along each curve: of each section half range, maximum, minimum, mean, heat, deflection.
std::string motions_as_csv(const NonlinearSweep& sweep);
/// A row a motion at the speeds asked for, and order: of each section amplitude and phase.
std::string motion_orders_as_csv(const NonlinearSweep& sweep);
/// A row a fold, doubling of the period, opening of a contact.
std::string changes_as_csv(const NonlinearSweep& sweep);

}  // namespace drev::app
