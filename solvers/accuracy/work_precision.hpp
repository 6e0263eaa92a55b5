#pragma once
/// Error against time and work: what each method costs for which accuracy, on one system.
///
/// Every method runs over its steps or tolerances. The error of a run is the largest difference of the
/// channels from a reference, over all channels and samples, relative to the largest |value| of any of them.
/// The reference is run at a tolerance far below everything drawn, and checked by a second, different method:
/// their difference, measured the same way, is the agreement, and no error below it means anything.
///
/// Steps are the sample interval divided by powers of two, so that sampling shortens none of them; methods
/// that choose their own steps end one at each sample while the error is found, and run without samples
/// while the time is measured. Time: processor time without observers, the least of several runs where a run
/// is short. Work: linear solves (RunSummary.solves).
#include <drev/core/system.hpp>
#include <drev/solvers/method.hpp>

#include <optional>
#include <string>
#include <vector>

namespace drev {

struct WorkPrecisionOptions {
  std::vector<std::string> channels = {};  ///< of one unit; empty: all unknowns
  double sample_interval = 0.0;            ///< s
  int samples = 64;                        ///< the runs last samples * sample_interval
  /// Names; NAME@tolerance for controlled steps instead of constant ones.
  std::vector<std::string> methods = {};
  /// Runs that would take longer than this [s] are left out, and with them all finer ones of the method.
  double most_seconds = 2.0;
  std::function<bool(double)> progress = {};  ///< part done, 0..1; return false to stop
};

struct WorkPoint {
  Method method = {};
  bool ok = false;  ///< false: the run failed, for the reason given
  std::string reason = {};
  double error = 0.0;    ///< relative
  double seconds = 0.0;  ///< processor time
  double work = 0.0;
};

struct WorkCurve {
  std::string name;
  std::vector<WorkPoint> points;  ///< coarse to fine
};

struct WorkPrecision {
  double t_end = 0.0;            ///< s
  double peak = 0.0;             ///< that errors are relative to
  std::string unit;              ///< of the peak
  std::string reference, check;  ///< methods, with their knobs
  double agreement = 0.0;        ///< of the two
  std::vector<WorkCurve> curves;
  bool interrupted = false;
  /// Errors that mean something.
  bool trusted(const WorkPoint& p) const { return p.ok && p.error >= agreement; }
  /// The cheapest point of all curves from which on a method keeps the error, at it and at all finer
  /// points; none: no method, or the agreement does not reach as far.
  struct Best {
    const WorkCurve* curve = nullptr;
    const WorkPoint* point = nullptr;
  };
  std::optional<Best> cheapest(double error) const;
  /// The same within one curve.
  const WorkPoint* cheapest(const WorkCurve& curve, double error) const;
};

/// Throws ModelError for bad options, SolverError where no reference can be had.
WorkPrecision work_precision(const System& system, const WorkPrecisionOptions& options);

}  // namespace drev
