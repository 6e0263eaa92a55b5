#pragma once
/// SmoothLoads: loads without straight stretches (functions, engine orders), for LoadSeries.
///
/// Over a step such a load acts by its tangent at the start, torque + slope (theta - theta_0), whose slope goes to
/// the stiffness; what it differs from that along the path is taken at Gauss's nodes and projected
/// (legendre_projection.hpp). A load that follows no motion is taken there once a step. One that says its harmonics
/// is a polynomial of the angle in cells (harmonic_cells.hpp), so that its cost does not grow with their number.
///
/// A load that says its knots (KnottedLoad: an engine's gas pressure) passes them inside the step: the path between two
/// of them has Gauss's nodes of its own, and what the load differs from its tangent is projected apart from the smooth
/// loads, as kinks of tables are. A knot that leaves too much of the motion inside the step ends it.
#include <drev/core/assembler.hpp>

#include <memory>
#include <vector>

#include "core/law/curve_cells.hpp"
#include "solvers/exact/harmonic_cells.hpp"
#include "solvers/exact/legendre_projection.hpp"
#include "solvers/exact/taylor_series.hpp"

namespace drev {

class SmoothLoads {
 public:
  explicit SmoothLoads(const System& system)
      : system_(system), stride_(TaylorSeries::stride(system)), forces_(stride_), known_(stride_) {}

  /// A load that states no stretch; row: of the series.
  void add(const LoadTerm& term);
  bool empty() const { return loads_.empty(); }

  /// Tangents at a state, where the assembler stands.
  void move(const Assembler& assembler, const Vector& z, const Vector& v);
  /// Takes over the tangents of another one of the same system.
  void move_as(const SmoothLoads& other);

  /// Adds the tangents along the nominal angle's terms phi to p, degree k at p + k stride.
  void add_to(double h, const std::array<double, 3>& phi, double* p);
  /// Adds the tangents' slopes to the stiffness, and what they take from the right side.
  void add_slopes(TaylorSeries& series) const;
  /// Adds to the projection what the loads differ from their tangents along the series' path; returns how much of
  /// a change of the path comes back. first: the step is new.
  /// kinks: takes the loads that pass knots in the step.
  double project(const TaylorSeries& series, bool first, LegendreProjection& projection,
                 LegendreProjection& kinks);
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
  /// Calls judge(row, analytic) for every row with such a load; analytic: its projection's coefficients decay, since
  /// the load is a sum of harmonics.
  template <class Judge>
  void for_rows(const Judge& judge) const {
    for (const Place& l : loads_) judge(l.row, l.cells >= 0 || (l.knots != nullptr && l.monotone));
  }
  /// Work of the tangents' slopes on the unknowns from 0 to s of the step, where they stand at `end` [J].
  double slope_work(const TaylorSeries& series, double s, const Vector& end) const;

 private:
  struct Place {
    const LoadTerm* term;
    int row;
    double coeff, ratio;
    bool feedback;
    int cells = -1;  // of cells_
    const KnottedLoad* knots = nullptr;
    std::shared_ptr<const CurveCells> curves = {};  // of knots; none: it is called
    // Of knots: the piece at the step's start, about an angle, at a nominal speed; none yet.
    CubicPiece piece = {.low = std::numeric_limits<double>::infinity()};
    double about = 0.0, piece_speed = 0.0;
    bool pieced = false;                                             // piece and curves say the load
    bool kinked = false, unfinished = false, monotone = true;        // in this pass
    double contraction = 0.0, strongest = 1.0;                       // of the knots passed
    double torque = 0.0, slope = 0.0, angle = 0.0, deviation = 0.0;  // at the step's start
    double speed = 0.0, rate = 0.0, speed_slope = 0.0;               // of knots: w, its part of the deviation
  };
  double along(int row, const Vector& z) const {
    return row < system_.size() ? z[row] : system_.rows().row(row - system_.size()).dot(z);
  }
  struct Samples;
  double beyond_tangent(const Place& load, const Samples& at, std::size_t q) const;
  void move_knotted(Place& load, const Assembler& assembler, const Vector& z, const Vector& v);
  double differ_knotted(Place& load, const TaylorSeries& series, NodeForces& forces,
                        LegendreProjection& kinks);
  double pass_knots(Place& load, const TaylorSeries& series, double end, LegendreProjection& kinks);
  void sample(const Place& load, const CubicPiece& piece, double about, const double* s, Samples& at) const;
  double add_interval(Place& load, const CubicPiece& piece, double about, double from, double to,
                      LegendreProjection& kinks) const;
  double differ_cells(const Place& load, NodeForces& forces);
  double differ_called(const Place& load, NodeForces& forces) const;

  const System& system_;
  int stride_;
  std::vector<Place> loads_;
  std::vector<HarmonicCells> cells_;
  bool calls_ = false;               // some load is called, or may follow the speed
  std::vector<double> places_;       // of the knots passed
  std::vector<double> turn_;         // terms of a load's angle over the step, less that at its start
  NodeForces forces_, known_;        // differences, and those of loads that follow no motion
  std::vector<double> path_, rate_;  // by node, then row
  std::array<double, 3> phi_{};
  double t_ = 0.0, h_ = 0.0, nominal_ = 0.0;
};

}  // namespace drev
