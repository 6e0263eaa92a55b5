#pragma once
/// Extremes over a whole cycle of the sum of orders with their phases:
///
///   y(phi) = Re sum_k a_k exp(i o_k phi),   o_k = n_k o_0, n_k whole,   0 <= phi < 2 pi / o_0
///
/// The sum is taken at 4 max(n_k) even points of the cycle. About each local maximum of the points it is above the
/// parabola through three of them by at most B h^3 / (9 sqrt 3), B = sum n_k^3 |a_k|, h their distance; all that
/// this leaves possible are refined by Halley's method on y' = 0. Smallest values are the largest of -y.
///
/// Accuracy: rounding, about 1e-15 sum |a_k| for the value; half of the digits for its angle.
#include <Eigen/Core>
#include <complex>
#include <string>
#include <vector>

namespace drev {

/// Of a sum without its mean.
struct SumExtremes {
  double max = 0.0, min = 0.0;
  double max_angle = 0.0, min_angle = 0.0;  ///< rad of phi, in [0, 2 pi / o_0)
  double half_range() const { return 0.5 * (max - min); }
};

class TrigonometricSum {
 public:
  static constexpr int kMostMultiples = 4096;  ///< of o_0, in the highest order

  /// orders: > 0. Throws ModelError where they have no common cycle, which is one of at most kMostMultiples
  /// periods of the highest. place: what the message names.
  TrigonometricSum(const std::vector<double>& orders, const std::string& place);
  double base_order() const { return base_; }
  double cycle() const;  ///< 2 pi / o_0 [rad]
  /// amplitudes: a column a sum, its rows as the orders. Not finite where an amplitude is not.
  void extremes(const Eigen::MatrixXcd& amplitudes, std::vector<SumExtremes>& out);

 private:
  double refine(const std::complex<double>* a, double angle, double sign, double& value) const;
  double largest(const std::complex<double>* a, Eigen::Index column, double sign, double& angle);

  double base_ = 0.0, step_ = 0.0;
  int highest_ = 0;
  struct Top {
    double at, value;  // a local maximum: place in steps, value of the parabola
  };
  std::vector<int> multiples_;
  std::vector<double> cubes_;  // of them
  std::vector<Top> tops_;
  /// Sums over even and odd multiples n, of cosines and of sines: those of a quarter of the cycle give all four.
  struct Group {
    std::vector<Eigen::Index> rows;  // of the orders
    Eigen::MatrixXd cosines, sines;  // points of a quarter x orders
    Eigen::MatrixXd real, imaginary, of_cosines, of_sines;
  };
  Group even_, odd_;
  Eigen::MatrixXd samples_;
};

}  // namespace drev
