#pragma once
/// SmoothLoads: loads without straight stretches that can only be called (functions), for LoadSeries.
///
/// Over a step such a load acts by its tangent at the start, torque + slope (theta - theta_0) + speed_slope (w - w_0), whose slopes
/// go to stiffness and damping (that by the speed where the node is an unknown of its own); what it differs from that along the path
/// is taken at Gauss's nodes and projected (legendre_projection.hpp). A load that follows no motion is taken there once a step.
///
/// Between the nodes a load may do what none of them sees: a motor's curve of 1 rad/s in a train that swings by 100, a pulse. A load that
/// bounds its slopes (Load::steepest) is looked at between two points wherever it may change by far more than they show, until it
/// cannot, or what it may do moves nothing; any other is looked at once between any two nodes. All are looked at where angle or
/// speed turn back between the points, beyond which a kink may be passed there and back.
///
/// A load that says its knots (KnottedLoad: an engine's gas pressure) passes them inside the step: the path between two
/// of them has Gauss's nodes of its own, and what the load differs from its tangent is projected apart from the smooth
/// loads, as kinks of tables are. A knot that leaves too much of the motion inside the step ends it. Here are those
/// that ExpandedLoads does not hold for: of another period, or whose curves follow a speed that changes. Those that follow the
/// actual speed bend at speeds, too, and are called as functions are.
#include <drev/core/assembler.hpp>
#include <drev/core/law/knotted_load.hpp>

#include <algorithm>
#include <vector>

#include "solvers/exact/tangent_load.hpp"
#include "solvers/series/legendre_projection.hpp"

namespace drev {

class SmoothLoads {
 public:
  explicit SmoothLoads(const System& system)
      : system_(system), stride_(TaylorSeries::stride(system)), forces_(stride_), known_(stride_) {}

  /// A load that states no stretch. expanded: it acts here only where ExpandedLoads does not hold for it.
  void add(const LoadTerm& term, bool expanded) { all_.push_back({&term, expanded}); }
  /// Whether some of them are known only where they are called: neither as pieces nor by their frequencies.
  bool called() const {
    return std::any_of(all_.begin(), all_.end(),
                       [](const Added& a) { return !a.expanded && a.term->load->frequencies().empty(); });
  }
  /// Under the nominal motion at hand.
  bool empty() const { return loads_.empty(); }

  /// Tangents at a state, where the assembler stands.
  void move(const Assembler& assembler, const Vector& z, const Vector& v);
  /// Takes over the tangents of another one of the same system.
  void move_as(const SmoothLoads& other);

  /// Adds the tangents along the nominal angle's terms phi to p, degree k at p + k stride.
  void add_to(double h, const std::array<double, 3>& phi, double* p);
  /// Adds the tangents' slopes to stiffness and damping, and what they take from the right side.
  void add_slopes(TaylorSeries& series) const;
  /// The motion at Gauss's nodes, for project(); returns the scales of the motion with it.
  std::array<TaylorSeries::Norm, 2> follow(const TaylorSeries& series) {
    if (loads_.empty()) return {series.z_scale(), series.v_scale()};
    path_.resize(GaussRule::kNodes * idx(stride_));
    rate_.resize(path_.size());
    series.at_nodes(path_.data(), rate_.data());
    return series.scales_at_nodes(path_.data(), rate_.data());
  }
  /// Adds to the projection what the loads differ from their tangents along the series' path; returns how much of
  /// a change of the path comes back. first: the step is new.
  /// kinks: takes the loads that pass knots in the step.
  double project(const TaylorSeries& series, bool first, LegendreProjection& projection,
                 LegendreProjection& kinks);
  /// Looks at what was projected last between the nodes, for for_rows(). least_of(row): the force [N m] over the whole step that
  /// moves nothing.
  template <class LeastOf>
  void look_between(const TaylorSeries& series, const LeastOf& least_of) {
    for (Place& l : loads_) l.least = least_of(l.row);
    look_between(series);
  }
  /// Whether some of them follow the motion.
  bool follows() const {
    return std::any_of(loads_.begin(), loads_.end(), [](const Place& l) { return l.feedback; });
  }
  /// Whether loads passed knots in the last pass, and where, as s of the step.
  bool kinked() const { return !places_.empty(); }
  const std::vector<double>& knot_places() const { return places_; }
  /// Calls judge(row, contraction, s, must) for each of these loads; s: of its strongest knot inside the step, 1 if
  /// none is; must: there were more knots than are passed in one step.
  template <class Judge>
  void for_kinked(const Judge& judge) const {
    for (const Place& l : loads_)
      if (l.kinked) judge(l.row, l.contraction, l.strongest, l.unfinished);
  }
  /// Calls note(row, rounding) for every row with such a load: of its torque by that of the angle and speed in the step [N m].
  template <class Note>
  void for_rounding(const Note& note) const {
    for (const Place& l : loads_) note(l.row, l.rounding);
  }
  /// Calls judge(row, off_at_ends, follows) for every row with such a load: how far it is off its projection at the ends of the step and
  /// where no node is; whether it follows the motion.
  template <class Judge>
  void for_rows(const Judge& judge) const {
    for (const Place& l : loads_) judge(l.row, l.off_at_ends, l.feedback);
  }
  /// Work of the tangents' slopes on the unknowns over the step to s, at whose end they stand [J].
  double slope_work(const TaylorSeries& series, double s, const Vector& end);

