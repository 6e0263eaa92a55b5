#pragma once
/// Sweeper: the work behind sweep_nonlinear(). nonlinear_sweep.cpp has its curves, sweep_runs.cpp its runs.
#include <drev/solvers/nonlinear_sweep.hpp>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "solvers/cycle_run.hpp"
#include "solvers/periodic/branch_tracer.hpp"
#include "solvers/periodic/excited_lines.hpp"
#include "solvers/periodic/motion_sections.hpp"

namespace drev {

/// Motions of one number of cycles.
struct SweepFamily {
  std::unique_ptr<LawBalance> balance;
  int harmonics = 0;
  bool resolved = true;    ///< the harmonics that loads excite are among them
  std::vector<int> lines;  ///< harmonics of the orders asked for; beyond all: none
};

struct TracedBranch {
  int cycles = 1;
  Branch branch;
  double run_speed = 0.0;  ///< as SweptBranch::run_speed
};

class Sweeper {
 public:
  Sweeper(const System& system, const NonlinearSweepOptions& options);
  NonlinearSweep run();

 private:
  static constexpr double kSameSpeed = 1e-12;  // relative
  static constexpr double kTraced = 1e-2;      // error of the first motion that a curve is traced from

  SweepFamily& family(int cycles);
  BranchTracer tracer(int cycles);
  bool tell(double part) const { return !options_.progress || options_.progress(part); }
  void trace(int cycles, double speed, const Vector& x, bool from_run = false);
  std::optional<Vector> widened(LawBalance& balance, double speed, const Vector& x) const;
  bool holds(int cycles, double speed, Vector& x);
  bool start_at(double speed);
  bool known(double speed, const Vector& x);
  void collect(std::size_t number);
  SweptMotion motion_of(int cycles, const BranchPoint& point) const;
  SweptMotion asked_for(int cycles, const BranchPoint& point);
  const SweptMotion* nearest(double speed) const;
  bool stable_at(double speed) const;
  bool any_at(double speed) const;
  void fill_with_runs();
  bool start_from(const CycleRunResult& result);
  double away_from(const SweptRun& run, LawBalance& balance, const Vector& x,
                   const std::vector<int>& lines) const;
  int most_harmonics(const LawBalance& balance) const;
  std::vector<double> sample_speeds() const;
  void set_orders();
  double error_of(const MotionSections::Figures& coarse, const MotionSections::Figures& fine, int cycles,
                  int harmonics, double speed);
  void note_excess();
  bool first_of(int cycles) const;
  void find_jumps();

  const System& system_;
  NonlinearSweepOptions options_;
  double low_ = 0.0, high_ = 0.0;
  std::unique_ptr<MotionSections> sections_;
  std::unique_ptr<FloquetProduct> stability_;
  std::unique_ptr<ExcitedLines> excited_;  // of a single cycle
  int excited_harmonics_ = 1;              // that a motion of a single cycle must contain
  mutable std::map<int, SweepFamily> families_;
  std::vector<TracedBranch> traced_;
  NonlinearSweep sweep_;
};

}  // namespace drev
