#pragma once
/// A linear sweep as text, JSON and tables.
#include <drev/solvers/periodic/linear_sweep.hpp>

#include <string>
#include <vector>

#include "app/base/json_values.hpp"
#include "app/run/model_request.hpp"

namespace drev::app {

struct SweepRequest {
  ModelRequest model;
  LinearSweepOptions options;
  std::vector<double> speeds_rpm;  ///< options.speeds as they were given
  bool absolute_sum = false;       ///< the sum of the orders' amplitudes, too
};

/// Mean torque of a part that floats, left over at some of the speeds [N m at the reference shaft].
struct LeftOver {
  std::size_t count = 0, speeds = 0;  ///< at how many of how many speeds
  double most = 0.0, at_rpm = 0.0;
  double of = 0.0;  ///< the mean torques that act on the part; 0: not known
  /// Notes one of the speeds, where it is more than `little`.
  void note(double left_over, double speed_rpm, double little);
};
/// The sentence on it; moving: what the figures are of where `balance` names no node that takes it up.
std::string left_over_sentence(const LeftOver& left, const std::string& part, const std::string& moving,
                               const std::string& balance);
/// Sentences on what a reader must know: mean torque that does not balance, orders left out, contacts that open.
std::vector<std::string> sweep_notes(const SweepRequest& request, const LinearSweep& sweep);
std::string sweep_as_text(const SweepRequest& request, const LinearSweep& sweep);
/// As docs/results.schema.json describes it, kind "sweep".
Json sweep_object(const SweepRequest& request, const LinearSweep& sweep);
/// One of the criticals, as it stands in that list.
Json critical_object(const LinearSweep& sweep, const SweepCritical& critical);
/// A row a speed: of each section half range, maximum, minimum, mean, heat, twist.
std::string sweep_as_csv(const SweepRequest& request, const LinearSweep& sweep);
/// A row a speed and order: of each section amplitude and phase.
std::string orders_as_csv(const SweepRequest& request, const LinearSweep& sweep);
/// A row a critical speed.
std::string criticals_as_csv(const LinearSweep& sweep);

}  // namespace drev::app
