#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/run/observer.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <sstream>

#include "solvers/run/stiff_twists.hpp"

namespace drev {

const std::vector<MethodRow>& methods() {
  static const std::vector<MethodRow> rows = [] {
    std::vector<MethodRow> all{
        {.name = kExact,
         .help =
             "Taylor series between located contact changes, to a tolerance; says what of a model keeps it "
             "from that"}};
    all.insert(all.end(), step_schemes().begin(), step_schemes().end());
    return all;
  }();
  return rows;
}

std::string to_text(const Method& method) {
  std::ostringstream text;
  text << method.name;
  if (method.tolerance > 0.0) text << ", tolerance " << method.tolerance;
  if (method.step > 0.0) text << ", step " << method.step << " s";
  return text.str();
}

namespace {

RunSummary run_watched(const System& system, const Method& method, const MethodRunOptions& o, State& state,
                       const std::vector<Observer*>& observers) {
  if (method.exact()) {
    ExactOptions options{
        .tolerance = method.tolerance, .t_start = o.t_start, .t_end = o.t_end, .progress = o.progress};
    if (o.energy_tolerance > 0.0) options.energy_tolerance = o.energy_tolerance;
    return propagate(system, options, state, observers);
  }
  TransientOptions options{.scheme = step_scheme(method.name),
                           .step = method.step,
                           .tolerance = method.tolerance,
                           .t_start = o.t_start,
                           .t_end = o.t_end,
                           .progress = o.progress};
  if (o.energy_tolerance > 0.0) options.energy_tolerance = o.energy_tolerance;
  return simulate(system, options, state, observers);
}

}  // namespace

RunSummary run_method(const System& system, const Method& method, const MethodRunOptions& options,
                      State& state, const std::vector<Observer*>& observers) {
  StiffTwists stiff(system);
  if (!stiff.any()) return run_watched(system, method, options, state, observers);
  std::vector<Observer*> all = observers;
  all.push_back(&stiff);
  RunSummary summary = run_watched(system, method, options, state, all);
  stiff.warn(summary);
  return summary;
}

RunSummary run_method(const System& system, const Method& method, const MethodRunOptions& options,
                      const std::vector<Observer*>& observers) {
  State state = State::initial(system, options.t_start);
  return run_method(system, method, options, state, observers);
}

}  // namespace drev
