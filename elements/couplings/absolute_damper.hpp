#pragma once
/// AbsoluteDamper: a viscous damper on the deviation of one node from its nominal motion.
///
///   tau = c q'          on the LEFT side; q' = omega - n phi'
///
/// What calculations by orders call absolute damping: the engine's damping at each crank throw, a bearing, whose mean
/// torque is part of the load. The nominal motion loses nothing by it; a Dashpot on one node brakes that too.
#include <drev/core/element_interface.hpp>
#include <drev/elements/not_given.hpp>

namespace drev {

class AbsoluteDamper final : public Element {
 public:
  struct Params {
    double damping = kNotGiven;  ///< c [N m s/rad], >= 0; on a translational node N s/m
  };
  explicit AbsoluteDamper(Params params) : params_(params) {}

  const Params& params() const { return params_; }
  std::string_view type() const override { return "absolute damper"; }
  int min_nodes() const override { return 1; }
  void check(ParameterCheck& check) const override;
  void describe(int nodes, Terms& terms) const override;

 private:
  Params params_;
};

}  // namespace drev
