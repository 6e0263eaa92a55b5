#pragma once
/// Inertia: a rigid disc on one node.
///
///   M = J                        torque J theta_2dot on the left side
///
/// On a translational node the same element is a mass m [kg].
/// Takes part in Rayleigh damping (C = a M + b K).
#include <drev/core/element_interface.hpp>
#include <drev/elements/not_given.hpp>

namespace drev {

class Inertia final : public Element {
 public:
  struct Params {
    double inertia = kNotGiven;  ///< J [kg m^2], > 0; on a translational node the mass [kg]
  };
  explicit Inertia(Params params) : params_(params) {}

  const Params& params() const { return params_; }
  std::string_view type() const override { return "inertia"; }
  int min_nodes() const override { return 1; }
  void check(ParameterCheck& check) const override;
  void describe(int /*nodes*/, Terms& terms) const override;

 private:
  Params params_;
};

}  // namespace drev
