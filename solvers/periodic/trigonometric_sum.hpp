#pragma once
/// Extremes over a whole cycle of the sum of orders with their phases:
///
///   y(phi) = Re sum_k a_k exp(i o_k phi),   o_k = n_k o_0, n_k whole,   0 <= phi < 2 pi / o_0
///
/// The sum is taken at 4 max(n_k) even points of the cycle. About each local maximum of the points it is above the
/// parabola through three of them by at most B h^3 / (9 sqrt 3), B = sum n_k^3 |a_k|, h their distance; all that
/// this leaves possible are refined by Halley's method on y' = 0. Smallest values are the largest of -y. Sums and
/// refinements are made kLanes at a time (core/lanes.hpp).
///
/// Accuracy: rounding, about 1e-15 sum |a_k| for the value; half of the digits for its angle.
#include <drev/core/lanes.hpp>

#include <Eigen/Core>
#include <array>
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
  /// A local maximum of sign y: where, what the parabola through three points gives, and what was found of it.
  struct Top {
    int lane;
    double sign, at, value;  // at: in steps
    double found = 0.0, angle = 0.0;
    bool leads = false;  // the highest of its sum and sign
  };
  void sample(const Eigen::MatrixXcd& amplitudes, Eigen::Index first, int used);
  /// Local maxima (sign 1) and minima (-1) that may be the extremes.
  void find_tops(int used);
  void take_marked(int used, double sign, const LaneRow* marks);
  /// The tops of up to kLanes places in tops_, each followed to its extremum; those that cannot reach `least`, not to
  /// their end.
  void refine(const int* places, int count, const Lanes& least);
  static int place_of(const Top& top);
  /// Of the tops in tops_: the highest of each sum and sign first, in order_.
  void put_leaders_first();

  double base_ = 0.0, step_ = 0.0;
  int highest_ = 0, points_ = 0;
  std::vector<int> multiples_;
  std::vector<double> cubes_;  // of them
  /// Sums over even and odd multiples n, of cosines and of sines: those of a quarter of the cycle give all four.
  std::vector<int> by_parity_;                 // rows of the orders, even multiples first
  int even_ = 0;                               // so many of them
  std::vector<double> cosines_, sines_;        // [point of a quarter][place in by_parity_]
  LaneArray re_, im_, samples_;                // of kLanes sums: amplitudes by order; values at the points
  LaneArray top_re_, top_im_;                  // amplitudes of the tops that are being followed, by order
  LaneArray power_re_, power_im_;              // exp(i n angle) at them
  std::vector<double> turned_re_, turned_im_;  // exp(i angle) of the points
  bool dense_ = false;                         // few multiples between those of the orders
  Lanes slack_{}, thirds_{};                   // of each sum
  Lanes highest_sample_{}, lowest_sample_{};
  std::array<double, 2 * kLanes> best_{};  // largest of the points or found so far, of each sum and sign
  std::vector<Top> tops_;
  std::vector<int> order_;  // of tops_
};

}  // namespace drev
