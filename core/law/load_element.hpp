#pragma once
/// The short way to a torque of one's own on a node: a formula of a few lines.
///
///   struct Fan {                       // tau = -c w |w|   [N m]
///     double c;                        // N m s^2/rad^2, > 0
///     template <class T> T torque(double t, const T& angle, const T& speed) const {
///       using std::abs;
///       return -c * speed * abs(speed);
///     }
///   };
///   model.add<LoadElement<Fan>>("fan", {"rotor"}, {.c = 0.2});
///
/// t [s]; angle: the node's actual angle n phi + q [rad] (m); speed: n phi' + q' [rad/s] (m/s). The torque [N m] (force
/// [N]) stands on the RIGHT side: positive drives the node forward. T is any scalar: over dual numbers (dual.hpp) the
/// slopes that implicit steps, modes and sweeps need come from the same formula. It is pure and callable from any
/// thread, and smooth but at its breakpoints; exact propagation projects it (solvers/exact/smooth_loads.hpp).
///
/// Optional members: `static constexpr std::string_view type`, the name that findings and reports call it by;
/// `void check(ParameterCheck&) const`; `std::vector<double> breakpoints() const`, times [s] at which it jumps or kinks;
/// `static constexpr bool follows_motion = false` where it follows t alone.
#include <drev/core/element.hpp>
#include <drev/core/law/load_response.hpp>

#include <concepts>
#include <string_view>
#include <utility>
#include <vector>

namespace drev {

template <class L>
concept TorqueFormula = requires(const L& law, double t, const Dual& d) {
  { law.torque(t, d, d) } -> std::convertible_to<Dual>;
};

template <TorqueFormula L>
class LoadElement final : public Element, public Load {
 public:
  using Params = L;
  explicit LoadElement(Params law) : law_(std::move(law)) {}

  std::string_view type() const override {
    if constexpr (requires { L::type; })
      return L::type;
    else
      return "load element";
  }
  int min_nodes() const override { return 1; }
  void check(ParameterCheck& check) const override {
    if constexpr (requires { law_.check(check); }) law_.check(check);
  }
  void describe(int /*nodes*/, Terms& terms) const override { terms.loads.push_back({0, this}); }

  LoadResponse evaluate(const LoadInput& in) const override {
    return response_of(
        in, [&](const Dual& angle, const Dual& speed) -> Dual { return law_.torque(in.t, angle, speed); });
  }
  bool depends_on_motion() const override {
    if constexpr (requires { L::follows_motion; })
      return L::follows_motion;
    else
      return true;
  }
  std::vector<double> breakpoints() const override {
    if constexpr (requires { law_.breakpoints(); })
      return law_.breakpoints();
    else
      return {};
  }

  const Params& params() const { return law_; }

 private:
  L law_;
};

}  // namespace drev
