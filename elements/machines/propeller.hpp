#pragma once
/// Propeller: the torque that a propeller or fan takes of its shaft, with its blades' harmonics.
///
///   tau = -Q (w/w_0)|w/w_0| (1 + sum a_i cos(order_i theta + phase_i)) - (a - 2) Q(w_n)/|w_n| (w - w_n)
///
/// on the RIGHT side: it brakes. Q: torque at the rated speed w_0; w, theta: actual speed and angle of the node; orders
/// are per turn of the propeller: multiples of the number of blades. About the nominal speed w_n the quadratic law
/// damps with c = 2 Q(w_n)/w_n by itself; the last term is for a measured or an Archer damping factor a other than 2,
/// c = a Q(w_n)/w_n (a in 30/pi = 9.549ths where it is stated per rpm: a = 30 N m per N m/rpm is 30/9.549 = 3.14). It
/// acts where the node turns nominally. Inertia, entrained water included, is an Inertia beside it.
/// Source: quadratic law (propeller at constant advance ratio); S. Archer, Torsional vibration damping coefficients for
/// marine propellers, Engineering 1955 (by its title).
#include <drev/core/element_interface.hpp>
#include <drev/core/law/load_response.hpp>
#include <drev/elements/harmonic.hpp>
#include <drev/elements/not_given.hpp>

#include <cmath>

namespace drev {

class Propeller final : public Element, public Load {
 public:
  struct Params {
    double rated_torque = kNotGiven;       ///< Q [N m], > 0
    double rated_speed = kNotGiven;        ///< w_0 [rad/s], > 0
    double damping_factor = 2.0;           ///< a [-], >= 0; 2: the quadratic law's own
    std::vector<Harmonic> harmonics = {};  ///< of the torque: order, part of the mean [-], rad
    bool twist_feedback = true;            ///< harmonics at the actual angle
  };
  explicit Propeller(Params params) : params_(std::move(params)) {}

  const Params& params() const { return params_; }
  std::string_view type() const override { return "propeller"; }
  int min_nodes() const override { return 1; }
  void check(ParameterCheck& check) const override;
  void describe(int /*nodes*/, Terms& terms) const override;

  LoadResponse evaluate(const LoadInput& in) const override {
    return response_of(in, [&](const Dual& angle, const Dual& w) {
      return torque(w, sum_at(params_.harmonics, params_.twist_feedback ? angle : Dual(in.nominal_angle)),
                    in.nominal_speed);
    });
  }
  std::optional<LoadSlopes> steepest(const LoadRanges& over) const override;

 private:
  template <class T>
  T torque(const T& w, const T& harmonics, double nominal_speed) const {
    const Params& p = params_;
    const double factor = p.rated_torque / (p.rated_speed * p.rated_speed);
    const double extra = (p.damping_factor - 2.0) * factor * std::abs(nominal_speed);
    return -factor * w * abs(w) * (1.0 + harmonics) - extra * (w - nominal_speed);
  }
  Params params_;
};

}  // namespace drev