 private:
  /// A called load at s of the step, on the series' path.
  struct Point {
    double s = 0.0, angle = 0.0, speed = 0.0;  // rad, rad/s
    double beyond = 0.0;                       // its tangent, on the row [N m]
    double torque = 0.0;
  };
  struct Place : TangentLoad, KnottedPlace {
    using TangentLoad::TangentLoad;
    /// Says its knots, but is called as functions are: it bends at speeds, too, which no knot tells.
    bool is_called() const { return feedback && knots != nullptr && knots->piece_follows_speed(); }
    bool kinked = false, unfinished = false;  // what this pass found of the load
    double strongest = 1.0;                   // of the knots passed
    double off_at_ends = 0.0;                 // GaussRule::off_at_ends() [N m], and between the nodes
    double rounding = 0.0, least = 0.0;       // for_rounding(); least_of()
    // Of the last pass: at the nodes, and with the ends.
    std::array<double, GaussRule::kNodes> at_nodes{};
    std::array<Point, GaussRule::kNodes + 2> points{};
  };
  struct Samples;
  double beyond_tangent(const Place& load, const Samples& at, std::size_t q) const;
  void look_between(const TaylorSeries& series);
  void find_loads(const MotionPoint& nominal);
  double differ_knotted(Place& load, const TaylorSeries& series, NodeForces& forces,
                        LegendreProjection& kinks);
  double first_knot_inside(const Place& load, double end) const;
  double pass_knots(Place& load, const TaylorSeries& series, double end, LegendreProjection& kinks);
  void sample(const Place& load, const double* s, Samples& at) const;
  double add_interval(Place& load, double from, double to, LegendreProjection& kinks) const;
  double differ_called(Place& load, const TaylorSeries& series, NodeForces& forces) const;
  class Between;
  double nominal_speed_of(const Place& load, double s) const {
    return load.ratio * (phi_[1] + 2.0 * phi_[2] * s) / h_;
  }
  /// Terms of the load's angle over the step by powers of s, less that at its start [rad].
  void find_angle(const Place& load, const TaylorSeries& series, std::vector<double>& terms) const;
  Point look(const Place& load, double s, double along, double rate, LoadResponse& response) const;

  const System& system_;
  int stride_;
  struct Added {
    const LoadTerm* term;
    bool expanded;
  };
  std::vector<Added> all_;
  std::vector<Place> loads_;               // which act
  bool found_ = false, constant_ = false;  // loads_, at constant nominal speed
  std::vector<double> places_;             // of the knots passed
  std::vector<double> turn_;               // terms of a load's angle over the step, less that at its start
  NodeForces forces_, known_;              // differences, and those of loads that follow no motion
  std::vector<double> path_, rate_;        // by node, then row
  std::array<double, 3> phi_{};
  double t_ = 0.0, h_ = 0.0, nominal_ = 0.0;
};

}  // namespace drev
