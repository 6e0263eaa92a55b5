#pragma once
/// The lowest eigenpairs of K x = lambda M x by the implicitly restarted Lanczos method on the
/// shifted and inverted problem (ARPACK's mode 3):
///
///   (K - sigma M)^-1 M x = mu x,  mu = 1 / (lambda - sigma)
///
/// sigma below the whole spectrum: the largest mu are the lowest lambda. Tolerance 0: ARPACK's own,
/// machine precision. The start vector is fixed and has no symmetry (a symmetric one cannot reach
/// all copies of a repeated eigenvalue), so results repeat exactly.
///
/// ARPACK keeps its state in static variables: calls from several threads wait for each other.
///
/// Source: R. B. Lehoucq, D. C. Sorensen, C. Yang, ARPACK Users' Guide, SIAM 1998,
/// doi:10.1137/1.9780898719628, sections 3.2 and 4.4.
#include <drev/core/system.hpp>

#include <functional>
#include <string>

namespace drev {

enum class ArpackStatus {
  not_computed,
  success,
  not_converged,  ///< fewer than count pairs after max_iterations restarts
  failed          ///< ARPACK refused its input or lost its basis: see reason
};

struct ShiftInvertProblem {
  int size = 0;                                           ///< number of unknowns
  int count = 0;                                          ///< eigenpairs wanted, 1 <= count < size
  double sigma = 0.0;                                     ///< (rad/s)^2
  std::function<void(const double* b, double* x)> solve;  ///< x = (K - sigma M)^-1 b
  std::function<void(const double* x, double* y)> mass;   ///< y = M x; empty: M = I
  int basis = 0;             ///< Lanczos vectors kept; 0: max(2 count + 1, 20); at most size
  int start = 0;             ///< another number: another start vector
  int max_iterations = 300;  ///< restarts
};

struct ShiftInvertResult {
  ArpackStatus status = ArpackStatus::not_computed;
  std::string reason;       ///< empty with success
  Vector lambda;            ///< ascending [(rad/s)^2]
  Eigen::MatrixXd vectors;  ///< columns x, x' M x = 1
  int solves = 0;           ///< with K - sigma M
};

/// Entries between 0.5 and 1.5, no two alike.
Vector shift_invert_start(int size, int start);

/// Throws nothing of its own; what solve and mass throw passes through.
ShiftInvertResult arpack_shift_invert(const ShiftInvertProblem& problem);

}  // namespace drev
