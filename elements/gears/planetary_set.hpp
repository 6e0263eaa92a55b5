#pragma once
/// PlanetarySet: a rigid planetary set or differential: three shafts, one constraint.
///
///   (1 + i) q_carrier = q_sun + i q_ring          the same for the nominal speeds;     i = z_ring/z_sun
///
/// Nodes: sun, ring, carrier. Exact: the constraint is eliminated, no stiffness stands for it. Torques of the three
/// shafts of an ideal set are as 1 : i : -(1 + i). i = 1 is a bevel differential: carrier = mean of both side gears.
/// Planets' inertias are left out, or in the carrier's. What turns nominally follows from the rest of the train: one
/// shaft held or grounded, or two of them tied. A set free on all sides with a reference shaft has two nominal motions:
/// together = true says that its three shafts turn alike (a differential straight ahead). For elastic meshes, backlash
/// and planets of their own: GearMesh with a carrier as its third node.
/// Limits: a given motion of one of the nodes is refused; lockstep leaves such models to runs one by one; the train's
/// matrices are kept dense (some thousand nodes at most).
#include <drev/core/element_interface.hpp>
#include <drev/elements/not_given.hpp>

#include <cmath>

namespace drev {

class PlanetarySet final : public Element {
 public:
  struct Params {
    double ratio = kNotGiven;  ///< i [-], > 0; or the teeth
    int teeth_sun = 0;         ///< z_sun, > 0
    int teeth_ring = 0;        ///< z_ring, > 0
    bool together = false;     ///< nominally all three turn alike
  };
  explicit PlanetarySet(Params params) : params_(params) {}

  const Params& params() const { return params_; }
  double ratio() const {
    return std::isnan(params_.ratio) ? static_cast<double>(params_.teeth_ring) / params_.teeth_sun
                                     : params_.ratio;
  }
  std::string_view type() const override { return "planetary set"; }
  int min_nodes() const override { return 3; }
  void check(ParameterCheck& check) const override;
  void describe(int nodes, Terms& terms) const override;

 private:
  Params params_;
};

}  // namespace drev
