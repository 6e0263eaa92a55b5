#pragma once
/// LawForce: a ScalarForce made of a law of a few lines. The law is any copyable type that states its formula
/// in one of three ways:
///
///   template <class T> T force(const T& x, const T& x_dot) const          y(x, x_dot) over any scalar
///     The slopes come from the same formula by dual numbers (dual.hpp); dissipated power = (y - y at rest)
///     x_dot. Optional: double stored_energy(double x) const, J, whose derivative is y at rest. Without it
///     the energy is the integral of y at rest from x = 0 to rounding (energy_of), which costs 16 calls
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
#include <drev/core/scalar_force.hpp>

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <span>

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

/// Lobatto's rule of 8 points on [-1, 1]: those above zero, which stand below it too; the last are the ends.
inline constexpr std::array<double, 4> kLobattoPoints{0.2092992179024789, 0.5917001814331423,
                                                      0.8717401485096066, 1.0};
inline constexpr std::array<double, 4> kLobattoWeights{0.4124587946587039, 0.3411226924835044,
                                                       0.2107042271435060, 0.0357142857142857};

/// int_a^b f dx to rounding, by both rules. f may jump at a and at b.
///
/// A part of the range is taken once the rules of Gauss (exact to degree 15) and of Lobatto (to degree 13) agree
/// on it, else it is halved: a polynomial costs 16 calls, a force that bends within a small part of the range 32
/// for each halving. The rule of Lobatto has points at the ends of a part, so that a force which has saturated
/// at all points inside is seen to begin elsewhere. A kink or jump between a and b costs some hundred calls.
/// Limit: what is narrower than the distance between the points, and not at an end, can be missed.
template <class F>
class IntegralToRounding {
 public:
  explicit IntegralToRounding(const F& f) : f_(f) {}

  double over(double a, double b) {
    if (!(a != b)) return 0.0;
    allowed_ = -1.0;
    parts_left_ = kMostParts;
    return part(a, b, f_(just_inside(a, b)), f_(just_inside(b, a)), 0);
  }

 private:
  // After so many a part is less than rounding of the range.
  static constexpr int kMostHalvings = 50;
  // What is rough everywhere would be halved without end.
  static constexpr int kMostParts = 2000;
  static constexpr double kAgreement = 2e-14;  // of the integral of |f| over the whole range
  static constexpr double kInside = 1e-14;     // of the range: where an end is looked at

  /// At a itself a jump may put f on the other side.
  static double just_inside(double a, double b) {
    const double at = a + kInside * (b - a);
    return at == a ? std::nextafter(a, b) : at;
  }

  double part(double a, double b, double f_a, double f_b, int halvings) {
    const double middle = 0.5 * (a + b), half = 0.5 * (b - a);
    double lobatto = kLobattoWeights[3] * (f_a + f_b);
    double size = kLobattoWeights[3] * (std::abs(f_a) + std::abs(f_b));
    for (std::size_t i = 0; i + 1 < kLobattoPoints.size(); ++i) {
      const double low = f_(middle - half * kLobattoPoints[i]), high = f_(middle + half * kLobattoPoints[i]);
      lobatto += kLobattoWeights[i] * (low + high);
      size += kLobattoWeights[i] * (std::abs(low) + std::abs(high));
    }
    const double gauss = gauss_integral(f_, a, b), off = std::abs(gauss - half * lobatto);
    if (allowed_ < 0.0) allowed_ = kAgreement * std::abs(half) * size;
    // Also where the force is not a number: halving would not make it one.
    if (!(off > allowed_) || !std::isfinite(off) || halvings == kMostHalvings || parts_left_-- <= 0)
      return gauss;
    const double f_middle = f_(middle);
    return part(a, middle, f_a, f_middle, halvings + 1) + part(middle, b, f_middle, f_b, halvings + 1);
  }

  const F& f_;
  double allowed_ = -1.0;
  int parts_left_ = 0;
};

/// The stored energy [J] at x of a law whose force at rest is f, 0 at x = 0. Kinks: ascending; the parts between
/// them are integrated each by itself.
template <class F>
double energy_of(const F& f, double x, std::span<const double> kinks) {
  IntegralToRounding<F> integral(f);
  double sum = 0.0, from = 0.0;
  const auto pass = [&](double kink) {
    sum += integral.over(from, kink);
    from = kink;
  };
  for (std::size_t i = 0; x > 0.0 && i < kinks.size(); ++i)
    if (kinks[i] > 0.0 && kinks[i] < x) pass(kinks[i]);
  for (std::size_t i = kinks.size(); x < 0.0 && i-- > 0;)
    if (kinks[i] < 0.0 && kinks[i] > x) pass(kinks[i]);
  return sum + integral.over(from, x);
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
