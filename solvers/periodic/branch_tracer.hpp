#pragma once
/// BranchTracer: the curve of periodic motions over speed, traced through its folds by arc-length
/// continuation.
///
///   R(X, w) = 0,   t' D (u - u_0) = s,   u = (X, w),   D = 1/size^2 of each entry
///
/// Predictor: the tangent t, from [R_X R_w; t_last' D] t = (0, 1). Corrector: Newton's method on both
/// equations. The step s follows the number of iterations and the turn of the tangent. Where two neighbouring
/// points differ in the sign of dw/ds, in contact or in their multipliers, the change is located between
/// them, on planes across their chord, repeatedly with twice the harmonics until its speed has converged; a fold as
/// the extremum of the speed.
///
/// Source: R. Seydel, Practical Bifurcation and Stability Analysis, 3rd ed., Springer, 2010, chapter 4.
#include <functional>
#include <optional>
#include <vector>

#include "solvers/periodic/floquet.hpp"

namespace drev {

struct BranchPoint {
  double speed = 0.0;  ///< rad/s
  Vector x;            ///< unknowns X of LawBalance
  int harmonics = 0;
  bool closed = true;         ///< true: no contact opens in the cycle
  double multiplier = 0.0;    ///< largest |Floquet multiplier| [-]; 0: stability not computed
  bool stable = false;        ///< multiplier <= 1 within rounding
  double at_minus_one = 0.0;  ///< FloquetMultipliers::at_minus_one
  int outside = 0;            ///< FloquetMultipliers::outside
  bool complex_outside = false;
};

struct BranchEvent {
  enum class Kind {
    fold,             ///< the branch turns back: stable motions end there, and the train jumps
    contact,          ///< teeth begin to separate
    period_doubling,  ///< a Floquet multiplier passes -1: motions of twice the period branch off
    torus,            ///< a complex pair of multipliers leaves the unit circle: motions that are not periodic
    branching  ///< a multiplier passes +1 without a fold: stability changes, as at the end of a tongue of instability
  };
  Kind kind = Kind::fold;
  double speed = 0.0;
  double error =
      0.0;  ///< error of the speed [rad/s]: its difference from the speed with half the harmonics; not a
            ///< number: unknown
  BranchPoint point;
};

struct Branch {
  std::vector<BranchPoint> points;  ///< points in the order of the arc, folds included
  std::vector<BranchEvent> events;
  /// True: both ends are at the first or last speed, or on another curve, or the curve is closed.
  bool whole = false;
};

class BranchTracer {
 public:
  struct Options {
    double low = 0.0, high = 0.0;  ///< lowest and highest speed [rad/s]
    int most_points = 1500;        ///< largest number of points on a branch
    int cycles = 1;                ///< cycles in a period; > 1: the curve ends where fewer cycles repeat
    int most_rows = 1100;          ///< largest number of rows of Newton's matrix when changes are located
    double tolerance = 1e-9;       ///< tolerance of a change's speed, relative to it [-]
  };
  /// stability: null if the stability of the motions is not computed.
  BranchTracer(LawBalance& balance, const FloquetProduct* stability, const Options& options);

  /// Solves for X at a fixed speed, from the start in x. False: no convergence.
  bool solve(double speed, Vector& x);
  BranchPoint judged(double speed, Vector x);
  /// The branch through a solution, in both directions.
  Branch trace(double speed, const Vector& x);
  /// The motion at a speed between two neighbouring points of a branch; nullopt: no convergence.
  std::optional<BranchPoint> between(const BranchPoint& from, const BranchPoint& to, double speed);

 private:
  struct Way;
  void rescale(const Vector& x);
  Vector joined(double speed, const Vector& x) const;
  /// The harmonics in (X, w) that a motion that repeats in a `part`th of the period does not have.
  Vector subharmonic(const Vector& u, int part) const;
  /// Whether the branch has met that of motions of fewer cycles between two points; beyond it the same motions follow,
  /// shifted by some cycles.
  bool meets_fewer_cycles(const Vector& u, const Vector& next) const;
  double dot(const Vector& a, const Vector& b) const;
  bool linearize(const Vector& u, const Vector& normal, Eigen::MatrixXd& matrix, Vector& r);
  bool correct(const Vector& normal, const Vector& target, double tolerance, Vector& u, int& iterations);
  bool tangent(const Vector& u, const Vector& along, Vector& t);
  std::vector<BranchPoint> follow(double speed, const Vector& x, double direction, bool& whole);
  bool across(const Vector& from, const Vector& to, double part, Vector& u);
  BranchPoint point_at(const Vector& u);
  /// folds: the branch has a fold between them.
  void find_events(const BranchPoint& from, const BranchPoint& to, bool folds, Branch& branch);
  /// Locates a change between a and b: its part of their chord, with the motion there in u; nullopt: there is none.
  using Locate = std::function<std::optional<double>(const Vector& a, const Vector& b, Vector& u)>;
  /// Adds a change to the branch, located repeatedly with twice the harmonics until its speed has converged.
  void find_change(const BranchPoint& from, const BranchPoint& to, BranchEvent::Kind kind,
                   const Locate& locate, Branch& branch);
  /// Moves a and b to points of the branch with twice the harmonics, `beside` before and behind a part of their chord.
  /// False: they were not found; harmonics and scale_ may be those of either number.
  bool widen(double part, double beside, Vector& a, Vector& b);
  void find_fold(const BranchPoint& from, const BranchPoint& to, double sign, Branch& branch);
  template <class Differs>
  void bisect(const BranchPoint& from, const BranchPoint& to, BranchEvent::Kind kind, const Differs& differs,
              Branch& branch);
  void find_doubling(const BranchPoint& from, const BranchPoint& to, Branch& branch);

  LawBalance& balance_;
  const FloquetProduct* stability_;
  Options options_;
  Vector scale_;               // D: 1/size^2 of each entry of X and w
  Vector slope_;               // dR/dw at the point where it was last evaluated
  std::vector<double> turns_;  // dw/ds at the points of the branch being traced
};

}  // namespace drev
