#pragma once
/// Which method in time suits a system.
///
/// The choice follows what the system is, not taste:
///   1. exact propagation, where why_not_exact() finds nothing and it is affordable. Nothing is cheaper
///      (docs/which_method.md).
///   2. dormand_prince with steps controlled to 1e-4, where exact propagation cannot be used (general
///      elements, motions that are unknown functions) and it is affordable.
///   3. sdirk4, controlled likewise: implicit, for what is too stiff, too large or too long for 1 or 2.
///   4. average acceleration at the model's step, where errors cannot be estimated: a general element has a
///      history, whose error no estimate sees, or the mass matrix is singular.
///
/// Affordable: p (20 + unknowns + 10 contacts) <= 1.5e10 products, about half a minute; p: 25 for exact
/// propagation, 70 for dormand_prince, in each step of 3/omega of the fastest mode.
#include <drev/solvers/method.hpp>

#include <string>

namespace drev {

class System;

struct MethodChoice {
  Method method;
  std::string reason;  ///< one sentence without full stop
  /// What exact propagation would cost: products times the last factor above; 0 where it cannot be used.
  double exact_work = 0.0;
};

inline constexpr double kControlledTolerance = 1e-4;  ///< of stepping methods, unless another is asked for

/// duration: to be simulated [s]; step: where it comes to constant steps [s].
MethodChoice choose_method(const System& system, double duration, double step);

/// Laws that have a gap or pieces.
long contact_count(const System& system);

/// max(sqrt |M^-1 K|, |M^-1 C|) [1/s], contacts closed, general elements as at the start, within some percent
/// from below (20 steps of the power method). Throws SolverError where M is singular.
double fastest_rate(const System& system);

}  // namespace drev
