#pragma once
/// SmoothLoads: loads without straight stretches (functions, engine orders), for LoadSeries.
///
/// Over a step such a load acts by its tangent at the start, torque + slope (theta - theta_0), whose slope goes to
/// the stiffness; what it differs from that along the path is taken at Gauss's nodes and projected
/// (legendre_projection.hpp). A load that follows no motion is taken there once a step. One that says its harmonics
/// is a polynomial of the angle in cells (harmonic_cells.hpp), so that its cost does not grow with their number.
#include <drev/core/assembler.hpp>

#include <vector>

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
  double project(const TaylorSeries& series, bool first, LegendreProjection& projection);
  /// Calls judge(row, analytic) for every row with such a load; analytic: its projection's coefficients decay, since
  /// the load is a sum of harmonics.
  template <class Judge>
  void for_rows(const Judge& judge) const {
    for (const Place& l : loads_) judge(l.row, l.cells >= 0);
  }
  /// Work of the tangents' slopes on the unknowns, where they stand at `end` [J].
  double slope_work(const TaylorSeries& series, const Vector& end) const;

 private:
  struct Place {
    const LoadTerm* term;
    int row;
    double coeff, ratio;
    bool feedback;
    int cells = -1;                                                  // of cells_
    double torque = 0.0, slope = 0.0, angle = 0.0, deviation = 0.0;  // at the step's start
  };
  double along(int row, const Vector& z) const {
    return row < system_.size() ? z[row] : system_.rows().row(row - system_.size()).dot(z);
  }
  double differ_cells(const Place& load, NodeForces& forces);
  double differ_called(const Place& load, NodeForces& forces) const;

  const System& system_;
  int stride_;
  std::vector<Place> loads_;
  std::vector<HarmonicCells> cells_;
  bool calls_ = false;               // some load is called, and may follow the speed
  NodeForces forces_, known_;        // differences, and those of loads that follow no motion
  std::vector<double> path_, rate_;  // by node, then row
  std::array<double, 3> phi_{};
  double t_ = 0.0, h_ = 0.0, nominal_ = 0.0;
};

}  // namespace drev
