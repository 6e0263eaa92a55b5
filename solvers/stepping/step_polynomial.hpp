#pragma once
/// The motion inside a step as the polynomial through what is known at its ends (Hermite):
///
///   3  cubic    z, v                  error of z h^4 z''''/384, for methods up to order 2
///   4  quartic  z, v, a at the end    error of order h^5, for implicit methods up to order 4
///   5  quintic  z, v, a               error of z h^6/46080, for explicit methods up to order 5
///
/// Behind a jump the acceleration at the start is that of a fast mode which an implicit step passes over: carried into the step, it
/// would be a deflection of h^2 times as much.
///
/// v is its derivative, so that the integral of v is the displacement exactly.
#include <drev/core/state.hpp>
#include <drev/solvers/stepping/step_scheme.hpp>

#include <array>

namespace drev {

class StepPolynomial {
 public:
  static constexpr int kTerms = 6;
  using Coefficients = std::array<double, kTerms>;  ///< of s = (t - t_0)/h in 0..1

  /// Keeps references to both. h: between them [s] (their times differ by it except for rounding).
  StepPolynomial(const State& from, const State& to, double h, int degree)
      : from_(from), to_(to), h_(h), degree_(degree) {}
  static int degree_for(const StepScheme& scheme) {
    if (scheme.order() <= 2) return 3;
    return scheme.is_explicit() ? 5 : 4;
  }

  double h() const { return h_; }
  /// Deviations and rates at s; accelerations: derivative of the quintic, else linear between the ends.
  void at(double s, State& inside) const;
  /// Of a scalar from its values, rates and accelerations at the ends.
  Coefficients through(double x_0, double v_0, double a_0, double x_1, double v_1, double a_1) const;
  /// Of the unknowns' part of a term, sum of coeff z.
  Coefficients of(const std::vector<Entry>& entries) const;

 private:
  const State& from_;
  const State& to_;
  double h_;
  int degree_;
};

}  // namespace drev
