#pragma once
/// A scalar element is kinematics times law: x = b^T q - e(t), f = b y(x, x_dot, t).
///
/// A law returns force, slopes, stored energy and dissipated power in one pure call: same input, same
/// output, in any order, any number of times. Its tangent b b^T dy/dx is symmetric by construction.
#include <concepts>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

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
};

/// A known offset e of the deflection and its slope against the nominal angle (transmission error).
struct Offset {
  double e = 0.0, de_dangle = 0.0;
};

/// a + b_x x + b_v x_dot >= 0 holds on a piece; where it ceases to hold, piece `next` takes over.
struct LawBound {
  double a = 0.0, b_x = 0.0, b_v = 0.0;
  int next = 0;
};

/// One piece of a piecewise-linear law, y = y_0 + k x + c x_dot while all its bounds hold. The part
/// elastic_0 + elastic_k x of it is the slope of the stored energy; the rest dissipates. The pieces
/// of a law cover the plane (x, x_dot) without overlap.
struct LawPiece {
  double y_0 = 0.0, k = 0.0, c = 0.0;
  double elastic_0 = 0.0, elastic_k = 0.0;
  std::vector<LawBound> bounds = {};
  double product = 0.0;  ///< of x x_dot, in product_pieces() only
};

/// The law as the engine calls it. Users write a LawOf functor instead (law_element.hpp).
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
  /// Static transmission error at the NOMINAL angle of the phase node.
  virtual Offset offset(double /*nominal_angle*/) const { return {}; }
  /// The next angle beyond `angle` at which the law jumps or kinks with its phase node's angle, on the side
  /// of growing angles where direction > 0; within rounding of one, the next but that.
  virtual std::optional<double> next_knot(double /*angle*/, double /*direction*/) const {
    return std::nullopt;
  }
  /// The law as pieces, for exact propagation; empty: not piecewise linear in x and x_dot alone, but smooth
  /// between its kinks() and knots.
  virtual std::span<const LawPiece> pieces() const { return {}; }
  /// The same where a piece may have a term x x_dot too: a damper that grows with deflection. For many
  /// variants in lanes (simulate_many.hpp).
  virtual std::span<const LawPiece> product_pieces() const { return pieces(); }
};

/// A law in a few lines: any copyable type that can be called with a ScalarInput.
template <class L>
concept ScalarLaw = requires(const L& law, const ScalarInput& in) {
  { law(in) } -> std::convertible_to<ScalarResponse>;
};

/// Makes a ScalarForce of a functor. Optional members of the functor are used where it has them:
/// kinks(), gap(), closed_stiffness(), closed_damping(), pieces() (a vector or span of LawPiece).
template <ScalarLaw L>
class LawForce final : public ScalarForce {
 public:
  explicit LawForce(L law) : law_(std::move(law)) {
    if constexpr (requires { law_.pieces(); }) {
      const auto& pieces = law_.pieces();
      pieces_.assign(pieces.begin(), pieces.end());
    }
  }
  ScalarResponse evaluate(const ScalarInput& in) const override { return law_(in); }
  double closed_stiffness() const override {
    if constexpr (requires { law_.closed_stiffness(); }) return law_.closed_stiffness();
    return ScalarForce::closed_stiffness();
  }
  double closed_damping() const override {
    if constexpr (requires { law_.closed_damping(); }) return law_.closed_damping();
    return ScalarForce::closed_damping();
  }
  std::span<const double> kinks() const override {
    if constexpr (requires { law_.kinks(); }) return law_.kinks();
    return {};
  }
  std::optional<Gap> gap() const override {
    if constexpr (requires { law_.gap(); }) return law_.gap();
    return std::nullopt;
  }
  std::span<const LawPiece> pieces() const override { return pieces_; }

 private:
  L law_;
  std::vector<LawPiece> pieces_;
};

}  // namespace drev
