#pragma once
/// A scalar element is kinematics times law: x = b^T q - e(t), f = b y(x, x_dot, t).
///
/// A law returns force, slopes, stored energy and dissipated power in one pure call: same input, same
/// output, in any order, any number of times. Its tangent b b^T dy/dx is symmetric by construction.
#include <drev/core/law/law_piece.hpp>

#include <optional>
#include <span>

namespace drev {

/// What a law sees. x is m along a line of action, rad for a twist, m for a translation.
struct ScalarInput {
  double x = 0.0;      ///< deflection, positive as the element's header says
  double x_dot = 0.0;  ///< its rate
  double t = 0.0;      ///< time [s]
  double angle = 0.0;  ///< actual angle theta = n phi + q of the term's phase node [rad], else 0
};

/// What a law returns.
struct ScalarResponse {
  double y = 0.0;                 ///< force [N] or torque [N m]; opposes x: f = +b y on the left side
  double dy_dx = 0.0;             ///< slope in x
  double dy_dx_dot = 0.0;         ///< slope in x_dot
  double dy_dangle = 0.0;         ///< slope in angle (mesh stiffness by phase), else 0
  double stored_energy = 0.0;     ///< J, >= 0
  double dissipated_power = 0.0;  ///< W, >= 0 for a passive law
};

/// Open interval of x in which the two sides do not touch.
struct Gap {
  double low = 0.0, high = 0.0;
  /// 1: x is beyond the upper edge, -1: beyond the lower one, 0: in the gap or on an edge.
  int side(double x) const { return x > high ? 1 : x < low ? -1 : 0; }
};

/// A known offset e of the deflection and its slope against the nominal angle (transmission error).
struct Offset {
  double e = 0.0, de_dangle = 0.0;
};

/// The law as the engine calls it. Users write a law of a few lines instead (law_element.hpp).
class ScalarForce {
 public:
  virtual ~ScalarForce() = default;
  virtual ScalarResponse evaluate(const ScalarInput& in) const = 0;

  /// Slopes to linearise about when the contact is said to be closed (mean over the mesh phase).
  virtual double closed_stiffness() const { return evaluate({}).dy_dx; }
  virtual double closed_damping() const { return evaluate({}).dy_dx_dot; }
  /// Values of x at which the slope jumps, ascending. The line search is exact between them.
  virtual std::span<const double> kinks() const { return {}; }
  /// The gap, for a law that has one: contact states and statistics are counted against it.
  virtual std::optional<Gap> gap() const { return std::nullopt; }
  /// True if the stored energy depends on angle or t as well as on x.
  virtual bool varies() const { return false; }
  /// Static transmission error at the NOMINAL angle of the phase node; whether there is any.
  virtual Offset offset(double /*nominal_angle*/) const { return {}; }
  virtual bool has_offset() const { return true; }
  /// The next angle beyond `angle` at which the law jumps or kinks with its phase node's angle, on the side
  /// of growing angles where direction > 0; within rounding of one, the next but that.
  virtual std::optional<double> next_knot(double /*angle*/, double /*direction*/) const {
    return std::nullopt;
  }
  /// The same of the offset's slope, along the NOMINAL angle.
  virtual std::optional<double> next_offset_knot(double /*nominal_angle*/, double /*direction*/) const {
    return std::nullopt;
  }
  /// The law as pieces; empty: it has none, but is smooth between its kinks() and knots. A law that states
  /// pieces should state nothing else (PiecewiseForce, piecewise_law.hpp).
  virtual std::span<const LawPiece> pieces() const { return {}; }
  /// s > 0: at this angle the law is s Y(x, x_dot/s), where Y is what the pieces say (a mesh stiffness that
  /// follows the phase). Smooth between next_knot()s.
  virtual double pieces_scale(double /*angle*/) const { return 1.0; }
};

/// The pieces of a term's law where nothing in it follows an angle and all of them are linear in x and x_dot,
/// for methods that take no product; else none. Term: ScalarSpec or ScalarTerm.
template <class Term>
std::span<const LawPiece> linear_pieces(const Term& term) {
  if (term.phase_node >= 0) return {};
  const std::span<const LawPiece> pieces = term.force->pieces();
  return is_linear(pieces) ? pieces : std::span<const LawPiece>();
}

}  // namespace drev
