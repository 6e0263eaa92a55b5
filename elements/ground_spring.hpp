#pragma once
/// GroundSpring: a spring, with a damper beside it, from one node to ground.
///
///   tau = k theta + c omega        theta = q: the node stands still nominally
///
/// The node and whatever is tied to it cannot turn nominally; build() refuses a reference motion
/// there. Takes no part in Rayleigh damping, which is over inertias and shafts: a support has its
/// own damping. On a translational node: N/m, N s/m.
#include <drev/core/element_interface.hpp>
#include <drev/elements/not_given.hpp>

namespace drev {

class GroundSpring final : public Element {
 public:
  struct Params {
    double stiffness = kNotGiven;  ///< k [N m/rad], > 0
    double damping = 0.0;          ///< c [N m s/rad], >= 0
  };
  explicit GroundSpring(Params params) : params_(params) {}

  const Params& params() const { return params_; }
  std::string_view type() const override { return "ground spring"; }
  int min_nodes() const override { return 1; }
  void check(ParameterCheck& check) const override;
  void describe(int nodes, Terms& terms) const override;

 private:
  Params params_;
};

}  // namespace drev
