#pragma once
/// DeadBandCoupling: a coupling, spline or stop with play and a damper that does not pull.
///
///   tau = y(x, x_dot),     x = theta_b - theta_a between two nodes, x = theta on one node, to ground
///   y = k p + the damper's part,     p = x - gap/2 (x > gap/2), x + gap/2 (x < -gap/2), 0 between
///
/// acts on a as +tau, on b as -tau, as ShaftSpring's. The damping law is one of BacklashLaw's (backlash_law.hpp):
/// `limited` (default) keeps 0 <= y <= 2 k p; without a gap all are y = k x + c x_dot. Each stretch is a piece, so that
/// exact propagation locates its changes. Both ends have one nominal speed while in contact. Between translational
/// nodes: m, N.
/// Source: Modelica Standard Library, Mechanics.Rotational.Components.ElastoBacklash (`limited`).
#include <drev/core/element_interface.hpp>
#include <drev/elements/backlash_law.hpp>

namespace drev {

class DeadBandCoupling final : public Element, public PiecewiseForce {
 public:
  struct Params {
    double stiffness = kNotGiven;  ///< k [N m/rad], > 0
    double gap = 0.0;              ///< TOTAL play [rad], >= 0
    double damping = 0.0;          ///< c [N m s/rad], >= 0
    MeshDamping damping_law = MeshDamping::limited;
    double reference_penetration = kNotGiven;  ///< of `proportional` [rad], > 0; none: gap/40
  };
  explicit DeadBandCoupling(Params params) : PiecewiseForce(pieces_of(params)), params_(params) {}

  const Params& params() const { return params_; }
  std::string_view type() const override { return "dead-band coupling"; }
  int min_nodes() const override { return 1; }
  int max_nodes() const override { return 2; }
  void check(ParameterCheck& check) const override;
  void describe(int nodes, Terms& terms) const override;

 private:
  static bool usable(const Params& p) {
    return p.stiffness > 0.0 && p.gap >= 0.0 && p.damping >= 0.0 && !(p.reference_penetration <= 0.0);
  }
  static std::vector<LawPiece> pieces_of(const Params& p) {
    if (!usable(p)) return {};  // check() says so
    return BacklashLaw({.normal_backlash = p.gap,
                        .damping = p.damping,
                        .damping_law = p.damping_law,
                        .reference_penetration = p.reference_penetration})
        .pieces(p.stiffness);
  }
  Params params_;
};

}  // namespace drev
