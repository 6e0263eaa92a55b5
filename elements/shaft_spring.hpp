#pragma once
/// ShaftSpring: a massless shaft between two nodes.
///
///   tau = k (theta_b - theta_a) + c (omega_b - omega_a)        end b minus end a
///
/// tau acts on a as +tau, on b as -tau: a positive twist pulls a forward and b back. Reported with
/// the sign of the twist. Both ends have the same nominal speed. The stiffness takes part in
/// Rayleigh damping; the shaft's own damping c adds to that. Between translational nodes: N/m and
/// N s/m.
#include <drev/core/element_interface.hpp>
#include <drev/elements/not_given.hpp>

namespace drev {

class ShaftSpring final : public Element {
 public:
  struct Params {
    double stiffness = kNotGiven;  ///< k [N m/rad], > 0
    double damping = 0.0;          ///< c [N m s/rad], >= 0, besides Rayleigh damping
  };
  explicit ShaftSpring(Params params) : params_(params) {}

  const Params& params() const { return params_; }
  std::string_view type() const override { return "shaft spring"; }
  int min_nodes() const override { return 2; }
  void check(ParameterCheck& check) const override;
  void describe(int nodes, Terms& terms) const override;

 private:
  Params params_;
};

}  // namespace drev
