#pragma once
/// Freewheel (one-way clutch, overrunning clutch; with one node a backstop): end b may turn ahead of end a, never
/// fall behind it.
///
///   w = omega_b - omega_a >= 0 (one node: omega >= 0)
///   overrunning   w > 0, tau = 0
///   locked        w = 0 exactly, tau <= 0: end a drives end b
///
/// It locks where w reaches zero and lets go where tau would become positive; both are located. No parameters: rigid,
/// without drag while it overruns (add a BearingFriction or Dashpot for that). The speeds at the start must fit it.
/// Only exact propagation takes it; modes see it overrunning.
/// Source: Modelica Standard Library, Rotational.Components.OneWayClutch; F. Pfeiffer, Ch. Glocker, Multibody Dynamics
/// with Unilateral Contacts, Wiley, 1996.
#include <drev/core/element_interface.hpp>
#include <drev/core/law/friction.hpp>

#include <vector>

namespace drev {

class Freewheel final : public Element, public Friction {
 public:
  struct Params {};
  explicit Freewheel(Params /*params*/) {}

  Params params() const { return {}; }
  std::string_view type() const override { return "freewheel"; }
  int min_nodes() const override { return 1; }
  int max_nodes() const override { return 2; }
  void check(ParameterCheck& /*check*/) const override;
  void describe(int nodes, Terms& terms) const override;

  const std::vector<double>& slip_speeds() const override { return zero_; }
  const std::vector<double>& sliding_torques() const override { return zero_; }
  bool one_way() const override { return true; }

 private:
  std::vector<double> zero_{0.0};
};

}  // namespace drev
