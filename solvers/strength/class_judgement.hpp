#pragma once
/// A sweep judged by the limits of its sections: stress, permissible vibratory torque, speed ranges in which
/// it is exceeded, barred speed ranges by rule, speed ranges of chatter in meshes, heat.
///
/// IACS UR M68.5 has no limit above a speed ratio of 1.05; there the section's limits by number hold alone, or none does
/// (SectionJudgement::rule_ends). The torque at that very speed is judged, too.
///
/// Vibratory torque: half range of the sum of all orders with their phases. If a section has several limits,
/// the lowest applies, each expressed as a torque: tau W by IACS UR M68 (nominal stress), tau W / K of a
/// given stress (local stress, K the stress concentration), a given torque. Where a range begins and ends is
/// known to 1e-7 of the speed if the sweep can be solved at further speeds (SweepAt). Of a sweep alone the torque is
/// interpolated linearly between its speeds and its located peaks; beside an unbounded peak as one over the distance from it.
/// A range so found can be several times as wide as it is where the speeds are far apart; it ends between the speeds stated.
///
/// The ratio of a torque or of chatter to its limit is followed to each of its tops between the speeds and the located peaks if
/// the sweep can be solved at further speeds; of a sweep alone it is judged at these. Heat is judged at its own peak, too.
#include <drev/core/error.hpp>
#include <drev/solvers/periodic/linear_sweep.hpp>
#include <drev/solvers/strength/section_strength.hpp>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace drev {

/// Permissible half range of torque [N m]; not a number: no limit.
struct TorqueLimit {
  double continuous = SectionStrength::kNone, transient = SectionStrength::kNone;
  std::string rule;  ///< source of `continuous`: "IACS UR M68.5", "permissible stress", "permissible torque"
};
/// Limit of a section at a speed ratio (speed over rated speed; not a number: unknown, and no limit by rule).
TorqueLimit torque_limit(const SectionStrength& section, double speed_ratio);

/// A speed range in which a limit is exceeded [rad/s].
struct ExceededRange {
  double from = 0.0, to = 0.0;
  bool open_from = false,
       open_to = false;  ///< true: it begins or ends with the sweep or the limit
  /// The nearest speeds outside at which the limit is known to be kept [rad/s]: the end lies between them and the range. Not a
  /// number: it is open there.
  double kept_below = std::numeric_limits<double>::quiet_NaN(), kept_above = kept_below;
  double worst = 0.0, worst_speed = 0.0;  ///< largest ratio to the limit in it [-], and its speed [rad/s]
  /// Whether it may be barred and passed quickly.
  enum class Passing {
    permitted,       ///< the transient limit is met throughout, and the range is below 0.8 of the rated speed
    near_rated,      ///< it reaches 0.8 of the rated speed
    above_limit,     ///< the transient limit is exceeded
    no_limit,        ///< no transient limit is given, nothing can be said
    no_rated_speed,  ///< no rated speed is given, nothing can be said
  };
  Passing passing = Passing::no_limit;
  bool may_be_passed() const { return passing == Passing::permitted; }
};
const char* to_text(ExceededRange::Passing passing);

/// A barred speed range by IACS UR M68.5 around a critical speed at which the continuous limit is exceeded.
struct RuleBarredRange {
  int critical = 0;    ///< number in LinearSweep::criticals
  double speed = 0.0;  ///< n_c: where the critical's order has its top in this section [rad/s]
  double speed_ratio = 0.0;
  double from = 0.0, to = 0.0;  ///< rad/s; both 0 from a speed ratio of 0.8 on, where none is permitted
};

