#pragma once
/// Extremes over a whole cycle of the sum of orders with their phases:
///
///   y(phi) = Re sum_k a_k exp(i o_k phi),   o_k = n_k o_0, n_k whole,   0 <= phi < 2 pi / o_0
///
/// The sum is taken at 4 max(n_k) even points of the cycle, h apart. Within half a step of a point it exceeds the parabola
/// through three of them by at most B h^3 / (9 sqrt 3), B = sum n_k^3 |a_k|, and the polynomial through seven by at
/// most 12.35 / 7! h^7 sum n_k^7 |a_k|; all places that this leaves possible are followed to y' = 0 by value and five
/// derivatives, or by bracketing. Smallest values are the largest of -y. Sums and refinements are made kLanes at a time
/// (solvers/linear/lane_pair.hpp).
///
/// Accuracy: rounding, about 1e-15 sum |a_k| for the value; half of the digits for its angle.
#include <drev/core/ids.hpp>
#include <drev/core/lanes.hpp>

#include <Eigen/Core>
#include <array>
#include <complex>
#include <string>
#include <vector>

#include "solvers/periodic/bracketed_maximum.hpp"

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
  /// Where sign y may have its maximum: near which point, how far from it, and what it cannot exceed there.
  struct Top {
    int lane, point;
    double sign, shift, reach;  // shift: in steps
    double value = 0.0;         // of the polynomial through seven points
    double found = 0.0, angle = 0.0;
    bool followed = false;
  };
  void sample(const Eigen::MatrixXcd& amplitudes, Eigen::Index first, int used);
  /// Places of maxima (sign 1) and minima (-1) that may be the extremes, by the parabola through three points.
  void find_tops(int used);
  void take_marked(int used, double sign, const LaneRow* marks);
  double sample_at(int point, int lane) const { return samples_[idx(point + kBeside)].v[lane]; }
  /// Places and reaches of the tops by the polynomial through seven points.
  void look_between();
  /// The highest top of each sum and sign.
  void follow_leaders();
  /// The tops of these numbers in tops_ (-1: none), each followed to its extremum. in_their_lanes: each stands at its
  /// sum's lane.
  void refine(const std::array<int, kLanes>& places, bool in_their_lanes);
  /// The largest value between a top's neighbours, by bracketing: where y' = 0 does not lead there.
  BracketedMaximum search(const Top& top) const;
  void find_powers(const LaneRow* point, const LaneRow& angle, const LaneRow& away);
  /// A top that was followed, where it is the extreme so far.
  void take_found(int place);
  static int place_of(const Top& top);

  double base_ = 0.0, step_ = 0.0;
  int highest_ = 0, points_ = 0;
  static constexpr int kBeside = 3;  // points of the cycle before and behind that are kept, too
  /// Even multiples first: of sums over even and odd ones, of cosines and of sines, those of a quarter of the cycle give
  /// all four.
  std::vector<int> multiples_;
  int even_ = 0;                               // so many of them are
  std::vector<Eigen::Index> rows_;             // of the orders, in this sequence
  std::vector<double> cubes_, sevenths_;       // of them
  std::vector<double> cosines_, sines_;        // [point of a quarter][place in multiples_]
  LaneArray re_, im_, samples_;                // of kLanes sums: amplitudes by multiple; values at the points
  LaneArray top_re_, top_im_;                  // amplitudes of the tops that are being followed, by order
  LaneArray power_re_, power_im_;              // exp(i n angle) at them
  std::vector<int> places_;                    // of each order in these
  std::vector<double> turned_re_, turned_im_;  // exp(i angle) of the points
  bool dense_ = false;                         // few multiples between those of the orders
  LaneArray top_marks_, bottom_marks_;         // of the points
  LaneRow thirds_, slack_, rest_;              // of each sum
  std::array<LaneRow, 2> ends_;                // highest and lowest point of each
  // Of each sum, largest values first: largest of the points or found so far; found, and where (-1: not yet).
  std::array<double, 2 * kLanes> best_{}, values_{}, angles_{};
  std::vector<Top> tops_;
};

}  // namespace drev
