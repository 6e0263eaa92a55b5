#pragma once
/// What a model file says of a node.
#include <drev/app/model_file/fields.hpp>
#include <drev/core/motion.hpp>

namespace drev::app {

/// Unset numbers are NaN.
struct NodeParams {
  int kind = 0;
  bool hold = false;
  double constant_speed, initial_value, initial_rate;
  double nominal_speed, nominal_angle = 0.0;  ///< of the reference shaft
  struct RunUp {
    double speed_0, speed_1, time_0 = 0.0, time_1;
  };
  bool has_run_up = false;
  RunUp run_up;  ///< of the reference shaft
  /// Deviation u = offset + amplitude cos(2 pi f t + phase).
  struct Given {
    double amplitude, frequency, phase = 0.0, offset = 0.0;
    MotionPoint operator()(double t) const;
  };
  bool has_given = false;
  Given given;
  NodeParams();
};
const std::vector<std::string>& node_kind_names();
void list_fields(Fields& f, NodeParams& p);

}  // namespace drev::app
