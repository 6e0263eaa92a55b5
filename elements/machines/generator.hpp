#pragma once
/// Generator: a synchronous machine on a stiff grid, and its short circuit.
///
///   tau = -torque - k_s q - c_s q'                                                    before the fault, RIGHT side
///   tau = -torque - exp(-(t - t_0)/T) (A_1 sin(w_e (t - t_0)) + A_2 sin(2 w_e (t - t_0)))   from t_0 on, besides
///
/// q: deviation of the rotor from its nominal motion, which is the grid's: the synchronous torque holds it. k_s:
/// synchronising torque per mechanical radian, = pole pairs times that per electrical radian; c_s: damper winding.
/// Undamped swing of the rotor J alone: sqrt(k_s/J). k_s and c_s act during the fault too. The air-gap torque of a
/// short circuit at the terminals: A_1 at the grid's frequency w_e = 2 pi f, A_2 at twice of it (two-phase; 0 for
/// three-phase), both decaying with T; usual values A_1 = torque/x'', from the maker. Without k_s: an island set, on
/// which a speed governor acts. Inertia is an Inertia beside it. Torque channels: _gap, a load's, is tau without k_s and c_s;
/// _synchronous, as a spring's, is k_s q + c_s q' of the LEFT side: tau = _gap - _synchronous.
/// Source: W. Nuernberg, R. Hanitsch, Die Pruefung elektrischer Maschinen, 1987 (short-circuit torque); numbers: the maker's.
#include <drev/core/element_interface.hpp>
#include <drev/core/load.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/not_given.hpp>

#include <cmath>

namespace drev {

class Generator final : public Element, public Load {
 public:
  struct Params {
    double torque = 0.0;                 ///< that it takes [N m], finite
    double synchronous_stiffness = 0.0;  ///< k_s [N m/rad], >= 0
    double synchronous_damping = 0.0;    ///< c_s [N m s/rad], >= 0
    double fault_time = kNotGiven;       ///< t_0 [s], >= 0; not given: no short circuit
    double fault_torque = 0.0;           ///< A_1 [N m]
    double fault_torque_double = 0.0;    ///< A_2, at twice the frequency [N m]
    double grid_frequency = 50.0;        ///< f [Hz], > 0
    double fault_decay = kNotGiven;      ///< T [s], > 0; not given: no decay
  };
  explicit Generator(Params params) : params_(params) {}

  const Params& params() const { return params_; }
  std::string_view type() const override { return "generator"; }
  int min_nodes() const override { return 1; }
  void check(ParameterCheck& check) const override;
  void describe(int nodes, Terms& terms) const override;

  LoadResponse evaluate(const LoadInput& in) const override {
    LoadResponse r{.torque = -params_.torque};
    const double t = in.t - params_.fault_time;
    if (!faults() || t < 0.0) return r;
    const double phase = kTwoPi * params_.grid_frequency * t;
    const double decay = std::isnan(params_.fault_decay) ? 1.0 : std::exp(-t / params_.fault_decay);
    r.torque -= decay * (params_.fault_torque * std::sin(phase) +
                         params_.fault_torque_double * std::sin(2.0 * phase));
    return r;
  }
  bool depends_on_motion() const override { return false; }
  std::vector<double> breakpoints() const override {
    return faults() ? std::vector<double>{params_.fault_time} : std::vector<double>{};
  }
  std::optional<LoadStretch> stretch(double /*t*/, double /*angle*/, double /*direction*/) const override {
    if (faults()) return std::nullopt;
    return LoadStretch{.torque = -params_.torque};
  }
  std::optional<LoadSlopes> steepest(const LoadRanges& over) const override;

 private:
  bool faults() const { return !std::isnan(params_.fault_time); }
  Params params_;
};

}  // namespace drev
