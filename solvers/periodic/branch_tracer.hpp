#pragma once
/// BranchTracer: the curve of periodic motions over speed, through its folds, by steps along its arc.
///
///   R(X, w) = 0,   t' D (u - u_0) = s,   u = (X, w),   D = 1/size^2 of each entry
///
/// Predictor: the tangent t, from [R_X R_w; t_last' D] t = (0, 1); corrector: Newton on both equations; s follows
/// the number of iterations and the turn of the tangent. Where two points differ in what is looked for (the sign
/// of dw/ds, contact, multipliers) it is located between them, on planes across their chord; folds as the
/// extremum of the speed, once more with twice the harmonics until their speed is settled.
///
/// Source: R. Seydel, Practical Bifurcation and Stability Analysis, 3rd ed., Springer, 2010, chapter 4.
#include <optional>
#include <vector>

#include "solvers/periodic/floquet.hpp"

namespace drev {

struct BranchPoint {
  double speed = 0.0;  ///< rad/s
  Vector x;            ///< of LawBalance
  int harmonics = 0;
  bool closed = true;         ///< no contact opens
  double multiplier = 0.0;    ///< largest |Floquet multiplier|; 0: not judged
  bool stable = false;        ///< multiplier <= 1 but for rounding
  double at_minus_one = 0.0;  ///< FloquetMultipliers
  int outside = 0;
  bool complex_outside = false;
};

struct BranchEvent {
  enum class Kind {
    fold,             ///< the branch turns back: stable motions end there, and the train jumps
    contact,          ///< teeth begin to separate
    period_doubling,  ///< a multiplier passes -1: motions of twice the period branch off
    torus             ///< a complex pair of multipliers leaves the unit circle: motions that are not periodic
  };
  Kind kind = Kind::fold;
  double speed = 0.0;
  double error = 0.0;  ///< of the speed [rad/s]: difference from that with half the harmonics
  BranchPoint point;
};

struct Branch {
  std::vector<BranchPoint> points;  ///< along the arc, folds among them
  std::vector<BranchEvent> events;
  bool whole = false;  ///< both ends are at the first or last speed, or on another curve; or it is closed
};

class BranchTracer {
 public:
  struct Options {
    double low = 0.0, high = 0.0;  ///< rad/s
    int most_points = 1500;        ///< on a branch
    int cycles = 1;                ///< > 1: the curve ends where the motion repeats in a part of them
    int most_rows = 1100;          ///< of Newton's matrix, when folds are located
    double fold_tolerance = 1e-9;  ///< of a fold's speed
  };
  /// stability: null: not judged.
  BranchTracer(LawBalance& balance, const FloquetProduct* stability, const Options& options);

  /// X at a fixed speed, from a start. False: no convergence.
  bool solve(double speed, Vector& x);
  BranchPoint judged(double speed, Vector x);
  /// The branch through a solution, in both directions.
  Branch trace(double speed, const Vector& x);
  /// The motion at a speed between two neighbours on a branch; none: no convergence.
  std::optional<BranchPoint> between(const BranchPoint& from, const BranchPoint& to, double speed);

 private:
  struct Way;
  void rescale(const Vector& x);
  Vector joined(double speed, const Vector& x) const;
  /// Of X and w the harmonics that a motion of a single cycle does not have.
  Vector subharmonic(const Vector& u) const;
  double dot(const Vector& a, const Vector& b) const;
  bool linearize(const Vector& u, const Vector& normal, Eigen::MatrixXd& matrix, Vector& r);
  bool correct(const Vector& normal, const Vector& target, double tolerance, Vector& u, int& iterations);
  bool tangent(const Vector& u, const Vector& along, Vector& t);
  std::vector<BranchPoint> follow(double speed, const Vector& x, double direction, bool& whole);
  bool across(const Vector& from, const Vector& to, double part, Vector& u);
  BranchPoint point_at(const Vector& u);
  void find_events(const BranchPoint& from, const BranchPoint& to, Branch& branch);
  void find_fold(const BranchPoint& from, const BranchPoint& to, double sign, Branch& branch);
  std::optional<double> fold_between(Vector& from, Vector& to, double sign, Vector& u);
  template <class Differs>
  void bisect(const BranchPoint& from, const BranchPoint& to, BranchEvent::Kind kind, const Differs& differs,
              Branch& branch);
  void find_doubling(const BranchPoint& from, const BranchPoint& to, Branch& branch);

  LawBalance& balance_;
  const FloquetProduct* stability_;
  Options options_;
  Vector scale_;               // 1/size^2 of X and w
  Vector slope_;               // dR/dw where it was last found
  std::vector<double> turns_;  // dw/ds of the points of the branch in hand
};

}  // namespace drev
