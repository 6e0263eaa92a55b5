#pragma once
/// DryFriction: what clutch, brake, Coulomb joint and bearing friction share.
///
///   sliding    tau = sign(w) g(t) tau_s(|w|),      w the slip speed, that of end b against end a
///   stuck      w = 0 exactly, |tau| <= g(t) r tau_s(0)
///
/// tau_s is a constant torque, a table of torques over |w|, or geometry x normal force x coefficient of friction,
/// constant or over |w|. Tables are linear between their points, constant beyond. g is the engagement, a table or
/// a formula over time; r the break-away ratio (static over sliding coefficient). The torque opposes w: it stands on the left
/// side of the equation of motion. w is the ACTUAL slip speed, nominal motion included; friction ties no nominal
/// speeds. Between translational nodes: m/s, N.
///
/// Only exact propagation takes it, with sticking located (solvers/exact/friction_series.hpp); modes see it sliding.
/// Source: Modelica Standard Library, Rotational.Components.Clutch, Brake, BearingFriction (mue_pos, cgeo, peak).
#include <drev/core/element_interface.hpp>
#include <drev/core/law/friction.hpp>
#include <drev/elements/not_given.hpp>
#include <drev/elements/time_curve.hpp>
#include <drev/elements/time_table.hpp>

#include <optional>
#include <vector>

namespace drev {

class DryFriction : public Element, public Friction {
 public:
  struct Params {
    double torque = kNotGiven;  ///< tau_s [N m], constant, >= 0
    /// Or over |w| [rad/s], ascending from 0: [N m], >= 0.
    std::vector<double> slip_speeds = {}, sliding_torques = {};
    double normal_force = kNotGiven;          ///< or N, >= 0, with
    double geometry = kNotGiven;              ///< m, > 0: friction faces x mean friction radius (cgeo)
    double friction_coefficient = kNotGiven;  ///< [-], >= 0; or over |w| in slip_speeds:
    std::vector<double> friction_coefficients = {};
    double break_away_ratio = 1.0;             ///< r [-], >= 1 (Modelica: peak)
    std::optional<TimeTable> engagement = {};  ///< g over s [-], >= 0; none: 1
    /// Or by a formula, taken to 1e-10 of its largest value (time_curve.hpp).
    std::optional<TimeCurve> engagement_formula = {};
  };
  explicit DryFriction(Params params);

  const Params& params() const { return params_; }
  void check(ParameterCheck& check) const override;
  void describe(int nodes, Terms& terms) const override;

  const std::vector<double>& slip_speeds() const override { return speeds_; }
  const std::vector<double>& sliding_torques() const override { return torques_; }
  double break_away() const override { return params_.break_away_ratio; }
  Engagement engagement(double t) const override {
    if (params_.engagement_formula) return {params_.engagement_formula->at(t)};
    if (!params_.engagement) return {};
    const CurvePoint g = params_.engagement->at(t);
    return {{g.value, g.slope, 0.0, 0.0}};
  }
  std::vector<double> breakpoints() const override {
    if (params_.engagement_formula) return params_.engagement_formula->knots();
    return params_.engagement ? params_.engagement->breakpoints() : std::vector<double>{};
  }

 private:
  Params params_;
  std::vector<double> speeds_, torques_;
};

}  // namespace drev
