#pragma once
/// TangentLoad: a smooth load over a step by its tangent at the start, for SmoothLoads and ExpandedLoads,
///
///   torque + slope (theta - theta_0) + speed_slope (w - w_0)
///
/// The slopes go to stiffness and damping; what the load differs from the tangent is added by them.
#include <drev/core/assembler.hpp>
#include <drev/core/law/knotted_load.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "solvers/series/taylor_series.hpp"

namespace drev {

/// A load on a row of a series, where it stands at the step's start.
struct PlacedLoad {
  const LoadTerm* term = nullptr;
  int row = 0;
  double coeff = 0.0, ratio = 0.0;
  bool feedback = false;              // follows the actual motion
  double turn = 0.0, per_turn = 0.0;  // of the angle by its row: coeff and 1/coeff; without feedback 0
  double angle = 0.0, deviation = 0.0, speed = 0.0;  // rad, rad/s
  bool watched = false;                              // its angle may turn back in this step
  double contraction = 0.0;                          // by its kinks in this step: LoadSeries::Pass
  /// Of the load's torque: the acceleration of the unknown that it moves most [1/(kg m^2) or 1/kg], and the same of its row over
  /// the root of the row's mobility.
  double reach = 0.0, push = 0.0;

  PlacedLoad() = default;
  PlacedLoad(const System& system, const LoadTerm& load)
      : term(&load), ratio(system.ratio(load.node)), feedback(load.load->depends_on_motion()) {
    const NodeMap& map = system.node_map(load.node);
    row = system.place(map);
    coeff = map.coeff;
    if (feedback) turn = coeff, per_turn = 1.0 / coeff;
  }
  void find_reach(const TaylorSeries& series) {
    reach = std::abs(coeff) * series.reach(row);
    push = std::abs(coeff) * std::sqrt(series.mobility(row));
  }
  /// Value of the row, an unknown or one of the system's loaded rows.
  double along(const System& system, const Vector& z) const {
    return row < system.size() ? z[row] : system.rows().row(row - system.size()).dot(z);
  }
  void move(const System& system, const MotionPoint& nominal, const Vector& z, const Vector& v) {
    deviation = feedback ? coeff * along(system, z) : 0.0;
    angle = ratio * nominal.value + deviation;
    speed = ratio * nominal.rate + (feedback ? coeff * along(system, v) : 0.0);
  }
};

/// The piece on which a load that says its knots stands.
struct KnottedPlace {
  static constexpr double kBesideKnot =
      1e-12;                           ///< of the angle, at least of 1 rad: on a knot but for rounding
  const KnottedLoad* knots = nullptr;  ///< null: it says none
  CubicPiece piece = {.low = std::numeric_limits<double>::infinity()};  ///< none yet
  double about = 0.0, piece_speed = 0.0;  ///< angle and nominal speed that it is for

  /// The piece about an angle, on a knot that ahead of it in the direction.
  void look_up(double angle, double direction, double nominal_speed) {
    piece = knots->piece(angle, direction, nominal_speed);
    about = angle;
    piece_speed = nominal_speed;
  }
  /// The same where the piece at hand does not hold: nearer to a knot than rounding the load is on the piece ahead.
  void follow(double angle, double direction, double nominal_speed) {
    const double near = kBesideKnot * std::max(1.0, std::abs(angle));
    if (angle > piece.low + near && angle < piece.high - near && nominal_speed == piece_speed) return;
    look_up(angle, direction, nominal_speed);
  }
};

struct TangentLoad : PlacedLoad {
  using PlacedLoad::PlacedLoad;
  double torque = 0.0, slope = 0.0, speed_slope = 0.0;

  /// Adds the tangent along the nominal angle's terms phi over h seconds to p, degree k at p + k stride.
  void add_to(double h, const std::array<double, 3>& phi, int stride, double* p) const {
    p[row] += coeff * torque;
    p[stride + row] += coeff * ratio * (slope * phi[1] + speed_slope * 2.0 * phi[2] / h);
    p[2 * stride + row] += coeff * ratio * slope * phi[2];
  }
  /// Adds the slopes, and what they take from the right side: they act on the change of the motion over the step.
  void add_slopes(TaylorSeries& series, double nominal_speed) const {
    if (speed_slope != 0.0) {
      const double damping = -coeff * coeff * speed_slope;
      series.add_load_damping(row, damping);
      series.widen(row, 0.0, damping);
      series.right_side(0)[row] -= coeff * speed_slope * (speed - nominal_speed);
    }
    if (slope == 0.0) return;
    const double stiffness = coeff * coeff * slope;
    series.add_row_stiffness(row, -stiffness);
    series.widen(row, stiffness, 0.0);
    series.right_side(0)[row] -= coeff * slope * deviation;
  }
};

}  // namespace drev
