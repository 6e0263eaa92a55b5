#pragma once
/// Floquet multipliers of a periodic motion: the eigenvalues of P in (dz, dz')(T) = P (dz, dz')(0), where
///
///   M dz'' + (C + sum_j dy_j/dx' b_j b_j') dz' + (K + sum_j dy_j/dx b_j b_j') dz = 0
///
/// with the slopes of the laws along the motion. P is the product of exponentials over the stretches in which
/// they are constant, and of truncated series over panels in which they are not: there each slope is the polynomial
/// through its values at the panel's points, and the series of (dz, dz') in a step follows from the equation degree by
/// degree (Cauchy products; A. Griewank, A. Walther, Evaluating Derivatives, SIAM, 2008, chapter 13).
///
/// Growth of free motion of a gear train whose meshes are always closed and whose stiffness jumps with the
/// mesh phase: M z'' + C z' + (K + sum_j k_j(t) b_j b_j') z = 0, all k_j of a common period T, constant in
/// each of `pieces` equal parts of it.
///
///   (z, v)(T) = P (z, v)(0),   P = prod exp(A_p T / pieces),   growth = ln(max |eigenvalue of P|) / T
///
/// Positive: parametric instability; without gaps nothing bounds it.
/// Source: Floquet's theorem; J. A. Richards, Analysis of Periodically Time-Varying Systems, Springer, 1983.
#include <drev/core/system.hpp>

#include <vector>

#include "solvers/periodic/law_balance.hpp"

namespace drev {

struct FloquetMultipliers {
  Eigen::VectorXcd values;       ///< without the two nearest to 1 of each part that floats: its rigid motion
  double largest = 0.0;          ///< |value|; > 1: unstable
  double at_minus_one = 0.0;     ///< product of the 1 + value: changes its sign where the period doubles
  int outside = 0;               ///< how many are outside the unit circle by more than rounding
  bool complex_outside = false;  ///< a pair of them is complex
};

class FloquetProduct {
 public:
  static constexpr int kMostUnknowns = 200;  ///< of a model: the matrices are dense
  static constexpr double kRounding = 1e-7;  ///< of a multiplier on the unit circle

  explicit FloquetProduct(const System& system);
  /// Of the point at which balance.residual() was last. NaN where an eigensolver does not converge.
  FloquetMultipliers multipliers(const LawBalance& balance, double speed) const;

 private:
  /// A law or load whose slopes vary over a panel, and the slopes at its points by x, x' and the angle.
  struct Varying {
    const LawBalance::Term* term;
    Eigen::Matrix<double, LawBalance::kPoints, 3> slopes;
  };
  Eigen::MatrixXd rates(const LawBalance& balance, std::size_t panel, std::vector<Varying>* varying) const;
  Eigen::MatrixXd varying_turn(const LawBalance& balance, std::size_t panel, double lasts) const;

  const System& system_;
  double w_ = 1.0;                              // of a fast mode: z' is in units of it
  Eigen::MatrixXd stiffness_, drag_, inverse_;  // K, M^-1 C, M^-1
};

/// growth [1/s]; period [s].
double largest_floquet_exponent(const System& system, double period, int pieces);

}  // namespace drev
