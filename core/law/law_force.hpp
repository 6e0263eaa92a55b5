#pragma once
/// LawForce: a ScalarForce made of a law of a few lines. The law is any copyable type that states its formula
/// in one of three ways:
///
///   template <class T> T force(const T& x, const T& x_dot) const          y(x, x_dot) over any scalar
///     The slopes come from the same formula by dual numbers (dual.hpp); dissipated power = (y - y at rest)
///     x_dot. Optional: double stored_energy(double x) const, J, whose derivative is y at rest. Without it
///     the energy is the integral of y at rest from x = 0, by 8 Gauss points between kinks: exact to degree
///     15, but it costs as many calls.
///   pieces() const: a vector or span of LawPiece
///     Everything else follows from them (PiecewiseLaw).
///   ScalarResponse operator()(const ScalarInput&) const
///     The law gives slopes, energy and power itself; it may follow the time. It may state pieces too, for
///     the methods that use them: check_element() compares them with the call.
///
/// Optional members are used where the law has them: kinks(), gap(), closed_stiffness(), closed_damping().
#include <drev/core/law/dual.hpp>
#include <drev/core/law/piecewise_law.hpp>
#include <drev/core/scalar_force.hpp>

#include <array>
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

/// Gauss's rule of 8 points on [-1, 1]: those above zero, which stand below it too.
inline constexpr std::array<double, 4> kGaussPoints{0.1834346424956498, 0.5255324099163290,
                                                    0.7966664774136267, 0.9602898564975363};
inline constexpr std::array<double, 4> kGaussWeights{0.3626837833783620, 0.3137066458778873,
                                                     0.2223810344533745, 0.1012285362903763};

/// int_a^b f dx by 8 Gauss points.
template <class F>
double gauss_integral(const F& f, double a, double b) {
  constexpr const auto& x = kGaussPoints;
  constexpr const auto& w = kGaussWeights;
  const double middle = 0.5 * (a + b), half = 0.5 * (b - a);
  double sum = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i)
    sum += w[i] * (f(middle - half * x[i]) + f(middle + half * x[i]));
  return half * sum;
}

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
      const auto at_rest = [this](double s) { return law_.force(s, 0.0); };
      double sum = 0.0, from = 0.0;
      const std::span<const double> all = kinks();
      const auto pass = [&](double kink) {
        sum += gauss_integral(at_rest, from, kink);
        from = kink;
      };
      for (std::size_t i = 0; x > 0.0 && i < all.size(); ++i)
        if (all[i] > 0.0 && all[i] < x) pass(all[i]);
      for (std::size_t i = all.size(); x < 0.0 && i-- > 0;)
        if (all[i] < 0.0 && all[i] > x) pass(all[i]);
      return sum + gauss_integral(at_rest, from, x);
    }
  }

  L law_;
  PiecewiseLaw pieces_;
};

}  // namespace drev
