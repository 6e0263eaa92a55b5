#pragma once
/// StraightLoads: loads that are straight between knots of their angle (LoadStretch), over one step of a series.
///
///   torque = T_0 + T_t (t - t_0) + T_theta (theta - theta_0)       on the stretch at hand
///
/// What each load adds to a step, and whether its angle may come near a knot, is found for all of them at once, by rows of
/// the series: rows side by side, loads on one row in layers. Only those that may reach a knot are looked at singly.
#include <array>
#include <vector>

#include "solvers/exact/kink_sizes.hpp"
#include "solvers/exact/table_stretches.hpp"
#include "solvers/exact/tangent_load.hpp"
#include "solvers/series/taylor_series.hpp"

namespace drev {

class StraightLoads {
 public:
  struct Load : PlacedLoad {
    using PlacedLoad::PlacedLoad;
    LoadStretch stretch = {}, ahead = {};  // ahead: of a load without a table
    double t_0 = 0.0, angle_0 = 0.0;       // time and angle at which `stretch` gives its torque
    double ahead_angle_0 = 0.0;            // the same of `ahead`
    double phase = 0.0;                    // of its table
    int table = -1;                        // whose stretches these are; -1: of a load that has none
    TableStretches::Place place = {}, ahead_place = {};
    std::size_t layer = 0;
  };
  explicit StraightLoads(const System& system);
  StraightLoads(const StraightLoads&) = delete;
  void add(const LoadTerm& term, const TaylorSeries& series);
  bool empty() const { return loads_.empty(); }
  /// All of them, with their angles where the step starts.
  std::vector<Load>& loads();

  /// Moves all loads to a state, at the nominal motion there.
  void move(const MotionPoint& nominal, const Vector& z, const Vector& v);
  void move_as(const StraightLoads& other);
  /// Finds each load's stretch ahead of its angle at time t [s].
  void locate(double t);
  /// Takes the stretches that loads came to by move(); where `whole`, those ahead of the step that was listed.
  void advance(double t, bool whole);
  void look_up(Load& load, double t, double direction);
  /// The table of a load that has one.
  const TableStretches& table_of(const Load& load) const { return tables_[idx(load.table)]; }
  /// The stretch of another behind a bound that it comes to at time t, kept for advance().
  const LoadStretch& look_beyond(Load& load, double t, double bound, bool rises) const;

  /// Adds to p, by powers of s over a step of h [s] from t, the torques along the nominal motion phi; to the series the slopes.
  void add_to(TaylorSeries& series, double t, double h, const std::array<double, 3>& phi, double* p);
  /// Those whose angle passes a knot up to s = `to` of a series, or may where it is not monotone, in a step of nominal motion
  /// phi. turns: of the series' rows, how far they come up to there; behind them by its stride, TaylorSeries::ranges()' bounds. The
  /// others are no longer watched, and stay on their stretches. Monotone: of the first rate by s, all others add up to no more than
  /// KinkSizes::kMonotone.
  struct Near {
    int load;  // its place in loads()
    bool monotone;
    double rate, end;  // first rate by s; angle at `to`
  };
  Load& load_of(const Near& near) { return loads_[idx(near.load)]; }
  /// Some of those near have `watched` or `contraction` set, which end with this step.
  void mark_near() { marked_ = true; }
  const std::vector<Near>& near_knots(const TaylorSeries& series, double to, const std::array<double, 3>& phi,
                                      const double* turns);
  /// Work of the slopes on the motion from that of the series' start to z [J].
  double slope_work(const TaylorSeries& series, const Vector& z);
  /// The motion of each row; loaded rows stand behind the unknowns.
  void find_rows(const Vector& z, LaneVector& rows) const;

 private:
  enum Quantity {
    kCoeff,
    kFeedback,
    kRatio,
    kAngle,
    kDeviation,
    kSpeed,
    kLow,
    kHigh,
    kTorque,
    kAngleSlope,
    kTimeSlope,
    kAngle0,
    kTime0,
    kQuantities
  };
  struct Layer {
    LaneVector values;      // quantities one behind the other, each by row
    std::vector<int> load;  // of each row; -1: none
  };
  struct Move;
  struct Terms;
  struct Reach;
  struct BesideKnot;
  struct SlopeWork;
  double* values(Layer& layer, Quantity q) const { return layer.values.data() + idx(q * stride_); }
  double& value(const Load& load, Quantity q) { return values(layers_[load.layer], q)[load.row]; }
  void place(Load& load);
  void refresh(Load& load);
  void advance_table(Load& load);
  void advance_other(Load& load);
  template <class Each>
  void for_flagged(const Layer& layer, const Each& each);

  const System& system_;
  int stride_;
  std::vector<Load> loads_;
  std::vector<TableStretches> tables_;
  std::vector<Layer> layers_;
  std::vector<Near> near_;  // when last asked for
  LaneVector rows_, rates_, slopes_,
      turned_;  // turned_: by row, Near's rate, end and what is not negative where it is monotone
  std::vector<unsigned> flags_;  // of a layer's rows, kLanes in each
  bool stale_ = false;           // loads_ lack the angles
  bool marked_ = false;          // mark_near()
};

}  // namespace drev
