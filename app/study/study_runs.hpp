#pragma once
/// Runs of the camshaft for the studies, side by side on all processors.
#include <drev/core/assembler.hpp>
#include <drev/core/channel.hpp>
#include <drev/models/model_case.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/run/evaluated_state.hpp>
#include <drev/solvers/run/peaks.hpp>

#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "app/study/study.hpp"

namespace drev::app {

/// Calls task(0) to task(count - 1), each once, from several threads; throws what the first of them to fail
/// threw. Ends early with SolverError when the process is interrupted.
void for_all(std::size_t count, const std::function<void(std::size_t)>& task);

/// Average acceleration at the source's step.
Method source_method();
/// Exact propagation to a tolerance.
Method exact_method(double tolerance);
/// run_method that gives up, with SolverError, when the process is interrupted or the run fails. A balance
/// that is off is left to the caller.
RunSummary run_watched(const System& system, const Method& method, double t_end,
                       const std::vector<Observer*>& observers);

/// The largest |value| of all channels in each of the windows [start + k length, start + (k + 1) length).
class WindowPeaks final : public Observer {
 public:
  WindowPeaks(std::vector<Channel> channels, bool inside_steps, double start, double length);
  void start(const Assembler& assembler, const EvaluatedState& point) override;
  void step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) override;
  void restart(const Assembler& assembler, const EvaluatedState& point) override {
    peaks_.restart(assembler, point);
  }
  double next_stop(double /*t*/) const override { return edge(window_ + 1); }
  bool needs_acceleration() const override { return peaks_.needs_acceleration(); }
  void look_through(StepMotion& motion) override { peaks_.look_through(motion); }
  /// Of the windows that are over.
  const std::vector<double>& amplitudes() const { return amplitudes_; }
  /// Of the whole run, what is before `start` with it.
  double largest() const { return std::max(largest_, amplitude()); }

 private:
  double edge(long k) const { return start_ + static_cast<double>(k) * length_; }
  double amplitude() const { return peaks_.peaks()[peaks_.largest()].amplitude(); }
  Peaks peaks_;
  double start_, length_, largest_ = 0.0;
  long window_;  // -1: before the first
  std::vector<double> amplitudes_;
};

/// What the studies compare, of one run of the source's 5 s.
struct CamshaftFigures {
  double deflection = 0.0;  ///< deg, largest twist from the first to the last cam
  double torque = 0.0;      ///< N m, largest of all sections
  /// The same of each revolution from 1 s on, mean; of exact runs only.
  double settled_deflection = 0.0, settled_torque = 0.0;
  double front = 0.0, back = 0.0;  ///< impacts on the flanks, both meshes
  RunSummary summary;
};

/// nudge: of the free end at the start [rad]. A run that another study has made is not made again.
CamshaftFigures run_camshaft(const ParameterValues& parameters, const Method& method, double nudge = 0.0);

/// A case at the source's step and by exact runs.
struct CamshaftCase {
  std::vector<CamshaftFigures> source, exact;
  bool statistic = false;  ///< starts 1e-9 rad apart; else one run at the step, two tolerances
  using Member = double CamshaftFigures::*;
  Estimate estimate(Member member) const;
  Estimate deflection() const { return estimate(&CamshaftFigures::deflection); }
  Estimate torque() const { return estimate(&CamshaftFigures::torque); }
  /// At the source's step, mean of the runs; and as a cell of a table, with their range.
  double at_step(Member member) const;
  std::string step_cell(Member member) const;
};

/// Cases of the camshaft, each given by its parameters (the source's loads unless they say otherwise).
/// runs = 2: exact to two tolerances; an error is twice the difference. More, for motion that forgets its
/// start: to one tolerance from starts 1e-9 rad apart; errors are intervals of the mean. At the source's step
/// the same, with eight.
std::vector<CamshaftCase> run_cases(const std::vector<ParameterValues>& cases, int runs);

/// Largest static torque of all sections over the model case's turn [N m].
double static_torque(const ModelCase& model_case);

/// Mean of values with its 95 % interval (Student's t).
Estimate mean_of(const std::vector<double>& values);
/// fine, with twice its difference from coarse, and rounding.
Estimate from_two(double coarse, double fine, double tolerance);

/// Relative, of solve_modes(): the worst measured (solvers/modes.hpp).
inline constexpr double kModeError = 5e-12;
/// What average acceleration at step h [s] shows of a frequency, w' of w: tan(w' h/2) = w h/2.
double shown_at_step(double frequency_Hz, double h);

/// "stands" or "does not stand".
std::string stands(bool it_does);
/// value with 5 digits, for a column of a table.
std::string cell(double value);
/// A published value with the digits it was printed with.
std::string printed(double value);
/// "+12 %", of value over reference.
std::string percent(double value, double reference);

}  // namespace drev::app
