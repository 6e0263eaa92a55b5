#pragma once
/// ExpandedLaws: laws whose force along a step follows as a power series from that of the motion, by products:
///
///   y = r (y_0 + k x) + (c + g x) x'       on the piece that holds (law_piece.hpp)
///   y_m = y_0 r_m + k sum_i r_i x_{m-i} + (c (m+1) x_{m+1} + g sum_i x_i (m-i+1) x_{m-i+1})/h
///
/// r(theta): pieces_scale() of a law that states its formula (angle_scaled_force.hpp), 1 of one that follows no angle; a
/// straight stretch of it is r_m = slope theta_m, an order E = exp(i n theta) the recurrence
/// E_m = i n/m sum_j j theta_j E_{m-j}. So mesh stiffness by phase, transmission error and damping that grows with
/// penetration take no passes, and a piece is continued analytically behind its end, where the step is cut.
/// Each degree costs a sum of its length. Source: A. Griewank, A. Walther, Evaluating Derivatives, 2nd ed., SIAM, 2008,
/// chapter 13.
#include <drev/core/assembler.hpp>
#include <drev/core/law/angle_scaled_force.hpp>
#include <drev/solvers/run/evaluated_state.hpp>

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "solvers/exact/law_work.hpp"
#include "solvers/series/taylor_series.hpp"

namespace drev {

class LawOffsets;
class LawSeries;
class LoadSeries;

class ExpandedLaws final : public TermForces {
 public:
  explicit ExpandedLaws(const System& system);
  /// The law is one of these: it states pieces, and what scales them, and a method for linear pieces does not do.
  static bool takes(const ScalarTerm& term);
  /// A piece that is the same linear law at any angle: LawSeries adds it.
  static bool is_linear(const ScalarTerm& term, const LawPiece& piece) {
    return term.phase_node < 0 && piece.product == 0.0;
  }

  bool empty() const { return laws_.empty(); }
  /// Takes over which way the angles went.
  void locate_as(const ExpandedLaws& other);

  /// What is known over a step of h seconds from `start` on, where the pieces are those of `pieces`.
  void add_to(TaylorSeries& series, const LawSeries& pieces, const LoadSeries& known,
              const LawOffsets& offsets, const EvaluatedState& start, double h);
  /// Adds the forces' part to term k of the series, factor = h^2/(k (k - 1)).
  double add(const TaylorSeries& series, int k, double factor, double* term) override;
  bool active() const override { return active_; }
  /// Nothing known acts on one that holds.
  bool sweeps() const override { return sweeps_; }
  /// Puts the slopes at s of the step where a sweep to there reads them; and takes them away.
  void use_slopes(TaylorSeries& series, double s);
  void return_slopes(TaylorSeries& series);
  /// Of how much these slopes change along the step, in accelerations of a row of theirs, by angle [1/s^2] and by speed
  /// [1/s]: bounds of their first derivatives by s, and of those behind the kChanges that add_changes() takes; left out: the slope
  /// by a phase whose node is none of the law's own [1/s^2].
  static constexpr int kChanges = 3;
  struct SlopeChange {
    const ScalarTerm* term;
    double by_angle = 0.0, by_speed = 0.0, by_angle_behind = 0.0, by_speed_behind = 0.0, left_out = 0.0;
  };
  const std::vector<SlopeChange>& slope_changes() const { return changes_; }
  /// Adds to the moments of a sweep, which was made without, what the first kChanges derivatives of the slopes make of its
  /// motion: with y = sum of moments that it has, int (e - u)^(j+q)/(j! q!) y du = (j+q)!/(j! q!) of one of them.
  void add_changes(const TaylorSeries& series, int degree, double* moments) const;
  int known_degree() const override { return known_degree_; }

  /// An angle at rest on a knot goes the other way than was assumed: expand anew.
  bool turns_back(const TaylorSeries& series);

  /// Finds all series of the laws, once the motion's series was expanded; what follows reads them.
  void expand(const TaylorSeries& series);
  /// Series of how the pieces of the law are scaled along the path; false: it is none of these.
  bool scale_of(int law, const TaylorSeries& series, std::vector<double>& scale);
  /// Bound of |dr/dtheta| of a law that has a scale, on the stretch of the step [1/rad]; whether r is straight there; and the row that
  /// turns theta.
  struct Turning {
    double steepest = 0.0;
    bool straight = true;
    std::span<const Entry> row = {};
  };
  Turning turning(int law);

