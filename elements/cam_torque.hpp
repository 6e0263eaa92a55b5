#pragma once
/// CamTorque: the torque of a cam on its shaft, from a table over one revolution of the cam.
///
///   tau = scale curve(theta + phase)       on the RIGHT side: positive drives the shaft forward
///
/// theta is the shaft's actual angle (nominal + deviation), so that twist feeds back into the load
/// with the curve's slope as tangent. twist_feedback = false takes the nominal angle: the source's
/// form, in which the twist hardly mattered (S. L. Sunde, NTNU, 2015, program TimeStepping.m), and
/// a load of time alone. The phase places a cylinder in the firing order: the table is entered
/// `phase` ahead. The curve is straight between the table's points, or a periodic cubic spline
/// through them (periodic_curve.hpp), whose pieces it says as a KnottedLoad. Exact propagation takes both
/// as they are.
#include <drev/core/element_interface.hpp>
#include <drev/core/law/knotted_load.hpp>
#include <drev/core/load.hpp>
#include <drev/elements/periodic_curve.hpp>

namespace drev {

class CamTorque final : public Element, public Load, public KnottedLoad {
 public:
  struct Params {
    PeriodicTable angle_table = {};  ///< rad -> N m; period 2 pi (4 pi for a crank's four strokes)
    double phase = 0.0;              ///< rad
    bool twist_feedback = true;
    Interpolation interpolation = Interpolation::linear;  ///< between the table's points
    double scale = 1.0;                                   ///< factor of the table's values [-], finite
  };
  explicit CamTorque(Params params)
      : params_(std::move(params)), curve_(scaled(params_), params_.interpolation) {}

  const Params& params() const { return params_; }
  std::string_view type() const override { return "cam torque"; }
  int min_nodes() const override { return 1; }
  void check(ParameterCheck& check) const override;
  void describe(int /*nodes*/, Terms& terms) const override;

  LoadResponse evaluate(const LoadInput& in) const override {
    const double twist = params_.twist_feedback ? in.deviation : 0.0;
    const CurvePoint p = curve_.at(in.nominal_angle + twist + params_.phase);
    return {.torque = p.value, .dtorque_dangle = params_.twist_feedback ? p.slope : 0.0};
  }
  bool depends_on_motion() const override { return params_.twist_feedback; }
  std::optional<LoadTable> table() const override {
    if (params_.interpolation == Interpolation::cubic) return std::nullopt;
    return curve_.points().as_load(params_.phase);
  }
  CubicPiece piece(double angle, double direction, double /*nominal_speed*/) const override {
    CubicPiece found = curve_.piece(angle + params_.phase, direction);
    found.low -= params_.phase;
    found.high -= params_.phase;
    return found;
  }
  bool piece_follows_speed() const override { return false; }
  Curves curves(double /*angle*/) const override { return {.factor = 1.0}; }
  /// None where it is straight: it is a table then.
  int turns() const override { return params_.interpolation == Interpolation::cubic ? 1 : 0; }

 private:
  static PeriodicTable scaled(const Params& p) {
    if (p.scale == 1.0) return p.angle_table;
    std::vector<double> values = p.angle_table.values();
    for (double& value : values) value *= p.scale;
    return PeriodicTable(p.angle_table.arguments(), std::move(values), p.angle_table.period());
  }

  Params params_;
  PeriodicCurve curve_;
};

}  // namespace drev
