#pragma once
/// TimeCurve: a formula over time between two instants, as a chain of cubics, constant before and after them.
///
///   g(t) = f(t),   from <= t <= to;      f(from) before,   f(to) after
///
/// Between knots g is the cubic that has f's values and slopes at both ends (Hermite). Stretches are halved until the cubic
/// differs from f by at most `accuracy` times the largest |f| at a quarter, half and three quarters of each; its error is
/// h^4 |f''''|/384. Kinks and jumps of f between `from` and `to` are to be named as breakpoints: f is continuous from the right
/// there, and each side has its own slope.
/// Source: C. de Boor, A Practical Guide to Splines, Springer, 1978, chapter IV (cubic Hermite interpolation).
#include <drev/core/error.hpp>
#include <drev/core/law/dual.hpp>
#include <drev/elements/formula.hpp>
#include <drev/elements/not_given.hpp>

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace drev {

class TimeCurve {
 public:
  struct Params {
    std::function<Dual(const Dual&)> function = {};  ///< f over the time [s], by C++; pure
    std::optional<Formula> formula = {};             ///< instead, of variable 0, the time [s]
    double from = kNotGiven, to = kNotGiven;         ///< s, from < to
    std::vector<double> breakpoints = {};            ///< between them, ascending [s]: kinks and jumps of f
    double accuracy = 1e-10;                         ///< of the largest |f| [-], 1e-14 to 1e-2
  };
  TimeCurve() = default;  ///< empty: check() reports it
  explicit TimeCurve(Params params);

  /// sum terms[k] (s - t)^k for s from t to the next knot.
  std::array<double, 4> at(double t) const;
  const Params& params() const { return params_; }
  const std::vector<double>& knots() const { return knots_; }  ///< `from` and `to` among them [s]
  void check(ParameterCheck& check, const std::string& parameter) const;
  /// The least value of f at knots and at quarters between them; 0 within the accuracy of it.
  double smallest() const;

 private:
  Dual value(double t, bool before) const;
  bool usable() const;
  Params params_;
  std::vector<double> knots_;
  std::vector<std::array<double, 4>> pieces_;  // about the knot that each starts at
  double permitted_ = 0.0;                     // error, by the accuracy
  bool reached_ = true;                        // the accuracy
};

}  // namespace drev
