#pragma once
/// Steady periodic vibration over speed of a drivetrain with laws that are no straight lines: meshes with
/// backlash or a stiffness that follows the phase, polyline springs, laws of one's own.
///
/// Motions of a cycle of `turns` turns of the reference shaft, in which everything that acts repeats, by harmonic
/// balance (Galerkin's, solvers/periodic/law_balance.hpp); curves of motions over the speed by steps along their
/// arc, through folds (branch_tracer.hpp); stability by the Floquet multipliers of each motion (floquet.hpp). The
/// curves start at the motion with closed contacts, from the last speed, the first and those between that no
/// curve has reached. Where no motion that was found is stable, a run in time from the nearest shows what the train does:
/// a motion that repeats after one or several cycles, whose harmonics then start a curve of its own, where they are
/// enough (else its figures are given), or none that repeats, whose statistics are given.
///
/// What is not sought: curves that neither closed contacts nor a run leads to. Motions between whole numbers of
/// cycles do not repeat; they are described by statistics.
///
/// Free parts: as in linear_sweep.hpp, what is left over of mean torque is reported, and taken up by `balance` or
/// by the acceleration of the part; a run in time keeps their mean speed all the same (speed_hold.hpp).
///
/// Stiffness with a loss factor, or over what an element carries, is that of runs in time (frequency_stiffness.hpp).
///
/// Refused: loads in time, given motions, general elements.
///
/// Harmonics: at least up to the highest that loads and laws excite with closed contacts
/// (solvers/periodic/excited_lines.hpp), but for 1 % of a section's vibration. Where Newton's matrix would have too many
/// rows for that, no curve is followed, and runs answer.
///
/// Errors: of a motion, difference from that with half the harmonics, largest over the cycle and the sections,
/// beside each section's largest value; or what the loads excite beyond its harmonics, where that is more. Of the speed of a fold or a change of stability, the same difference.
#include <drev/solvers/periodic/linear_sweep.hpp>
#include <drev/solvers/periodic/motion_figures.hpp>

#include <complex>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace drev {

struct NonlinearSweepOptions {
  std::vector<double> speeds = {};  ///< of the reference shaft, > 0, ascending, at least two [rad/s]
  /// Orders whose amplitudes are given, a revolution of the reference shaft; empty: those of the cycle's harmonics that
  /// are among 0.5 to 12 by halves, the first 12 harmonics of a cycle of up to 2 turns, and those that loads and laws
  /// excite to more than 1e-3 of a section's vibration, up to 64.
  std::vector<double> orders = {};
  std::vector<std::string> sections = {};  ///< as in LinearSweepOptions
  std::string balance = {};                ///< as in LinearSweepOptions
  double turns = 0.0;       ///< of the reference shaft in a cycle; 0: the fewest in which everything repeats
  double tolerance = 1e-5;  ///< of the error at the speeds asked for; 1e-12 to 0.1; missed: the error says so
  bool runs = true;         ///< runs in time where nothing stable was found
  int run_cycles = 400;     ///< of a run at most, half of it for statistics; >= 40
  int threads = 0;          ///< of the runs, >= 0; 0: one for each processor. The result is the same with any
  std::function<bool(double part)> progress = {};  ///< false: stop
};

/// One periodic motion. Vectors over the sections.
struct SweptMotion : MotionFigures {
  double speed = 0.0;   ///< rad/s
  bool asked = false;   ///< at one of the speeds of the options; else a point of the curve between
  bool judged = false;  ///< multipliers were computed: models of up to 200 unknowns
  bool stable = false;
  double multiplier = 0.0;  ///< largest |Floquet multiplier| over the cycle
  int harmonics = 0;
  double error = 0.0;  ///< relative; NaN at points that were not asked for
  Vector half_range() const { return 0.5 * (maximum - minimum); }
};

struct SweptBranch {
  double turns = 0.0;                ///< of the reference shaft in the motion's cycle
  std::vector<SweptMotion> motions;  ///< along the arc
  bool whole = false;                ///< followed to both ends of the speeds, or closed in itself
  /// Of the run in time whose motion, by its harmonics, the curve was found from [rad/s]; 0: of none, it was found from
  /// closed contacts.
  double run_speed = 0.0;
};

