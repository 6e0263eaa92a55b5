#pragma once
/// Methods in time, of two families. The implicit one-step methods of structural dynamics, generalized-alpha:
///
///   M [(1-a_m) a1 + a_m a0] + (1-a_f) F(t1, z1, v1) + a_f F(t0, z0, v0) = 0,   F = forces - loads
///   z1 = z0 + h v0 + h^2 [(1/2 - beta) a0 + beta a1],   v1 = v0 + h [(1 - gamma) a0 + gamma a1]
///
/// Second order if gamma = 1/2 - a_m + a_f. The forces are weighted (trapezoidal form), not evaluated at a
/// mean state, so that a piecewise-linear force stays piecewise linear in a1.
///
/// And Runge-Kutta methods, explicit or with one diagonal coefficient g (butcher_tableau.hpp): each implicit
/// stage is a Newmark-like step of coefficients beta = g^2, gamma = g.
/// Sources: Newmark 1959; Hilber, Hughes, Taylor 1977, doi:10.1002/eqe.4290050306;
/// Chung, Hulbert 1993, doi:10.1115/1.2900803.
#include <drev/core/weights.hpp>

#include <memory>
#include <string>

namespace drev {

struct ButcherTableau;

struct StepScheme {
  std::string name;
  double alpha_m = 0.0, alpha_f = 0.0;
  double beta = 0.25, gamma = 0.5;
  std::shared_ptr<const ButcherTableau> tableau = {};  ///< of a Runge-Kutta method, else null

  int order() const;
  bool is_explicit() const;
  /// Weights of S with the acceleration as unknown: S a1 = rhs. Works for beta = 0 too.
  Weights weights(double h) const {
    return {1.0 - alpha_m, (1.0 - alpha_f) * gamma * h, (1.0 - alpha_f) * beta * h * h};
  }
};

/// Newmark: beta >= 0, gamma >= 1/2. (1/4, 1/2) is average acceleration: unconditionally stable for
/// linear systems, no numerical damping, may gain energy at impacts. (1/6, 1/2) linear acceleration and
/// (0, 1/2) central difference are stable for omega h below 2 sqrt(3) and 2 only. gamma > 1/2 is of first
/// order. Throws ModelError outside the range.
StepScheme newmark(double beta = 0.25, double gamma = 0.5);
StepScheme average_acceleration();

/// HHT: 0 <= alpha <= 1/3, beta = (1 + alpha)^2 / 4, gamma = 1/2 + alpha; second order.
/// Deviation: alpha is positive here, negative in the paper.
StepScheme hht(double alpha = 0.05);

/// Chung-Hulbert: spectral radius at infinity 0 <= rho_inf <= 1; second order, least low-frequency
/// damping for its high-frequency damping. rho_inf = 1 keeps all, 0 annihilates in one step.
StepScheme generalized_alpha(double rho_inf = 0.8);

/// rho_inf-Bathe: 0 <= rho_inf <= 1, two stages of one matrix; second order. Without a number 0, the
/// original method, which annihilates what is too fast for the step; tr_bdf2 is the same.
StepScheme bathe(double rho_inf = 0.0);
StepScheme runge_kutta(ButcherTableau tableau);

/// By name, as the command line gives it: average_acceleration, linear_acceleration, central_difference,
/// newmark:BETA,GAMMA, hht:ALPHA, generalized_alpha:RHO_INF, bathe:RHO_INF, tr_bdf2, sdirk4, rk4,
/// dormand_prince. Throws ModelError with the nearest name.
StepScheme step_scheme(const std::string& text);
/// The names that step_scheme() knows, without numbers.
const std::vector<std::string>& step_scheme_names();

}  // namespace drev
