#pragma once
/// The short way to a spring, coupling or contact of one's own: a law of a few lines.
///
///   struct CubicLaw {                       // y = k x + k3 x^3   [N m]
///     double k, k3;
///     template <class T> T force(const T& x, const T&) const { return (k + k3 * x * x) * x; }
///   };
///   model.add<LawElement<CubicLaw>>("coupling", {"engine", "pump"}, {.k = 2e4, .k3 = 5e6});
///
/// law_force.hpp lists the ways to state a law. A law may state `static constexpr std::string_view type`, the
/// name that findings and reports call it by. Between two nodes x = q_b - q_a; on one node it acts to ground,
/// x = q. If the law has a member `void check(ParameterCheck&) const`, it is called when the model is built.
#include <drev/core/element.hpp>
#include <drev/core/law/law_force.hpp>

namespace drev {

template <ScalarLaw L>
class LawElement final : public Element {
 public:
  using Params = L;
  explicit LawElement(Params law) : law_(law), force_(std::move(law)) {}

  std::string_view type() const override {
    if constexpr (requires { L::type; })
      return L::type;
    else
      return "law element";
  }
  int min_nodes() const override { return 1; }
  int max_nodes() const override { return 2; }
  void check(ParameterCheck& check) const override {
    if constexpr (requires { law_.check(check); }) law_.check(check);
  }
  void describe(int nodes, Terms& terms) const override {
    terms.scalars.push_back({.b = relative_motion(nodes), .force = &force_});
    terms.speed_ratio_constraints.push_back(
        {.b = relative_motion(nodes), .only_in_contact = force_.gap().has_value()});
  }

  const Params& params() const { return law_; }

 private:
  L law_;
  LawForce<L> force_;
};

}  // namespace drev
