#pragma once
/// RayleighDamping: damping of the whole model, proportional to mass and stiffness. Takes no nodes.
///
///   C = a M + b K,      xi(omega) = a/(2 omega) + b omega/2
///
/// M and K are those of the inertias and shafts; meshes, supports and dashpots have damping of
/// their own. Several such elements add up. a damps slow modes most and drags on the deviation from
/// the nominal motion; b damps fast modes most.
///
/// Source: S. L. Sunde, Mechanical analysis of camshaft system on a marine engine, NTNU, 2015,
/// equations 3.7 to 3.9.
#include <drev/core/element_interface.hpp>

namespace drev {

class RayleighDamping final : public Element {
 public:
  struct Params {
    double alpha_mass = 0.0;      ///< a [1/s], >= 0
    double beta_stiffness = 0.0;  ///< b [s], >= 0
  };
  explicit RayleighDamping(Params params) : params_(params) {}

  /// a and b that give the damping ratios xi [-] at the circular frequencies omega [rad/s]:
  ///   a = 2 w1 w2 (xi1 w2 - xi2 w1)/(w2^2 - w1^2),  b = 2 (xi2 w2 - xi1 w1)/(w2^2 - w1^2).
  /// Throws ModelError where a or b would be negative: modes far below or far above would gain
  /// energy.
  static Params from_two_modes(double omega_1, double xi_1, double omega_2, double xi_2);
  /// a = 2 xi omega, b = 0.
  static Params mass_proportional(double omega, double xi);
  /// a = 0, b = 2 xi/omega.
  static Params stiffness_proportional(double omega, double xi);

  const Params& params() const { return params_; }
  std::string_view type() const override { return "Rayleigh damping"; }
  int min_nodes() const override { return 0; }
  void check(ParameterCheck& check) const override;
  void describe(int /*nodes*/, Terms& terms) const override;

 private:
  Params params_;
};

}  // namespace drev
