#pragma once
/// A sweep judged by what its sections may carry: stress, permissible vibratory torque, ranges of speed in which it is
/// exceeded, barred ranges by rule, ranges of chatter in meshes, heat.
///
/// Vibratory torque: half range of the sum of all orders with their phases. Of several limits of a section the
/// lowest holds, as a torque: tau W by IACS UR M68 (nominal stress), tau W / K of a stress by number (local stress, K
/// the stress concentration), a torque by number. Between speeds of the sweep and its located peaks, torque is taken
/// as straight.
#include <drev/core/error.hpp>
#include <drev/solvers/periodic/linear_sweep.hpp>
#include <drev/solvers/strength/section_strength.hpp>

#include <string>
#include <vector>

namespace drev {

/// Permissible half range of torque [N m]; not a number: no limit.
struct TorqueLimit {
  double continuous = SectionStrength::kNone, transient = SectionStrength::kNone;
  std::string rule;  ///< "IACS UR M68.5", "permissible stress", "permissible torque": of the continuous limit
};
/// Of a section at a speed ratio (speed over rated speed; not a number: not known, and no limit by rule).
TorqueLimit torque_limit(const SectionStrength& section, double speed_ratio);

/// Speeds at which something is exceeded [rad/s].
struct ExceededRange {
  double from = 0.0, to = 0.0;
  bool open_from = false,
       open_to = false;                   ///< it begins or ends with the speeds of the sweep or of the limit
  double worst = 0.0, worst_speed = 0.0;  ///< largest ratio in it, and where
  bool may_be_passed =
      false;  ///< the transient limit is kept in all of it, and it lies below 0.8 of the rated speed
};

/// A barred range by IACS UR M68.5 about a critical at which the continuous limit is exceeded.
struct RuleBarredRange {
  int critical = 0;  ///< in LinearSweep::criticals
  double speed_ratio = 0.0;
  double from = 0.0, to = 0.0;  ///< rad/s; both 0 from a speed ratio of 0.8 on, where none is permitted
};

struct SectionJudgement {
  int section = 0;                          ///< in LinearSweep::sections
  int strength = 0;                         ///< in Strength::sections
  double modulus = SectionStrength::kNone;  ///< polar section modulus [m^3]; not a number: no diameter
  Vector stress;  ///< half range of the local stress over the speeds [Pa]; empty: no diameter
  std::vector<TorqueLimit> limits;  ///< over the speeds
  double utilisation = 0.0;         ///< largest half range over continuous limit; 0: there is no limit
  double utilisation_speed = 0.0;   ///< rad/s
  std::string rule;                 ///< of the limit there
  std::vector<ExceededRange> exceeded;
  std::vector<RuleBarredRange> barred;
  double heat = 0.0, heat_speed = 0.0;  ///< largest [W], and where [rad/s]
  bool judged() const { return utilisation > 0.0; }
};

/// Speeds at which the vibratory force of a mesh exceeds its mean: it hammers.
struct ChatterRange {
  int section = 0;
  ExceededRange range;  ///< worst: half range over |mean|
  long separated = 0;   ///< speeds of the sweep in it at which the closed contact's force changes its sign
};

struct ClassJudgement {
  std::vector<SectionJudgement> sections;
  std::vector<ChatterRange> chatter;
  std::vector<std::string> not_judged;  ///< sections of the sweep without a limit
  bool accepted() const;                ///< nothing that is judged exceeds its limit in continuous running
};

/// Throws ModelError where data of a section are out of their range or fit no section of the sweep.
ClassJudgement judge_sweep(const LinearSweep& sweep, const Strength& strength);

/// What is wrong with the data themselves, without a sweep: place, parameter, value, unit, range.
std::vector<Finding> check_strength(const Strength& strength);

}  // namespace drev
