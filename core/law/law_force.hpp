#pragma once
/// LawForce: a ScalarForce made of a law of a few lines. The law is any copyable type that states its formula
/// in one of three ways:
///
///   template <class T> T force(const T& x, const T& x_dot) const          y(x, x_dot) over any scalar
///     The slopes come from the same formula by dual numbers (dual.hpp); dissipated power = (y - y at rest)
///     x_dot. Optional: double stored_energy(double x) const, J, whose derivative is y at rest. Without it
///     the energy is the integral of y at rest from x = 0 to rounding (quadrature.hpp), which costs 16 calls
///     and more where y is no polynomial.
///   pieces() const: a vector or span of LawPiece
///     Everything else follows from them (PiecewiseLaw).
///   ScalarResponse operator()(const ScalarInput&) const
///     The law gives slopes, energy and power itself. If its stored energy follows the time too, it states
///     `static constexpr bool varies = true`, so that the work of what moves the law is counted as given to the
///     train. It may state pieces too, for the methods that use them: check_element() compares them with the call.
///
/// Optional members are used where the law has them: kinks(), gap(), closed_stiffness(), closed_damping().
#include <drev/core/law/dual.hpp>
#include <drev/core/law/piecewise_law.hpp>
#include <drev/core/law/quadrature.hpp>
#include <drev/core/scalar_force.hpp>

#include <concepts>

namespace drev {

template <class L>
concept CalledLaw = requires(const L& law, const ScalarInput& in) {
  { law(in) } -> std::convertible_to<ScalarResponse>;
};
template <class L>
concept FormulaLaw = requires(const L& law, double x, const Dual& d) {
  { law.force(x, x) } -> std::convertible_to<double>;
  { law.force(d, d) } -> std::convertible_to<Dual>;
};
template <class L>
concept LawWithPieces = requires(const L& law) {
  { *std::begin(law.pieces()) } -> std::convertible_to<LawPiece>;
};
template <class L>
concept ScalarLaw = CalledLaw<L> || FormulaLaw<L> || LawWithPieces<L>;

template <ScalarLaw L>
class LawForce final : public ScalarForce {
 public:
  explicit LawForce(L law) : law_(std::move(law)) {
    if constexpr (LawWithPieces<L>) {
      const auto& pieces = law_.pieces();
      pieces_ = PiecewiseLaw(std::vector<LawPiece>(std::begin(pieces), std::end(pieces)));
    }
  }
  ScalarResponse evaluate(const ScalarInput& in) const override {
    if constexpr (CalledLaw<L>)
      return law_(in);
    else if constexpr (FormulaLaw<L>)
      return by_formula(in.x, in.x_dot);
    else
      return pieces_.evaluate(in.x, in.x_dot);
  }
  double closed_stiffness() const override {
    if constexpr (requires { law_.closed_stiffness(); })
      return law_.closed_stiffness();
    else
      return pieces_.empty() ? ScalarForce::closed_stiffness() : pieces_.closed_stiffness();
  }
  double closed_damping() const override {
    if constexpr (requires { law_.closed_damping(); })
      return law_.closed_damping();
    else
      return pieces_.empty() ? ScalarForce::closed_damping() : pieces_.closed_damping();
  }
  std::span<const double> kinks() const override {
    if constexpr (requires { law_.kinks(); })
      return law_.kinks();
    else
      return pieces_.kinks();
  }
  std::optional<Gap> gap() const override {
    if constexpr (requires { law_.gap(); })
      return law_.gap();
    else
      return pieces_.gap();
  }
  bool varies() const override {
    if constexpr (requires { L::varies; })
      return L::varies;
    else
      return false;
  }
  std::span<const LawPiece> pieces() const override { return pieces_.pieces(); }

 private:
  ScalarResponse by_formula(double x, double x_dot) const {
    const Dual y = law_.force(Dual(x, 1.0, 0.0), Dual(x_dot, 0.0, 1.0));
    return {.y = y.value,
            .dy_dx = y.by_x,
            .dy_dx_dot = y.by_x_dot,
            .stored_energy = energy(x),
            .dissipated_power = (y.value - law_.force(x, 0.0)) * x_dot};
  }
  double energy(double x) const {
    if constexpr (requires { law_.stored_energy(x); }) {
      return law_.stored_energy(x);
    } else {
      return energy_of([this](double at) { return law_.force(at, 0.0); }, x, kinks());
    }
  }

  L law_;
  PiecewiseLaw pieces_;
};

}  // namespace drev
