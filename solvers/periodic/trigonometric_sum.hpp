#pragma once
/// Extremes of the sum of orders with their phases over a whole cycle:
///
///   y(phi) = Re sum_k a_k exp(i o_k phi),   o_k = n_k o_0, n_k integer,   0 <= phi < 2 pi / o_0
///
/// The sum is evaluated at 6 max(n_k) equidistant points of the cycle, h apart, or a few more. Points within half a
/// step of which an extreme may be are marked by bounds of the second and third derivatives, sum n_k^2 |a_k| and
/// sum n_k^3 |a_k|. There the sum exceeds the polynomial through seven points by at most 12.35 / 7! h^7
/// sum n_k^7 |a_k|. All places where this bound leaves an extreme possible are refined to y' = 0, by the value and
/// five derivatives or by bracketing. Smallest values are the largest of -y. Sums and refinements are computed
/// kLanes at a time (trigonometric_kernels.hpp).
///
/// Accuracy: rounding, about 1e-15 sum |a_k| for the value; half of the digits are correct in its angle.
#include <drev/core/ids.hpp>
#include <drev/core/lanes.hpp>

#include <Eigen/Core>
#include <array>
#include <complex>
#include <span>
#include <string>
#include <vector>

#include "solvers/periodic/bracketed_search.hpp"
#include "solvers/periodic/trigonometric_kernels.hpp"

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

  /// orders: > 0. Where they have no common cycle of at most kMostMultiples periods of the highest order, ModelError is
  /// thrown if needs_cycle is true; if not, cycle and extremes are not numbers. place: place that the message names.
  TrigonometricSum(const std::vector<double>& orders, const std::string& place, bool needs_cycle = true);
  double base_order() const { return base_; }
  double cycle() const;  ///< 2 pi / o_0 [rad]
  /// sums: the amplitudes of each, in the sequence of the orders. Extremes are not finite where an amplitude is not.
  void extremes(std::span<const std::complex<double>* const> sums, std::vector<SumExtremes>& out);
  /// amplitudes: a column for each sum, a row for each order.
  void extremes(const Eigen::MatrixXcd& amplitudes, std::vector<SumExtremes>& out);

 private:
  static constexpr int kSigns = 2;                 // maxima and minima
  static constexpr int kSums = kSumSets * kLanes;  // sums that are processed together
  static constexpr int kBeside = TopRows::kSides;  // points that are repeated before and after the cycle
  /// The point nearest to a place where y, or -y, may have its maximum.
  struct Top {
    int sum, point;
    int which;  // place of its sum and sign in best_, values_ and angles_: maxima first
    bool followed = false;
  };
  static double sign_of(const Top& top) { return top.which < kSums ? 1.0 : -1.0; }
  void sample(std::span<const std::complex<double>* const> sums);
  /// Finds the places of maxima and minima that may be the extremes, and the highest of each sum and sign.
  void find_tops(int used);
  /// Fills the rows of the tops from the samples.
  void gather_tops();
  /// Follows the tops with these kLanes numbers in tops_ (-1: none) to their extrema, each in the lane of its amplitudes, and
  /// takes them as extremes of their sums where they are the largest so far.
  void follow(const int* places, const LaneRow* re, const LaneRow* im);
  void follow_others();
  /// The largest value between a top's neighbours, by bracketing; used where the steps to y' = 0 do not
  /// converge. shift: where it starts, in steps from the point.
  BracketedMaximum search(const Top& top, double shift) const;
  void step(const LaneRow* re, const LaneRow* im, FollowedTops& tops);

  double base_ = 0.0, step_ = 0.0;
  int highest_ = 0, points_ = 0, sets_ = 0;
  std::vector<int> multiples_;  // the n_k, in the sequence of SumEighths
  // Number of multiples of four, with other even ones, and with those that are 1 more than a multiple of four.
  int fours_ = 0, even_ = 0, ones_ = 0;
  std::vector<Eigen::Index> rows_;             // places of the orders given, in this sequence
  std::vector<std::array<double, 3>> powers_;  // second, third and seventh powers of the multiples
  std::array<double, 3> shares_{};             // factors of the bounds
  std::vector<double> cosines_, sines_;        // [point of an eighth, and one][place in multiples_]
  LaneArray re_, im_, samples_;                // of the sets: amplitudes by multiple; values at points
  LaneArray top_re_, top_im_;                  // amplitudes of the sums of tops, by multiple
  LaneArray power_re_, power_im_;  // exp(i n angle) at these tops, where the multiples are not dense
  std::vector<int> places_;        // row of each order given in re_ and im_
  std::vector<int> places_of_n_;   // row of each n, where they are dense
  std::vector<double> turned_re_, turned_im_;        // exp(i angle) of the points
  bool dense_ = false;                               // true: powers are found for all n, not only the n_k
  std::array<std::vector<LaneWord>, kSigns> marks_;  // marks of the points that may be next to an extreme
  std::array<LaneRow, kSumSets> thirds_;             // sum n^3 |a| of each sum
  std::array<LaneRow, 3 * kSumSets> bounds_;         // those of MarkExtremes; excess over the polynomial
  std::array<LaneRow, 2 * kSumSets> ends_;           // highest and lowest value of each sum at the points
  // For each sum, first the maxima, then the minima: the best value at the points or found so far; the value
  // found and its angle (-1: not yet).
  std::array<double, kSigns * kSums> best_{}, values_{}, angles_{};
  std::vector<Top> tops_;
  std::vector<TopRows> top_rows_;              // of the tops, kLanes at a time
  std::array<int, kSigns * kSums> leaders_{};  // highest top of each sum and sign; -1: none
};

}  // namespace drev
