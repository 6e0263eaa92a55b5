#pragma once
/// KinkMoments: kinks of forces that are polynomials of an angle theta(s) between knots. Behind the s at which theta passes the
/// knot, a polynomial f(theta - knot) without constant is added: jump (theta - knot) where they are straight. Many knots at
/// once, in lanes; integrals by Gauss's nodes between there and the end.
#include <array>
#include <span>
#include <vector>

#include "solvers/exact/lane_table.hpp"
#include "solvers/exact/tangent_load.hpp"
#include "solvers/series/legendre_projection.hpp"
#include "solvers/series/taylor_series.hpp"

namespace drev {

class KinkMoments {
 public:
  static constexpr std::size_t kMostPowers = 18;
  void clear() {
    count_ = 0;
    powers_ = 1;
    all_turn_ = true;
  }
  int count() const { return count_; }
  /// All forces are straight.
  bool straight() const { return powers_ == 1; }
  /// All angles turn with their rows (PlacedLoad::turn).
  bool all_turn() const { return all_turn_; }
  /// A kink: theta passes `knot` once before the end of the step, or of the part of it that is looked at, and monotonously, and
  /// stands at `end` there. force: the load's coefficient times these are the terms of f from the first power on, at most kMostPowers.
  void add(const PlacedLoad& load, double knot, std::span<const double> force, double end) {
    add_straight(load, knot, force[0], end);
    if (powers_ > 1 || force.size() > 1) add_powers(idx_of(count_ - 1), load.coeff, force);
  }
  /// The same of one power.
  void add(const PlacedLoad& load, double knot, double jump, double end) {
    add_straight(load, knot, jump, end);
    if (powers_ > 1) add_powers(idx_of(count_ - 1), load.coeff, {&jump, 1});
  }
  /// Gives theta of each kink its terms, at most kMostTerms: angle, then turn Z_k + ratio phi_k. columns: Z_0 and so on, by rows,
  /// `stride` apart, so many of them.
  void expand(const double* columns, int stride, std::size_t known, std::size_t terms,
              const std::array<double, 3>& phi);
  /// Adds the moments of all kinks over the whole step.
  void add_to(LegendreProjection& projection);
  /// W_j = int_s^e (e - s)^j/j! f(theta - knot) ds up to s = e, j <= degree, of each kink (TaylorSeries::RowMoments). nodes: of
  /// Gauss's rule, one of kSweepRules; place_terms: so many of theta's terms tell where it passes the knot.
  TaylorSeries::RowMoments find_moments(double end, int degree, int nodes, std::size_t place_terms);
  static constexpr std::array<int, 3> kSweepRules{4, 6, 8};
  /// The s, found by either, at which theta passes the knot of kink i.
  double place(int i) const { return places()[i]; }
  const double* places() const { return table_.at(kPlace); }  ///< of all, in whole lanes
  int row(int i) const { return row_[idx_of(i)]; }
  const int* rows() const { return row_.data(); }
  double knot(int i) const { return table_.at(kKnot)[i]; }
  double end(int i) const { return table_.at(kEnd)[i]; }
  /// By how much the slope of the force on its row jumps at the knot, by the row [N m/rad or N/m].
  const double* slopes() const { return table_.at(kSlope); }
  /// Work up to s = e, to where find_moments() went, of all kinks whose angles turn, where they add y to the motion, whose values
  /// there these are, and int y ds and int (e - s) y ds: of f(theta - knot) along theta, less along the nominal motion, whose rate
  /// is rate - bend (e - s).
  double work(double rate, double bend, const double* y, const double* y_sum, const double* y_sum_2) const;
  /// f, its slope, and its integral from the knot on, at an angle of kink i behind its knot.
  struct Force {
    double value = 0.0, slope = 0.0, integral = 0.0;
  };
  Force force(int i, double behind) const;
  /// The first terms of f by powers of s - s_0, where theta - knot has these three about s_0.
  void force_terms(int i, const std::array<double, 3>& behind, std::span<double> terms) const;

 private:
  enum Quantity { kKnot, kEnd, kAngle, kRatio, kTurn, kPerTurn, kSlope, kPlace, kQuantities };
  struct Work;
  static std::size_t idx_of(int i) { return static_cast<std::size_t>(i); }
  void make_room();
  void add_straight(const PlacedLoad& load, double knot, double jump, double end) {
    const std::size_t i = idx_of(count_++);
    if (i == table_.room()) make_room();
    const std::size_t room = table_.room();
    row_[i] = load.row;
    double* to = table_.at(0) + i;
    to[kKnot * room] = knot;
    to[kEnd * room] = end;
    to[kAngle * room] = load.angle;
    to[kRatio * room] = load.ratio;
    to[kTurn * room] = load.turn;
    to[kPerTurn * room] = load.per_turn;
    const double slope = load.coeff * jump;
    to[kSlope * room] = load.turn * slope;
    force_[i / kLanes * kForce + i % kLanes] = slope;
    all_turn_ &= load.feedback;
  }
  void add_powers(std::size_t i, double factor, std::span<const double> force);
  template <int kNodes>
  void find_moments(double end, int degree, std::size_t place_terms);
  static constexpr std::size_t kMostTerms = 33, kGroup = kMostTerms * kLanes;
  static constexpr std::size_t kForce = kMostPowers * kLanes;
  int count_ = 0;
  std::size_t terms_ = 0, powers_ = 1;  // terms of the angles; powers of the forces
  bool all_turn_ = true;
  std::vector<int> row_;
  LaneTable<kQuantities> table_;
  LaneVector theta_, force_;  // terms by group of lanes, then degree, then lane
  LaneVector moments_, sweep_moments_;
};

}  // namespace drev
