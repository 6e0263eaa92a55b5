#pragma once
/// ProjectedLaws: laws that state neither linear pieces nor products (expanded_laws.hpp), a user's own, for TaylorSeries.
///
/// Between its kinks() such a law is smooth. Its tangent at the step's start goes into the matrices; what
/// y(x, x', t, angle) differs from it along the series' path is projected (legendre_projection.hpp), pass by
/// pass until the path settles. Steps end where x passes a kink (law_series.hpp) or the angle passes a knot
/// of the law (a stiffness that steps).
#include <drev/solvers/run/evaluated_state.hpp>

#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "solvers/exact/law_work.hpp"
#include "solvers/series/legendre_projection.hpp"
#include "solvers/series/taylor_series.hpp"

namespace drev {

class ProjectedLaws {
 public:
  explicit ProjectedLaws(const System& system);

  bool empty() const { return laws_.empty(); }

  /// Adds the tangents at the step's start, the point's inputs and responses; the step has h seconds.
  void add_to(TaylorSeries& series, const EvaluatedState& start, double h);
  /// Adds the differences along the series' path, on the right side; returns how much of a change of the
  /// path comes back.
  double project(const TaylorSeries& series, LegendreProjection& projection);
  /// Looks at what was projected last between the nodes, for for_rows().
  void look_between(const TaylorSeries& series);
  /// Calls judge(row, off, true) for every row on which such a law acts: as SmoothLoads::for_rows(). A law is to say where it kinks; one
  /// that does not is looked at between the nodes, at the ends of the step and where its deflection turns.
  template <class Judge>
  void for_rows(const Judge& judge) const {
    for (const Law& law : laws_)
      for (const Entry& e : law.term->z) judge(e.index, std::abs(e.coeff) * law.off, true);
  }
  /// As SmoothLoads::for_rounding().
  template <class Note>
  void for_rounding(const Note& note) const {
    for (const Law& law : laws_)
      for (const Entry& e : law.term->z) note(e.index, std::abs(e.coeff) * law.rounding);
  }

  /// Series of how the pieces of the law are scaled by its angle along the path (ScalarForce::pieces_scale).
  void expand_scale(int law, const TaylorSeries& series, std::vector<double>& scale);

  /// First s in (0, end] at which an angle passes a knot.
  std::optional<double> first_knot(const TaylorSeries& series, double end);
  /// Time [s] on either side of the knot last found for which rounding of the angle leaves the side open.
  double knot_clearance() const { return knot_clearance_; }

  /// From 0 to s; end: what was evaluated at s.
  LawWork work(const TaylorSeries& series, double s, const EvaluatedState& end);

 private:
  struct Law {
    int index;
    const ScalarTerm* term;
    std::vector<Entry> phase_row = {};  // its phase node's deviation
    double k = 0.0, c = 0.0;
    double y = 0.0, x = 0.0, x_dot = 0.0;  // y and b^T z, b^T v at the start
    double angle = 0.0, stored = 0.0;
    std::array<double, GaussRule::kNodes> at_nodes{};  // beyond its tangent, as all these
    double off = 0.0, rounding = 0.0;
  };
  struct Point;
  Point look(const Law& law);

  const System& system_;
  Assembler assembler_;
  std::vector<Law> laws_;
  std::vector<double> g_;
  NodeForces forces_;
  Vector z_, v_;
  double t_ = 0.0, h_ = 0.0, knot_clearance_ = 0.0;
};

}  // namespace drev
