#pragma once
/// Dashpot: a linear viscous damper between two nodes, or between one node and ground.
///
///   tau = c (omega_b - omega_a)      two nodes;      tau = c omega      one node, to ground
///
/// Ties no nominal speeds to each other: a dashpot whose ends differ in nominal speed (a bearing's
/// drag) loads them with its mean torque too. The output is the part that follows from the
/// deviations, c (q_b' - q_a'). Between translational nodes: N s/m.
#include <drev/core/element_interface.hpp>
#include <drev/elements/not_given.hpp>

namespace drev {

class Dashpot final : public Element {
 public:
  struct Params {
    double damping = kNotGiven;  ///< c [N m s/rad], >= 0
  };
  explicit Dashpot(Params params) : params_(params) {}

  const Params& params() const { return params_; }
  std::string_view type() const override { return "dashpot"; }
  int min_nodes() const override { return 1; }
  int max_nodes() const override { return 2; }
  void check(ParameterCheck& check) const override;
  void describe(int nodes, Terms& terms) const override;

 private:
  Params params_;
};

}  // namespace drev
