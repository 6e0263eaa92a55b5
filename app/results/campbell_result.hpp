#pragma once
/// The Campbell diagram of a linear sweep as text, JSON and tables: modes over speed, and where orders meet them.
#include <string>

#include "app/results/sweep_result.hpp"

namespace drev::app {

std::string campbell_as_text(const SweepRequest& request, const LinearSweep& sweep);
/// The result as an object of kind "campbell" of docs/results.schema.json.
Json campbell_object(const SweepRequest& request, const LinearSweep& sweep);
/// One row for each speed: frequency and damping ratio of each mode.
std::string campbell_modes_as_csv(const LinearSweep& sweep);

}  // namespace drev::app
