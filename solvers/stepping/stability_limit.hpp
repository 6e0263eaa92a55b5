#pragma once
/// The largest step with which a method does not amplify any of a system's modes, contacts closed.
///
///   Newmark, b = beta < g/2, g = gamma, for every mode (its damping ratio xi; Hughes 2000, 9.1)
///                              omega h <= [xi (g - 1/2) + sqrt(g/2 - b + xi^2 (g - 1/2)^2)] / (g/2 - b)
///   explicit Runge-Kutta       |R(lambda h)| <= 1 for every lambda,  R(x) = 1 + x b' (1 - x A)^-1 1
///
/// The eigenvalues are those of Arnoldi's method, exact for up to 120 of them and within the residual of the
/// fastest beyond. Every law counts with its largest slope over a revolution of its phase; the tangents of
/// general elements do not count.
#include <drev/core/system.hpp>
#include <drev/solvers/stepping/step_scheme.hpp>

#include <complex>
#include <optional>
#include <string>
#include <vector>

namespace drev {

/// lambda [1/s] of the damped motion, the fastest ones among them.
std::vector<std::complex<double>> fast_eigenvalues(const System& system);

/// s; infinity for a method that is stable for every step. Throws SolverError if M cannot be factored.
double stability_limit(const System& system, const StepScheme& scheme);

/// Why constant steps of this length cannot be taken; none where they can.
std::optional<std::string> why_unstable(const System& system, const StepScheme& scheme, double step);

}  // namespace drev
