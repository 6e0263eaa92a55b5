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
  std::vector<double> speeds_rpm;  ///< options.speeds as they were given [rpm]
  bool absolute_sum = false;       ///< true: also gives the sum of the orders' amplitudes without phases
};

/// Unbalanced mean torque of a floating part at some of the speeds [N m at the reference shaft].
struct LeftOver {
  std::size_t count = 0, speeds = 0;  ///< number of speeds with unbalanced torque, and of all speeds
  double most = 0.0, at_rpm = 0.0;
  double of = 0.0;  ///< sum of the absolute mean torques that act on the part; 0: unknown
  /// Notes one of the speeds; it counts if the torque is more than `little`.
  void note(double left_over, double speed_rpm, double little);
};
/// The sentence on the unbalanced torque; moving: what the figures describe if `balance` names no node.
std::string left_over_sentence(const LeftOver& left, const std::string& part, const std::string& moving,
                               const std::string& balance);
/// Whether a coupling has a stiffness that follows the mean torque: modes and vibration then depend on it.
bool follows_mean_torque(const SweepRequest& request);
/// Sentences on the unbalanced mean torque of floating parts.
std::vector<std::string> left_over_notes(const SweepRequest& request, const LinearSweep& sweep);
/// Sentences that a reader must know: unbalanced mean torque, orders left out, contacts that open.
std::vector<std::string> sweep_notes(const SweepRequest& request, const LinearSweep& sweep);
std::string sweep_as_text(const SweepRequest& request, const LinearSweep& sweep);
/// The result as an object of kind "sweep" of docs/results.schema.json.
Json sweep_object(const SweepRequest& request, const LinearSweep& sweep);
/// One critical speed, as in the list of that object.
Json critical_object(const LinearSweep& sweep, const SweepCritical& critical);
/// One row for each speed: half range, maximum, minimum, mean, heat and twist of each section.
std::string sweep_as_csv(const SweepRequest& request, const LinearSweep& sweep);
/// One row for each speed and order: amplitude and phase of each section.
std::string orders_as_csv(const SweepRequest& request, const LinearSweep& sweep);
/// One row for each critical speed.
std::string criticals_as_csv(const LinearSweep& sweep);

}  // namespace drev::app
