#pragma once
/// Extremes of the sum of orders with their phases over a whole cycle:
///
///   y(phi) = Re sum_k a_k exp(i o_k phi),   o_k = n_k o_0, n_k integer,   0 <= phi < 2 pi / o_0
///
/// The sum is evaluated at 4 max(n_k) equidistant points of the cycle, h apart. Within half a step of a point
/// it exceeds the parabola through three of them by at most B h^3 / (9 sqrt 3), B = sum n_k^3 |a_k|, and the
/// polynomial through seven by at most 12.35 / 7! h^7 sum n_k^7 |a_k|. All places where these bounds leave an
/// extreme possible are refined to y' = 0, by the value and five derivatives or by bracketing. Smallest
/// values are the largest of -y. Sums and refinements are computed kLanes at a time
/// (solvers/linear/lane_pair.hpp).
///
/// Accuracy: rounding, about 1e-15 sum |a_k| for the value; half of the digits are correct in its angle.
#include <drev/core/ids.hpp>
#include <drev/core/lanes.hpp>

#include <Eigen/Core>
#include <array>
#include <complex>
#include <string>
#include <vector>

#include "solvers/periodic/bracketed_maximum.hpp"

namespace drev {

/// Extremes of a sum without its mean.
struct SumExtremes {
  double max = 0.0, min = 0.0;
  double max_angle = 0.0, min_angle = 0.0;  ///< angles phi of the extremes [rad], in [0, 2 pi / o_0)
  double half_range() const { return 0.5 * (max - min); }
};

class TrigonometricSum {
 public:
  static constexpr int kMostMultiples = 4096;  ///< largest n_k: highest order over o_0 [-]

  /// orders: > 0. Throws ModelError where they have no common cycle of at most kMostMultiples periods of the
  /// highest order. place: place that the message names.
  TrigonometricSum(const std::vector<double>& orders, const std::string& place);
  double base_order() const { return base_; }
  double cycle() const;  ///< 2 pi / o_0 [rad]
  /// amplitudes: a column for each sum, a row for each order. Extremes are not finite where an amplitude is
  /// not.
  void extremes(const Eigen::MatrixXcd& amplitudes, std::vector<SumExtremes>& out);

 private:
  /// A place where sign times y may have its maximum: the nearest point, the distance from it (shift), and an
  /// upper bound of the value there (reach).
  struct Top {
    int lane, point;
    double sign, shift, reach;  // shift in steps
    double value = 0.0;         // value of the polynomial through seven points
    double found = 0.0, angle = 0.0;
    bool followed = false;
  };
  void sample(const Eigen::MatrixXcd& amplitudes, Eigen::Index first, int used);
  /// Finds places of maxima (sign 1) and minima (-1) that may be the extremes, by the parabola through three
  /// points.
  void find_tops(int used);
  void take_marked(int used, double sign, const LaneRow* marks);
  double sample_at(int point, int lane) const { return samples_[idx(point + kBeside)].v[lane]; }
  /// Finds shift and reach of the tops by the polynomial through seven points.
  void look_between();
  /// Refines the highest top of each sum and sign.
  void follow_leaders();
  /// Refines the tops with these numbers in tops_ (-1: none) to their extrema. in_their_lanes: true: each
  /// number is in the lane of its sum.
  void refine(const std::array<int, kLanes>& places, bool in_their_lanes);
  /// The largest value between a top's neighbours, by bracketing; used where the steps to y' = 0 do not
  /// converge.
  BracketedMaximum search(const Top& top) const;
  void find_powers(const LaneRow* point, const LaneRow& angle, const LaneRow& away);
  /// Takes a refined top as the extreme of its sum if it is the largest so far.
  void take_found(int place);
  static int place_of(const Top& top);

  double base_ = 0.0, step_ = 0.0;
  int highest_ = 0, points_ = 0;
  static constexpr int kBeside = 3;  // points that are repeated before and after the cycle
  /// The n_k, even ones first: from the sums over even and odd ones, of cosines and of sines, at the points
  /// of a quarter of the cycle follow the sums in all four quarters.
  std::vector<int> multiples_;
  int even_ = 0;                               // number of even multiples
  std::vector<Eigen::Index> rows_;             // rows of the orders in `amplitudes`, in this sequence
  std::vector<double> cubes_, sevenths_;       // third and seventh powers of the multiples
  std::vector<double> cosines_, sines_;        // [point of a quarter][place in multiples_]
  LaneArray re_, im_, samples_;                // of kLanes sums: amplitudes by multiple; values at points
  LaneArray top_re_, top_im_;                  // amplitudes of the sums being refined, by order
  LaneArray power_re_, power_im_;              // exp(i n angle) at these tops
  std::vector<int> places_;                    // place of each order in power_re_ and power_im_
  std::vector<double> turned_re_, turned_im_;  // exp(i angle) of the points
  bool dense_ = false;                         // true: powers are kept for all n, not only the n_k
  LaneArray top_marks_, bottom_marks_;         // marks of the points that may be next to an extreme
  LaneRow thirds_, slack_, rest_;              // B of each sum; bounds of its excess over either polynomial
  std::array<LaneRow, 2> ends_;                // highest and lowest value of each sum at the points
  // For each sum, first the maxima, then the minima: the best value at the points or found so far; the value
  // found and its angle (-1: not yet).
  std::array<double, 2 * kLanes> best_{}, values_{}, angles_{};
  std::vector<Top> tops_;
};

}  // namespace drev
