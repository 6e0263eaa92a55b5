#pragma once
/// A sweep judged by the limits of its sections: stress, permissible vibratory torque, speed ranges in which
/// it is exceeded, barred speed ranges by rule, speed ranges of chatter in meshes, heat.
///
/// Vibratory torque: half range of the sum of all orders with their phases. If a section has several limits,
/// the lowest applies, each expressed as a torque: tau W by IACS UR M68 (nominal stress), tau W / K of a
/// given stress (local stress, K the stress concentration), a given torque. Between speeds of the sweep and
/// its located peaks the torque is interpolated linearly.
#include <drev/core/error.hpp>
#include <drev/solvers/periodic/linear_sweep.hpp>
#include <drev/solvers/strength/section_strength.hpp>

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
       open_to = false;                   ///< true: it begins or ends with the sweep or the limit
  double worst = 0.0, worst_speed = 0.0;  ///< largest ratio to the limit in it [-], and its speed [rad/s]
  /// True: the transient limit is met throughout, and the range is below 0.8 of the rated speed.
  bool may_be_passed = false;
};

/// A barred speed range by IACS UR M68.5 around a critical speed at which the continuous limit is exceeded.
struct RuleBarredRange {
  int critical = 0;  ///< number in LinearSweep::criticals
  double speed_ratio = 0.0;
  double from = 0.0, to = 0.0;  ///< rad/s; both 0 from a speed ratio of 0.8 on, where none is permitted
};

struct SectionJudgement {
  int section = 0;                          ///< number in LinearSweep::sections
  int strength = 0;                         ///< number in Strength::sections
  double modulus = SectionStrength::kNone;  ///< polar section modulus [m^3]; not a number: no diameter
  Vector stress;                    ///< half range of the local stress at each speed [Pa]; empty: no diameter
  std::vector<TorqueLimit> limits;  ///< limit at each speed
  double utilisation = 0.0;         ///< largest half range over continuous limit [-]; 0: there is no limit
  double utilisation_speed = 0.0;   ///< its speed [rad/s]
  std::string rule;                 ///< rule of the limit at that speed
  std::vector<ExceededRange> exceeded;
  std::vector<RuleBarredRange> barred;
  double heat = 0.0, heat_speed = 0.0;  ///< largest heat [W], and its speed [rad/s]
  bool judged() const { return utilisation > 0.0; }
};

/// A speed range in which the vibratory force of a mesh exceeds its mean force, so that the teeth hammer.
struct ChatterRange {
  int section = 0;
  ExceededRange range;  ///< worst: largest half range over |mean| [-]
  long separated = 0;   ///< number of its speeds at which the closed contact's force changes its sign
};

struct ClassJudgement {
  std::vector<SectionJudgement> sections;
  std::vector<ChatterRange> chatter;
  std::vector<std::string> not_judged;  ///< names of the sections of the sweep without a limit
  bool accepted() const;                ///< whether no judged section exceeds its limit in continuous running
};

/// Throws ModelError where data of a section are out of range or belong to no section of the sweep.
ClassJudgement judge_sweep(const LinearSweep& sweep, const Strength& strength);

/// Faults of the data themselves, without a sweep: place, parameter, value, unit, range.
std::vector<Finding> check_strength(const Strength& strength);

}  // namespace drev