struct SectionJudgement {
  int section = 0;                          ///< number in LinearSweep::sections
  int strength = 0;                         ///< number in Strength::sections
  double modulus = SectionStrength::kNone;  ///< polar section modulus [m^3]; not a number: no diameter
  Vector stress;                    ///< half range of the local stress at each speed [Pa]; empty: no diameter
  std::vector<TorqueLimit> limits;  ///< limit at each speed
  double utilisation = 0.0;         ///< largest half range over continuous limit [-]
  double utilisation_speed = 0.0;   ///< its speed [rad/s]
  std::string rule;                 ///< rule of the limit at that speed; empty: there is no limit
  /// Highest speed for which IACS UR M68.5 has a limit, a speed ratio of 1.05 [rad/s], and the rule of the limit from there
  /// on (empty: there is none, and the torque is not judged). Not a number: the rule is not asked for, or holds throughout.
  double rule_ends = std::numeric_limits<double>::quiet_NaN();
  std::string rule_beyond;
  std::vector<ExceededRange> exceeded;
  std::vector<RuleBarredRange> barred;
  /// Largest heat [W], and its speed [rad/s]; NaN: it is not known at any speed.
  double heat = std::numeric_limits<double>::quiet_NaN(), heat_speed = heat;
  double permissible_heat = SectionStrength::kNone;  ///< [W]; not a number: no limit
  std::vector<double> heat_unknown;  ///< speeds of the sweep at which heat is not known [rad/s]
  bool heat_exceeds() const { return heat > permissible_heat; }
  bool heat_limited() const { return !std::isnan(permissible_heat); }
  /// Whether the limit may be exceeded where heat is not known.
  bool heat_undecided() const { return heat_limited() && !heat_exceeds() && !heat_unknown.empty(); }
  bool heat_judged() const { return heat_limited() && !heat_undecided(); }
  bool judged() const { return !rule.empty(); }  ///< whether the torque is
  /// Whether the rule that is to judge the torque has a limit at none of the speeds.
  bool torque_undecided() const { return !judged() && !std::isnan(rule_ends); }
};

/// A speed range in which the vibratory force of a mesh exceeds its mean force, so that the teeth hammer.
struct ChatterRange {
  int section = 0;
  ExceededRange range;  ///< worst: largest half range over |mean| [-]
  /// Number of its speeds, and of peaks and points between them, at which the contact's force changes its sign.
  long separated = 0;
};

struct ClassJudgement {
  std::vector<SectionJudgement> sections;
  std::vector<ChatterRange> chatter;
  std::vector<std::string> not_judged;  ///< names of the sections of the sweep without a limit
  /// Speeds asked for at which no motion is known, so that they are not in the sweep [rad/s]: none, unless who asked states them.
  std::vector<double> without_motion;
  bool unstable =
      false;  ///< a mode grows at some of the speeds (LinearSweep::growth): no run settles on what is judged
  /// Of the limits in continuous running, of torque and of heat.
  enum class Verdict {
    within,    ///< all that are given are kept at all speeds
    exceeded,  ///< at least one is exceeded
    undecided,  ///< none is known to be exceeded, but one could not be judged at some of the speeds, or the train is unstable
  };
  Verdict verdict() const;
  bool accepted() const { return verdict() == Verdict::within; }
};

/// Solves the sweep that is judged at other speeds [rad/s], > 0 and ascending: the same sections in the same order.
using SweepAt = std::function<LinearSweep(const std::vector<double>& speeds)>;
/// That of sweep_linear() with the options of the sweep that is judged. The system must outlive it. Errors: those of
/// sweep_linear().
SweepAt sweep_between(const System& system, LinearSweepOptions options);

/// sweep_at: solves the sweep where ratios to the limits are largest and where ranges begin and end, all tops and then all ends at
/// once, about ten to thirty times each; empty: the sweep alone is judged, with ends between its speeds. Throws ModelError where
/// data of a section are out of range or belong to no section of the sweep, and what sweep_at throws.
ClassJudgement judge_sweep(const LinearSweep& sweep, const Strength& strength, const SweepAt& sweep_at = {});

/// Faults of the data themselves, without a sweep: place, parameter, value, unit, range.
std::vector<Finding> check_strength(const Strength& strength);

}  // namespace drev
