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
#include <drev/core/range.hpp>
#include <drev/core/weights.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

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

/// A number that a method takes after its name.
struct MethodParameter {
  const char* name;  ///< as findings and forms spell it: "alpha" stands as ALPHA in "hht[:ALPHA]"
  Range range;
  std::optional<double> standard = {};  ///< where it is not given; none: it must be given
  std::string form() const;             ///< "ALPHA"
};

inline constexpr MethodParameter kNewmarkBeta{"beta", {0.0, 1e3}}, kNewmarkGamma{"gamma", {0.5, 1e3}};
inline constexpr MethodParameter kHhtAlpha{"alpha", {0.0, 1.0 / 3.0}, 0.05};
inline constexpr MethodParameter kGeneralizedAlphaRho{"rho_inf", {0.0, 1.0}, 0.8};
inline constexpr MethodParameter kBatheRho{"rho_inf", {0.0, 1.0}, 0.0};

/// Newmark, kNewmarkBeta and kNewmarkGamma. (1/4, 1/2) is average acceleration: unconditionally stable for
/// linear systems, no numerical damping, may gain energy at impacts. (1/6, 1/2) linear acceleration and
/// (0, 1/2) central difference are stable for omega h below 2 sqrt(3) and 2 only. gamma > 1/2 is of first
/// order. Throws ModelError outside the range.
StepScheme newmark(double beta, double gamma);
StepScheme average_acceleration();

/// HHT, kHhtAlpha: beta = (1 + alpha)^2 / 4, gamma = 1/2 + alpha; second order.
/// Deviation: alpha is positive here, negative in the paper.
StepScheme hht(double alpha = *kHhtAlpha.standard);

/// Chung-Hulbert, kGeneralizedAlphaRho: spectral radius at infinity rho_inf; second order, least
/// low-frequency damping for its high-frequency damping. rho_inf = 1 keeps all, 0 annihilates in one step.
StepScheme generalized_alpha(double rho_inf = *kGeneralizedAlphaRho.standard);

/// rho_inf-Bathe, kBatheRho: two stages of one matrix; second order. Without a number 0, the
/// original method, which annihilates what is too fast for the step; tr_bdf2 is the same.
StepScheme bathe(double rho_inf = *kBatheRho.standard);
StepScheme runge_kutta(ButcherTableau tableau);

/// A method in time by its name: all that a parser, a message, a help text or a completion needs of it.
struct MethodRow {
  const char* name;
  std::vector<MethodParameter> parameters = {};
  const char* help;  ///< one line without full stop
  /// The scheme with its numbers, one for each parameter; null: a method that makes no steps by a scheme.
  StepScheme (*scheme)(const std::vector<double>& numbers) = nullptr;
  /// How it is written: "hht[:ALPHA]", "newmark:BETA,GAMMA".
  std::string form() const;
};

/// Every step scheme. A row is all that a new one needs to be known by name.
const std::vector<MethodRow>& step_schemes();
/// Their names, without numbers.
std::vector<std::string> names_of(const std::vector<MethodRow>& rows);
/// "must be average_acceleration, hht[:ALPHA], ... or dormand_prince".
std::string must_be_one_of(const std::vector<MethodRow>& rows);
/// What is said of a name that none of the rows has: the nearest one, and how each is written.
std::string is_no_method(const std::string& name, const std::vector<MethodRow>& rows);

/// The scheme of a row of step_schemes(), as MethodRow::form() writes it. Throws ModelError with the nearest
/// name, the form or the range that would be right.
StepScheme step_scheme(const std::string& text);

}  // namespace drev
