#pragma once
/// FrictionSeries: which friction contacts are stuck and which slide, their torques along a step of exact
/// propagation, and when that changes.
///
/// A sliding contact adds its torque, whose coefficients follow from those of the slip speed. Stuck ones S hold
/// their slip accelerations at zero: at each degree
///
///   W_SS lambda_S = B_S^T M^-1 (all other forces) + known accelerations,      W = B^T M^-1 B
///
/// so that the motion keeps w_S = 0 to rounding and lambda(s) comes as a polynomial. Where |lambda| meets what the
/// contact can hold, and where a slip speed meets zero, are roots of polynomials (roots.hpp): none is missed.
///
/// Which contacts stick and which slide behind such a change is one complementarity problem over all contacts
/// at rest (box_complementarity.hpp), first of the accelerations. Contacts that it leaves on a bound with zero
/// acceleration are decided by the same problem of the next derivative, along the series that holds there, and
/// so on: a contact that just reaches its bound slides, if its torque would go on to rise.
///
/// A gear with losses is a tie, always among the stuck ones, and a contact whose torque on a bound is a multiple of its
/// tie's: with one unknown x for both (the torque of the shaft that drives) the force b_tie lambda_tie + b_loss
/// lambda_loss has a direction of its own, so that the matrix of the stuck ones is not symmetric then. Efficiencies that
/// follow the speed multiply two series. Which shaft drives is one more bound. (friction_gears.cpp,
/// friction_complementarity.hpp)
#include <drev/core/law/friction.hpp>
#include <drev/solvers/run/evaluated_state.hpp>
#include <drev/solvers/run/observer.hpp>
#include <drev/solvers/run/run_summary.hpp>

#include <algorithm>
#include <array>
#include <optional>

#include "solvers/exact/load_series.hpp"
#include "solvers/series/taylor_series.hpp"

namespace drev {

struct BoxComplementarity;
struct FrictionSolution;
struct GearLossRow;

class FrictionSeries final : public TermForces {
 public:
  explicit FrictionSeries(const System& system);
  bool empty() const { return contacts_.empty(); }

  struct Change {
    double s = 0.0;
    int contact = 0;
    enum class What {
      slip_ends,
      bound_high,
      bound_low,
      knot_above,
      knot_below,
      drive_turns
    } what = What::slip_ends;
    int order = 0;  ///< s = 0: of the first coefficient of the bound that is not zero
  };

  /// Modes at a state where all other forces were evaluated (total); leaves torques in its history.
  void locate(const Assembler& assembler, EvaluatedState& point);
  /// Takes over the modes of another one of the same system.
  void locate_as(const FrictionSeries& other) {
    contacts_ = other.contacts_;
    stuck_ = other.stuck_;
    stuck_inverse_ = other.stuck_inverse_;
    any_on_line_ = other.any_on_line_;
    speed_scale_ = other.speed_scale_;
  }

  /// What is known over a step of h seconds from t on.
  void add_to(TaylorSeries& series, const LoadSeries& known, double t, double h);
  int known_degree() const override { return known_degree_; }
  /// Adds the contacts' part to term k of the series, factor = h^2/(k (k - 1)).
  double add(const TaylorSeries& series, int k, double factor, double* term) override;
  /// Products of slip speeds with powers of an engagement: between them terms may be zero.
  void note_left_out(const TaylorSeries& series, int k, double factor,
                     std::array<double, 2>& most) const override;
  /// After the series was expanded from a state: slip speeds, and bounds. What the series' forces differ from those
  /// evaluated there (their projection) counts as rounding of bounds that stand at zero.
  void expand(const TaylorSeries& series, const State& from);

  std::optional<Change> change_at_once() const;
  std::optional<Change> first_change(double end) const;
  /// How far behind s = 1 the bound is crossed, by Newton's rule.
  double beyond_end(const Change& change) const;
  /// At a change: what sticks and what slides from there on. The point is evaluated there (total), with its
  /// history; at s = 0 the series is expanded from it. True: torques jumped.
  bool pass(const Change& change, const Assembler& assembler, EvaluatedState& point);
  /// The time goes on: bounds that stood at zero are left.
  void forget_roots();

