#pragma once
/// One step of a method on z'' + 2 xi z' + z = 0 as a matrix, measured by running it:
///
///   (z, v/s, a)_1 = A (z, v/s, a)_0,   s = max(1, omega h)
///
/// Methods that carry no acceleration of their own from step to step (it follows from z and v) have a
/// 2 x 2 matrix over (z, v/s).
#include <drev/core/system.hpp>
#include <drev/core/units.hpp>

#include <Eigen/Core>
#include <complex>
#include <string>
#include <vector>

#include "core/dense/eigenvalues.hpp"

namespace drev::problems {

/// J = 1, k = 1: omega = 1, so that the step is omega h.
System unit_frequency(double xi);

/// (z, v, a) after 0, 1 ... count steps of h.
std::vector<Eigen::Vector3d> run_steps(const System& system, const std::string& method, double h, double z,
                                       double v, int count);

/// omega h and xi -> A.
Eigen::MatrixXd amplification(const std::string& method, double omega_h, double xi = 0.0);

/// Roots of A.
std::vector<std::complex<double>> roots(const Eigen::MatrixXd& a);

/// Period elongation (T' - T)/T and amplitude decay per period T' of the principal pair of roots.
struct Distortion {
  double elongation, decay;
};
Distortion distortion(const std::string& method, double step_per_period);

}  // namespace drev::problems