  /// First s in (0, end] at which an angle passes a knot.
  std::optional<double> first_knot(const TaylorSeries& series, double end);
  /// Whether, at s up to which a motion was swept, an angle is behind a knot that it is not on the series' path: the knot found.
  bool passes_knot(const TaylorSeries& series, double s);
  /// Part of the step by which the knot last found is later than s, up to which a motion was swept: a step of Newton's rule.
  double knot_later(const TaylorSeries& series, double s) const;
  /// Time [s] on either side of the knot last found for which rounding of the angle leaves the side open.
  double knot_clearance() const { return knot_clearance_; }

  /// From 0 to s; end: what was evaluated at s. swept: up to there a motion was swept.
  LawWork work(const TaylorSeries& series, double s, const EvaluatedState& end, bool swept) const;

 private:
  struct Law {
    int index = 0;
    const ScalarTerm* term = nullptr;
    const AngleScaledForce* scaled = nullptr;                     // null: r = 1
    std::vector<Entry> phase_row;                                 // its phase node's deviation
    std::vector<Entry> gain;                                      // M^-1 b over unknowns
    double direction = 1.0;                                       // in which the angle went last
    double turned_at = std::numeric_limits<double>::quiet_NaN();  // s: it was turned there, once
    bool varies = false;                                          // r over this step
    // Degrees so far: of x and theta; of r, which a law without force needs for its bounds alone; and of dr/dtheta.
    int terms_to = -1, scale_to = -1, slopes_to = -1;
    // The step's piece about `origin`, where its elastic force is zero. active: it acts through terms; works: its work is found at
    // nodes, that of a flank that let go, too, which has no force but loses energy.
    bool active = false, works = false;
    // It acts, in the matrices too, and follows an angle, over whose knots the step may not go.
    bool turns = false;
    double origin = 0.0, y_0 = 0.0, k = 0.0, c = 0.0, g = 0.0, elastic_0 = 0.0, elastic_k = 0.0;
    double angle = 0.0, deflection = 0.0, stored = 0.0;  // at the step's start, the deflection from `origin`
    bool is_spring = false;                              // over the whole step: it is in the series' matrices
    ScaleStretch stretch;                                // about stretch_angle
    double stretch_angle = 0.0;
    std::vector<double> known, known_angle;  // series of what is known of x and theta
    std::vector<double> x, theta, r;
    std::vector<double> x_backward;            // x with its first term last
    std::vector<double> turn, by_phase_terms;  // series of s theta' and dr/dtheta
    // Slopes of use_slopes(), with their derivatives by s.
    std::array<double, kChanges + 1> slope{}, by_speed{}, by_phase{};
    // Of the orders, in whole lanes: order, cosine and sine of ScaleOrder; cos and sin of order theta, by degree.
    std::vector<double> orders, cosine, sine;
  };
  /// Of System::scalars(); null: it is none of these.
  Law* find(int index);
  void note_changes(const Law& law, const double* x, const double* r, const double* p);
  static void add_slopes(TaylorSeries& series, const Law& law, double factor);
  static void add_spring(TaylorSeries& series, Law& law);
  static void start_scale(Law& law);
  static void add_term(Law& law, const double* z, int m);
  static int lanes_of(const Law& law) { return static_cast<int>(law.orders.size() / 3); }
  static void add_scale(Law& law, int m);
  /// How many of the first terms of dr/dtheta are not zero: without orders it is the same all along the step.
  static std::size_t slope_terms(const Law& law, std::size_t terms) {
    if (law.orders.empty()) return law.varies ? 1 : 0;
    return terms;
  }
  static void add_scale_slopes(Law& law);
  static void complete_terms(Law& law, const TaylorSeries& series);
  static void complete(Law& law, const TaylorSeries& series);

  const System& system_;
  Assembler assembler_;
  std::vector<Law> laws_;
  std::vector<SlopeChange> changes_;
  bool active_ = false, sweeps_ = false;
  const Law* knot_law_ = nullptr;  // law of the knot that was found last
  std::vector<double> to_knot_;    // series of the distance to a knot
  int known_degree_ = 0;
  double t_ = 0.0, h_ = 0.0, knot_ = 0.0, knot_clearance_ = 0.0;
};

}  // namespace drev
