#pragma once
/// Floquet multipliers of a periodic motion: the eigenvalues of P in (dz, dz')(T) = P (dz, dz')(0), where
///
///   M dz'' + (C + sum_j dy_j/dx' b_j b_j') dz' + (K + sum_j dy_j/dx b_j b_j') dz = 0
///
/// with the slopes of the laws along the motion. P is the product of matrix exponentials over the stretches
/// in which the slopes are constant, and of truncated Taylor series over the panels in which they vary. In
/// such a panel each slope is the polynomial through its values at the panel's points, and the series of (dz,
/// dz') in a step follows from the equation degree by degree (Cauchy products; A. Griewank, A. Walther,
/// Evaluating Derivatives, SIAM, 2008, chapter 13).
///
/// Where the slopes of a law jump but its force does not, (dz, dz') is continuous. Where x crosses a jump [y] of
/// the force itself, dz' changes by -M^-1 b [y]/|x'| b' dz (saltation matrix; R. I. Leine, H. Nijmeijer,
/// Dynamics and Bifurcations of Non-Smooth Mechanical Systems, Springer, 2004, chapter 7). A force that jumps
/// at a bound in x' (dry friction, which sweeps refuse) is not treated.
///
/// Growth rate of the free motion of a gear train whose meshes are always in contact and whose stiffness
/// jumps with the mesh phase: M z'' + C z' + (K + sum_j k_j(t) b_j b_j') z = 0, where all k_j have a common
/// period T and are constant in each of its `pieces` equal parts.
///
///   (z, v)(T) = P (z, v)(0),   P = prod exp(A_p T / pieces),   growth = ln(max |eigenvalue of P|) / T
///
/// A positive growth rate is a parametric instability; in a model without gaps nothing limits the motion
/// then.
/// Source: Floquet's theorem; J. A. Richards, Analysis of Periodically Time-Varying Systems, Springer, 1983.
#include <drev/core/system.hpp>

#include <vector>

#include "solvers/periodic/law_balance.hpp"

namespace drev {

struct FloquetMultipliers {
  /// Multipliers, without the two nearest to 1 of each floating part, which belong to its rigid-body motion.
  Eigen::VectorXcd values;
  double largest = 0.0;          ///< largest |multiplier| [-]; > 1: the motion is unstable
  double at_minus_one = 0.0;     ///< product of all 1 + multiplier: changes its sign where the period doubles
  int outside = 0;               ///< number of multipliers outside the unit circle by more than rounding
  bool complex_outside = false;  ///< true: a complex pair is among those outside
};

class FloquetProduct {
 public:
  static constexpr int kMostUnknowns = 200;  ///< largest number of unknowns: the matrices are dense
  static constexpr double kRounding = 1e-7;  ///< rounding error of |multiplier| on the unit circle [-]

  explicit FloquetProduct(const System& system);
  /// Multipliers of the motion at which balance.residual() was last called. NaN where the eigensolver does
  /// not converge.
  FloquetMultipliers multipliers(const LawBalance& balance, double speed) const;

 private:
  /// A law or load whose slopes vary over a panel, with its slopes by x, x' and the angle at the panel's
  /// points.
  struct Varying {
    const LawBalance::Term* term;
    Eigen::Matrix<double, LawBalance::kPoints, 3> slopes;
  };
  Eigen::MatrixXd rates(const LawBalance& balance, std::size_t panel, std::vector<Varying>* varying) const;
  Eigen::MatrixXd varying_turn(const LawBalance& balance, std::size_t panel, double lasts) const;

  const System& system_;
  double w_ = 1.0;                              // frequency of a fast mode [rad/s]; z' is in units of it
  Eigen::MatrixXd stiffness_, drag_, inverse_;  // K, M^-1 C, M^-1
};

/// Returns the growth rate [1/s]; period T [s]; pieces: number of equal parts of the period.
double largest_floquet_exponent(const System& system, double period, int pieces);

}  // namespace drev
