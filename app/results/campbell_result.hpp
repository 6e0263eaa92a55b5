#pragma once
/// The Campbell diagram of a linear sweep as text, JSON and tables: modes over speed, and where orders meet them.
#include <string>

#include "app/results/sweep_result.hpp"

namespace drev::app {

std::string campbell_as_text(const SweepRequest& request, const LinearSweep& sweep);
/// As docs/results.schema.json describes it, kind "campbell".
Json campbell_object(const SweepRequest& request, const LinearSweep& sweep);
/// A row a speed: frequency and damping ratio of each mode.
std::string campbell_modes_as_csv(const LinearSweep& sweep);

}  // namespace drev::app
