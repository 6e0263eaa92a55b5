#include <drev/core/assembler.hpp>
#include <drev/core/error.hpp>
#include <drev/core/load.hpp>
#include <drev/core/units.hpp>
#include <drev/solvers/modes/damped_modes.hpp>
#include <drev/solvers/nonlinear_sweep.hpp>
#include <drev/solvers/periodic/linear_sweep.hpp>
#include <drev/solvers/periodic/periodic_response.hpp>
#include <drev/solvers/start.hpp>
#include <drev/solvers/statics.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/names/rounded_text.hpp"

namespace drev {

namespace {

constexpr double kSameFrequency = 1e-9;  // relative
constexpr double kMostMultiple = 1000;   // largest frequency over the shared one
constexpr int kTimesOfCycle = 97;        // times of a cycle at which loads are compared
constexpr double kSameLoad = 1e-8;       // relative
constexpr double kMostCycles = 1e5;      // cycles of a run that settles
constexpr int kMostRuns = 3;             // runs, one after the other, in which it is to settle
constexpr double kInstant = 1e-9;        // s, in which a run-up from rest is still at rest

/// Of loads and given motions [Hz].
std::vector<double> frequencies_of(const System& system) {
  std::vector<double> frequencies;
  for (const LoadTerm& term : system.loads())
    for (const double frequency : term.load->frequencies()) frequencies.push_back(frequency);
  for (const Motion& motion : system.prescribed())
    if (motion.frequency > 0.0) frequencies.push_back(motion.frequency);
  return frequencies;
}

/// The largest frequency that divides all of these [Hz]; 0: there is none, or it is too low.
double shared_frequency(const std::vector<double>& frequencies) {
  double shared = 0.0, highest = 0.0;
  for (const double frequency : frequencies) {
    highest = std::max(highest, frequency);
    double a = std::max(frequency, shared), b = std::min(frequency, shared);
    while (b > kSameFrequency * highest * kMostMultiple) {
      const double rest = std::remainder(a, b);
      a = b;
      b = std::abs(rest);
    }
    shared = a;
  }
  return shared * kMostMultiple > highest ? shared : 0.0;
}

/// Speed of the reference shaft where it is constant over the run [rad/s]; 0: it stands, or there is none.
double constant_speed_of(const System& system, double duration) {
  const auto& reference = system.reference();
  if (!reference || !reference->at) return 0.0;
  const double speed = reference->at(0.0).rate;
  for (int i = 1; i <= 8; ++i)
    if (const double later = reference->at(duration * i / 8).rate;
        std::abs(later - speed) > 1e-12 * std::abs(speed))
      throw SolverError(system.name() + ": the nominal speed changes over the run, from " +
                        to_text(to_rpm(speed)) + " rpm to " + to_text(to_rpm(later)) + " rpm at " +
                        to_text(duration * i / 8) +
                        " s: a run-up has no periodic steady state to start from");
  return std::abs(speed);
}

/// Cycles to try, at this speed of the reference shaft [rad/s; 0: none turns]: of so many turns of it, of what acts in time, and of
/// both [s].
std::vector<double> cycles_of(const System& system, double speed, const std::vector<double>& turns_of_it) {
  std::vector<double> turns;
  if (speed > 0.0)
    for (const double n : turns_of_it)
      if (n > 0.0) turns.push_back(n * kTwoPi / speed);
  std::vector<double> cycles = turns;
  std::vector<double> frequencies = frequencies_of(system);
  if (const double shared = shared_frequency(frequencies); shared > 0.0) cycles.push_back(1.0 / shared);
  if (frequencies.empty()) return cycles;
  for (const double turn : turns) {
    frequencies.push_back(1.0 / turn);
    if (const double shared = shared_frequency(frequencies); shared > 0.0) cycles.push_back(1.0 / shared);
    frequencies.pop_back();
  }
  return cycles;
}

/// Whether all that acts where nothing deviates repeats after the cycle, at the speed of the start.
bool repeats(const System& system, double cycle) {
  Assembler assembler(system);
  const Vector zero = Vector::Zero(system.size());
  Vector now = zero, later = zero;
  double largest = 0.0, change = 0.0;
  for (int i = 0; i < kTimesOfCycle; ++i) {
    const double t = cycle * (i + 0.5) / kTimesOfCycle;
    assembler.set_time_ahead(0.0, t);
    assembler.external(zero, zero, now);
    assembler.set_time_ahead(0.0, t + cycle);
    assembler.external(zero, zero, later);
    largest = std::max(largest, now.cwiseAbs().maxCoeff());
    change = std::max(change, (later - now).cwiseAbs().maxCoeff());
  }
  return change <= kSameLoad * largest;
}

double speed_at_start(const System& system) {
  const auto& reference = system.reference();
  return reference && reference->at ? std::abs(reference->at(0.0).rate) : 0.0;
}

std::vector<double> few_cycles_of(const System& system) {
  return cycles_of(system, speed_at_start(system), {1.0, 2.0, 4.0});
}

/// Over which loads have their mean [s]: the cycle in which all that acts repeats; where none is known, one turn of the reference
/// shaft, or what the loads and given motions share; 0: there is none.
double mean_cycle_of(const System& system) {
  if (const double cycle = load_cycle(system); cycle > 0.0) return cycle;
  const std::vector<double> few = few_cycles_of(system);
  return few.empty() ? 0.0 : few.front();
}

FoundStart start_static(const System& system, const StartOptions& options) {
  const double cycle = options.cycle > 0.0 ? options.cycle : mean_cycle_of(system);
  const auto& reference = system.reference();
  const bool leaves_rest =
      cycle == 0.0 && reference && reference->at && reference->at(0.0).acceleration != 0.0;
  const StaticResult found = solve_static(system, {.mean_over = leaves_rest ? kInstant : cycle});
  return {system.with_initial(found.state.z, found.state.v),
          "in static equilibrium under " +
              (cycle > 0.0 ? "the mean of the loads over " + rounded_text(cycle, 6) + " s"
                           : "the loads at t = 0"),
          cycle};
}

double change_of(const Vector& before, const Vector& after) {
  const double largest = std::max(before.cwiseAbs().maxCoeff(), after.cwiseAbs().maxCoeff());
  return largest > 0.0 ? (after - before).cwiseAbs().maxCoeff() / largest : 0.0;
}

/// The state after whole cycles of a run that lasts as long as the model takes to settle.
FoundStart settle(const System& system, double cycle, const std::string& why, const StartOptions& options) {
  const std::string none = system.name() + ": no periodic steady state to start from: " + why;
  const Settling settling = settling_time(system);
  const double cycles = std::ceil(settling.time / cycle) + 1.0;
  if (!(cycles <= kMostCycles))
    throw SolverError(none + "; nor does a run settle on one: " + settling.reason);
  StartOptions first = options;
  first.cycle = cycle;
  const FoundStart begin = start_static(system, first);
  State before = State::initial(begin.system), after = before;
  double made = 0.0, error = 0.0;
  const auto run_to = [&](double cycle_number, State& state) {
    const RunSummary run = run_method(
        system, options.method,
        {.t_start = made * cycle, .t_end = cycle_number * cycle, .progress = options.progress}, state);
    made = cycle_number;
    if (!run.ok()) throw SolverError(none + "; nor does a run settle on one: " + run.reason);
  };
  for (int i = 0; i < kMostRuns && (i == 0 || error > kSettledPart); ++i) {
    before = after;
    run_to(made + cycles - 1.0, before);
    after = before;
    run_to(made + 1.0, after);
    error = std::max(change_of(before.z, after.z), change_of(before.v, after.v));
  }
  std::ostringstream how;
  how.precision(6);
  if (error <= kSettledPart)
    how << "in the motion on which a run of " << made << " cycles of " << cycle
        << " s settled (it changes by ";
  else
    how << "at the end of a run of " << made << " cycles of " << cycle
        << " s, which did not settle on a periodic motion (it changes by ";
  how.precision(2);
  how << 100.0 * error << " % from cycle to cycle; " << why << ")";
  return {system.with_initial(after.z, after.v), how.str(), cycle, error, true};
}

/// The mode that grows beside a periodic motion of the system at this speed of the reference shaft (0: none turns). None where laws
/// are nonlinear, or it is not known.
Growth growth_beside(const System& system, double speed) {
  if (!system.scalars().empty() || !system.generals().empty()) return {};
  try {
    const bool follows = std::any_of(system.loads().begin(), system.loads().end(),
                                     [](const LoadTerm& term) { return term.load->depends_on_motion(); });
    if (follows && !(speed > 0.0)) return {};
    return find_growth(system, follows ? load_damping(system, speed) : Vector());
  } catch (const ModelError&) {  // a load that has no orders
  } catch (const SolverError&) {
  }
  return {};
}

FoundStart start_periodic(const System& system, const StartOptions& options) {
  std::vector<double> cycles =
      cycles_of(system, constant_speed_of(system, options.duration), {1.0, 2.0, 4.0, cycle_turns(system)});
  if (options.cycle > 0.0) cycles.insert(cycles.begin(), options.cycle);
  std::string reason =
      cycles.empty()
          ? "no reference shaft turns, and no frequencies of loads and given motions share a period"
          : "what acts on the model repeats neither after the cycle of the model nor after up to 20 "
            "turns of the reference shaft, or of a shaft on which something acts";
  std::erase_if(cycles, [&](double cycle) { return !repeats(system, cycle); });
  for (const double cycle : cycles) {
    const PeriodicResponse found = solve_periodic(system, {.period = cycle, .tolerance = options.tolerance});
    if (found.found) {
      std::ostringstream how;
      how.precision(6);
      how << "in the periodic motion of " << cycle << " s (harmonic balance with " << found.harmonics
          << " harmonics";
      how.precision(2);
      how << ", error " << found.error << " of the motion)";
      FoundStart start{system.with_initial(found.z, found.v), how.str(), cycle, found.error};
      if (const Growth growth = growth_beside(system, constant_speed_of(system, options.duration));
          growth.rate > 0.0)
        start.growing = growth.text();
      return start;
    }
    reason = found.reason;
  }
  // A history is no part of the initial conditions.
  if (cycles.empty() || !system.floating_parts(Contact::closed).empty() || system.history_size() > 0)
    throw SolverError(system.name() + ": no periodic steady state to start from: " + reason);
  return settle(system, cycles.front(), reason, options);
}

}  // namespace

double load_cycle(const System& system) {
  const auto first_of = [&](const std::vector<double>& cycles) {
    const auto found =
        std::find_if(cycles.begin(), cycles.end(), [&](double cycle) { return repeats(system, cycle); });
    return found == cycles.end() ? 0.0 : *found;
  };
  const double cycle = first_of(few_cycles_of(system)), speed = speed_at_start(system);
  // The search for the turns of all shafts calls every load thousands of times.
  return cycle == 0.0 && speed > 0.0 ? first_of(cycles_of(system, speed, {cycle_turns(system)})) : cycle;
}

const char* to_text(Start start) {
  return start == Start::periodic ? "periodic" : start == Start::static_equilibrium ? "static" : "rest";
}

namespace {
constexpr Start kStarts[] = {Start::rest, Start::static_equilibrium, Start::periodic};
}

std::optional<Start> start_of(const std::string& name) {
  for (const Start start : kStarts)
    if (name == to_text(start)) return start;
  return std::nullopt;
}

std::string FoundStart::unsettled() const {
  if (!growing.empty()) return "the run starts in a periodic motion that it leaves: " + growing;
  if (!by_run || error <= kSettledPart) return {};
  std::ostringstream text;
  text.precision(2);
  text << "the run does not start in a periodic steady state: none was found, and the run that looks for one "
          "changes by "
       << 100.0 * error << " % from cycle to cycle at its end, where " << 100.0 * kSettledPart
       << " % count as settled";
  return text.str();
}

std::vector<std::string> start_names() {
  std::vector<std::string> names;
  for (const Start start : kStarts) names.emplace_back(to_text(start));
  return names;
}

FoundStart find_start(const System& system, Start start, const StartOptions& options) {
  if (start == Start::periodic) return start_periodic(system, options);
  if (start == Start::static_equilibrium) return start_static(system, options);
  return {system, "from the model's initial conditions"};
}

}  // namespace drev