  /// v back to zero slip of the stuck contacts.
  void hold(const Assembler& assembler, Vector& v) const;
  /// Torques, states and heat at s of the step into a history that has those of its start.
  void write(double s, const Vector& start, Vector& history) const;
  /// StepMotion::friction_range() up to s of the step, with no turns told.
  std::optional<StepMotion::Range> torque_range(int place, double s) const;
  /// f += b lambda with the torques in a history.
  void add_forces(const Vector& history, Vector& f) const;
  /// From 0 to s of the step [J].
  double dissipated(double s) const;
  double input(double s) const;

  /// Of a train that friction holds at rest: what rounding of its forces moves over a time [s], as an energy [J].
  double energy_of_rounding(double duration) const;

  /// Some contact is stuck, or a tie: its torque follows from the forces.
  bool holds() const { return !stuck_.empty(); }
  /// The largest torque of a contact.
  double carried() const;
  FrictionState state(int contact) const;
  /// Enters what sticks or slides since the last call into the summary; at the start of the run nothing, and nothing of
  /// ties, which have no state.
  void note_changes(double t, bool at_start, RunSummary& summary);
  ElementId element(int contact) const { return system_.frictions()[idx(contact)].element; }
  int count() const { return static_cast<int>(contacts_.size()); }

 private:
  struct Bound {
    Change::What what;
    std::vector<double> g;  // > 0 while it holds
    int falls = -1;         // at s = 0: its first coefficient that is not zero, which is negative
    int line = -1;          // of a gear: whose bound g is
  };
  struct Contact {
    std::vector<Entry> z, u;  // slip speed over unknowns and known motions
    double nominal = 0.0;     // b^T n
    std::vector<Entry> gain;  // M^-1 b over unknowns
    // Mode: stuck, or sliding with sign. Tied: the stuck ones hold its slip speed at zero, its torque stands on its
    // bound. Open: carries nothing at any speed.
    bool stuck = false, tied = false, open = false;
    int sign = 1;
    int segment = 0;     // of the table of sliding torques, from slip_speeds()[segment] on
    bool loose = false;  // it broke away at this instant
    double bound = 0.0;  // what a tied one carries, per engagement
    bool root = false;   // a slip speed, or the torque's distance to a bound, is zero at s = 0
    int root_bound = 0;  // bound at which the torque stands: 1 high, -1 low
    double speed_rounding = 0.0, torque_rounding = 0.0;
    double acceleration_slack = 0.0;  // rounding of the step's first slip acceleration
    double torque_slack = 0.0;        // and of its first torque
    // Along the step.
    std::array<double, 4> capacity{};  // g(s)
    std::array<double, 2> known{};     // part of w
    std::vector<double> torque, slip, slip_size;
    std::vector<Bound> bounds;
    // Of gears: a tie knows its loss, a loss its tie.
    bool rigid = false;
    int tie = -1, loss = -1;
    int line = 0;            // that its loss is on where it is not stuck: 0 shaft 1 drives, 1 shaft 2
    bool line_root = false;  // it is where the two lines meet at s = 0
    double unit_tie = 1.0, unit_loss = 0.0;  // torques per unit of the gear's unknown
    double rest_tie = 0.0, rest_loss = 0.0;  // and without it, of the degree that is worked at
    // Series of that line's efficiency and bearing torque along the step.
    std::vector<double> efficiency, bearing;
  };
  /// A value of a gear's losses over |w|, on a segment.
  struct LossLine {
    double at_zero = 0.0, slope = 0.0;
  };
  struct LossValues {
    LossLine efficiency, bearing;
  };
  struct Limits {
    double low = 0.0, high = 0.0;
  };
  const Friction& law(std::size_t i) const { return *system_.frictions()[i].friction; }
  double sliding(std::size_t i, double slip) const;
  void find_segment(std::size_t i, double slip);
  /// Per engagement, at rest: what a stuck contact can hold, or one that broke loose at this instant.
  Limits limits(std::size_t i, bool loose) const;
  /// Whether it holds more at rest than it carries where it begins to slide.
  bool breaks_away(std::size_t i) const;
  /// Coefficient d of the slip speed, from the series.
  double slip_term(const Contact& c, const TaylorSeries& series, std::size_t d) const {
    const int k = static_cast<int>(d) + 1;
    return k / h_ * value_along(c.z, series.coefficients(k)) + (d < c.known.size() ? c.known[d] : 0.0);
  }
  double slip_of(const Contact& c, const Assembler& assembler, const Vector& v) const;
  /// at_rest: contacts known to be; others are where their slip is rounding, or within `slack` of zero.
  void resolve(const Assembler& assembler, EvaluatedState& point, const std::vector<char>& at_rest,
               double slack = 0.0);
  void pass_derivative(const Change& change, int order, EvaluatedState& point);
  void take(const std::vector<std::size_t>& of, const FrictionSolution& solution,
            const BoxComplementarity& problem, const std::vector<GearLossRow>& gears);
  void begin_stuck();
  bool depends_on_stuck(std::size_t i) const;
  void factor_stuck();
  void find_bounds(std::size_t i);
  static void clean(Bound& bound, const std::vector<double>& size, double zero, double first, bool on_it,
                    double patience = 1.0, double touch = 0.0);
  double heat(const Contact& contact, double s) const;
  // Of gears: friction_gears.cpp.
  void find_gears();
  bool on_line(const Contact& c) const { return c.tie >= 0 && !c.stuck; }
  LossValues loss_values(const Contact& c, const GearLoss& loss, int line) const;
  void check_ties(const Assembler& assembler, const Vector& v) const;
  /// solve(); its error names the time and the gears.
  FrictionSolution solve_at(double t, const BoxComplementarity& problem,
                            const std::vector<GearLossRow>& gears, const std::vector<std::size_t>& of) const;
  GearLossRow gear_at(std::size_t i, double speed, bool at_rest) const;
  GearLossRow gear_derivative(std::size_t i, const Change& change, int order) const;
  void add_gear(const TaylorSeries& series, std::size_t i, int k, double factor, double* term);
  void factor_series();
  std::vector<double> loss_gap(const Contact& c, const GearLoss& loss, int line, int sign,
                               std::vector<double>& size) const;
  void find_gear_bounds(std::size_t i);
  std::array<Bound, 2> gear_bound(std::size_t i, Change::What what) const;
  double gear_slack(const Contact& c) const;
  double gear_rounding(const Contact& c) const;
  void note_gear(std::size_t i, double speed, Vector& history) const;
  /// Whether bounds[k] and the next one are a gear's two lines: at rest, it holds while either does.
  static bool two_lines(const std::vector<Bound>& bounds, std::size_t k) {
    return k + 1 < bounds.size() && bounds[k].line == 0 && bounds[k + 1].line == 1 &&
           bounds[k].what == bounds[k + 1].what;
  }
  static bool zero_before(const Bound& bound, int order);

  const System& system_;
  std::vector<Contact> contacts_;
  std::vector<FrictionState> noted_;
  Eigen::MatrixXd w_, stuck_inverse_, series_inverse_;  // the last: with the gears' directions
  std::vector<std::size_t> stuck_;
  double h_ = 1.0;
  std::vector<double> largest_;  // coefficient of each degree among the torques: they are solved for together
  int known_degree_ = 0;         // degree of the engagements over the step
  bool gears_ = false, any_on_line_ = false, located_ = false;
  bool resolved_ = false;  // at this instant, from the forces evaluated there
  double patience_ = 1.0;  // doubles with every change at one instant: what counts as rounding there
  /// Factor on rounding of torques at an instant of many changes: more would pass over what does happen.
  double bounded_patience() const { return std::min(patience_, 16.0); }
  double speed_scale_ = 0.0;  // largest speed so far: what rounding of slip speeds is relative to
};

}  // namespace drev