enum class BranchChange {
  fold,             ///< the curve turns back: a train that follows it jumps
  contact,          ///< contacts begin to open
  period_doubling,  ///< a curve of motions of twice the cycle branches off
  torus,            ///< a pair of multipliers leaves the unit circle: motions that do not repeat
  branching,  ///< a multiplier passes +1 without a fold: stability changes, as at the end of a tongue of instability
};
const char* to_text(BranchChange change);

struct SweptChange {
  BranchChange kind = BranchChange::fold;
  int branch = 0;
  double speed = 0.0, error = 0.0;  ///< rad/s
  SweptMotion motion;
  /// Of a fold at which a stable motion ends: half ranges of the one stable motion at that speed; empty: there is
  /// none, or more than one.
  Vector jumps_to;
};

/// A run in time where no motion that was found is stable. Vectors over the sections: of the motion that it repeats, or
/// else of the last half of its cycles.
struct SweptRun {
  double speed = 0.0;  ///< rad/s
  int cycles = 0;      ///< that the figures are of
  std::string reason;  ///< why there is none; empty: there is
  /// Cycles after which the run repeats, to 1e-6 of itself, with what the decay of the distance between cycles leaves to
  /// come: a stable motion that harmonic balance did not find with its harmonics. 0: it does not within 12 cycles,
  /// or there is no run.
  int repeats = 0;
  /// Of a run that repeats, beside each section's largest value: largest change of mean, deviation, lowest and highest
  /// value from the repetition before, and what the decay leaves of it. NaN: it does not repeat.
  double error = std::numeric_limits<double>::quiet_NaN();
  /// Of a run that repeats, its mean's own change, as error; else half of the 95 % interval: the widest
  /// by 20, 10 and 5 batch means.
  Vector mean, mean_error;
  Vector deviation, lowest, highest;  ///< extremes of a run that repeats are located
  /// Mean torque left over on each floating part, as in MotionFigures; the part keeps its mean speed all the same.
  Vector left_over;
};

struct NonlinearSweep {
  static constexpr double kTrusted =
      0.05;  ///< error of a motion above which its stability is not the train's
  std::vector<double> speeds, orders;
  double turns = 0.0;
  struct Section {
    std::string name, unit, twist_unit;
    bool contact = false;
  };
  std::vector<Section> sections;
  std::vector<SweptBranch> branches;
  std::vector<SweptChange> changes;         ///< by branch, along its arc
  std::vector<SweptRun> runs;               ///< by speed
  std::vector<double> unsolved;             ///< speeds at which no periodic motion was found [rad/s]
  std::vector<std::string> floating_parts;  ///< a node of each
  /// Why no curve is followed: loads excite higher harmonics than can be solved for.
  struct Excess {
    bool found = false;
    int needed = 0;         ///< harmonics of the cycle; 0: no number is enough, a load does not repeat in it
    int most = 0;           ///< that can be solved for
    double left_out = 0.0;  ///< largest part of the rms of a vibration that these would leave out [-]
  };
  Excess excess;
};

/// Throws ModelError with everything wrong with options and model; SolverError where a static stiffness is singular.
NonlinearSweep sweep_nonlinear(const System& system, const NonlinearSweepOptions& options);

/// The fewest turns of the reference shaft in which all laws and loads repeat: up to 20 whole turns of it, or of a shaft
/// on which something acts, or a part of them; at most 100. 0: none. speeds: of it, at which loads are looked at [rad/s], > 0; empty:
/// at the nominal one.
double cycle_turns(const System& system, const std::vector<double>& speeds = {});

/// What a sweep of a model that is not linear comes to at each speed, in the form in which it is judged
/// (strength/class_judgement.hpp) and drawn: the worst that the train may do there.
///
/// At each speed asked for, section by section: of the motions that are stable (or not judged) the one with the largest half range, with its
/// mean, extremes and orders; where none is stable, mean, lowest and highest value of the run in time (no orders; heat
/// and twist are not known: NaN). Speeds with neither are left out, and listed. Points of stable curves between two speeds that are
/// higher than at both of them are peaks. There are no criticals: orders meet no natural frequency of a train whose
/// contacts open.
struct WorstMotions {
  LinearSweep sweep;            ///< its speeds are those that have an answer
  std::vector<double> by_runs;  ///< speeds at which a run's statistics stand in it [rad/s]
  std::vector<double> missing;  ///< speeds without any answer [rad/s]
};

WorstMotions worst_motions(const NonlinearSweep& sweep);

}  // namespace drev
