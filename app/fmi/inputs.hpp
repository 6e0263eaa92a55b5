#pragma once
/// Inputs by which an FMU's importer drives a model: torques on nodes, and speeds of nodes whose motion is
/// prescribed.
#include <drev/core/element_interface.hpp>
#include <drev/core/load.hpp>
#include <drev/core/model.hpp>

#include <memory>
#include <optional>

namespace drev::app {

/// An input over a communication step: value + slope (t - t_0), in the input's unit and per second.
struct InputSignal {
  double t_0 = 0.0;  ///< begin of the communication step [s]
  double value = 0.0;
  double slope = 0.0;
  double at(double t) const { return value + slope * (t - t_0); }
};

/// A torque [N m] (or force [N]) on a node, on the right side: positive drives the node forward. The signal may
/// change between runs, not within one.
class InputTorque final : public Element, public Load {
 public:
  explicit InputTorque(std::shared_ptr<const InputSignal> signal) : signal_(std::move(signal)) {}

  std::string_view type() const override { return "input torque"; }
  int min_nodes() const override { return 1; }
  void check(ParameterCheck& /*check*/) const override {}
  void describe(int nodes, Terms& terms) const override;
  LoadResponse evaluate(const LoadInput& in) const override { return {.torque = signal_->at(in.t)}; }
  bool depends_on_motion() const override { return false; }
  std::optional<LoadStretch> stretch(double t, double /*angle*/, double /*direction*/) const override {
    return LoadStretch{.torque = signal_->at(t), .time_slope = signal_->slope};
  }

 private:
  std::shared_ptr<const InputSignal> signal_;
};

/// The motion of a prescribed node whose actual speed w [rad/s] (or m/s) is an input. Its deviation is
///   u(t) = u_0 + w (t - t_0) + w' (t - t_0)^2 / 2 - n (phi(t) - phi(t_0)).
struct SpeedInput {
  InputSignal signal;      ///< w
  double deviation = 0.0;  ///< deviation u_0 at t_0 [rad or m]
  MotionPoint at(double t, double ratio, const std::optional<Motion>& nominal) const;
};

/// The model with input torques on nodes, and with speeds in place of the motions of prescribed nodes.
struct InputNode {
  std::string node;
  std::shared_ptr<const InputSignal> torque = {};  ///< either torque or speed is set
  std::shared_ptr<const SpeedInput> speed = {};
};
/// Throws ModelError for nodes that do not exist, and for speeds of nodes whose motion is not prescribed or
/// whose inertia is coupled to others, where a jump of the speed would be an impulse.
Model with_inputs(const Model& model, const std::vector<InputNode>& inputs);

/// Name of the element of an input torque, whose channel is NAME.torque_Nm.
std::string input_element(const std::string& node);

}  // namespace drev::app
