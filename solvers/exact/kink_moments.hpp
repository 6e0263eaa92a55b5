#pragma once
/// KinkMoments: kinks of forces that are polynomials of an angle theta(s) between knots. Behind the s at which theta passes the
/// knot, a polynomial f(theta - knot) without constant is added: jump (theta - knot) where they are straight. Many knots at
/// once, in lanes; integrals by Gauss's nodes between there and the end.
#include <drev/core/lanes.hpp>

#include <array>
#include <span>
#include <vector>

#include "solvers/series/legendre_projection.hpp"

namespace drev {

class KinkMoments {
 public:
  static constexpr std::size_t kMostPowers = 18;
  void clear() {
    count_ = 0;
    powers_ = 1;
  }
  int count() const { return count_; }
  /// All forces are straight.
  bool straight() const { return powers_ == 1; }
  /// A kink: theta passes `knot` once before the end of the step, or of the part of it that is looked at, and monotonously, and
  /// stands at `end` there. force: factor times these are the terms of f from the first power on, at most kMostPowers.
  void add(int row, double knot, double factor, std::span<const double> force, double end) {
    const std::size_t i = idx_of(count_++);
    if (i == row_.size()) make_room();
    row_[i] = row;
    knot_[i] = knot;
    end_[i] = end;
    force_[i / kLanes * kForce + i % kLanes] = factor * force[0];
    if (powers_ > 1 || force.size() > 1) add_powers(i, factor, force);
  }
  /// theta of every kink has so many terms, at most kMostTerms, to be written to angle(), kLanes apart.
  void set_terms(std::size_t terms) { terms_ = terms; }
  double* angle(int i) { return theta_.data() + idx_of(i) / kLanes * kGroup + lane_of(i); }
  /// Adds the moments of all kinks over the whole step.
  void add_to(LegendreProjection& projection);
  /// Adds W_j = int_s^e (e - s)^j/j! f(theta - knot) ds up to s = e, of rows in columns of `stride`: W_degree ... W_0.
  /// nodes: of Gauss's rule, one of kSweepRules; place_terms: so many of theta's terms tell where it passes the knot.
  void add_to_sweep(double end, int degree, int nodes, std::size_t place_terms, int stride, double* columns);
  static constexpr std::array<int, 3> kSweepRules{4, 6, 8};
  /// The s, found by either, at which theta passes the knot of kink i.
  double place(int i) const { return place_[static_cast<std::size_t>(i)]; }
  const double* places() const { return place_.data(); }  ///< of all, in whole lanes
  int row(int i) const { return row_[static_cast<std::size_t>(i)]; }
  double knot(int i) const { return knot_[static_cast<std::size_t>(i)]; }
  double end(int i) const { return end_[static_cast<std::size_t>(i)]; }
  /// Jump of the slope at the knot.
  double jump(int i) const { return force_[static_cast<std::size_t>(i) / kLanes * kForce + lane_of(i)]; }
  /// f, its slope, and its integral from the knot on, at an angle of kink i behind its knot.
  struct Force {
    double value = 0.0, slope = 0.0, integral = 0.0;
  };
  Force force(int i, double behind) const;
  /// W_j of kink i alone, as add_to_sweep() found it.
  double moment(int i, int j) const {
    const auto at = static_cast<std::size_t>(i);
    return sweep_moments_[(at / kLanes * idx_of(degree_ + 1) + idx_of(j)) * kLanes + at % kLanes];
  }

 private:
  static std::size_t idx_of(int i) { return static_cast<std::size_t>(i); }
  static std::size_t lane_of(int i) { return static_cast<std::size_t>(i) % kLanes; }
  void make_room();
  void add_powers(std::size_t i, double factor, std::span<const double> force);
  template <int kNodes>
  void find_sweep_moments(double end, std::size_t place_terms);
  static constexpr std::size_t kMostTerms = 33, kGroup = kMostTerms * kLanes;
  static constexpr std::size_t kForce = kMostPowers * kLanes;
  int count_ = 0, degree_ = 0;
  std::size_t terms_ = 0, powers_ = 1;  // terms of the angles; powers of the forces
  std::vector<int> row_;
  LaneVector knot_, end_, place_;
  LaneVector theta_, force_;  // terms by group of lanes, then degree, then lane
  LaneVector moments_, sweep_moments_;
};

}  // namespace drev
