#pragma once
/// Shared by the tests of dry friction and lossy gears under exact propagation.
#include <drev/core/assembler.hpp>
#include <drev/core/channel.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>

#include <string>

#include "tests/catch.hpp"

namespace drev::test {

inline double channel_at(const System& system, const State& state, const std::string& name) {
  Assembler assembler(system);
  assembler.set_time(state.t);
  return find_channel(system, name).evaluate(assembler, state);
}

struct FrictionRun {
  RunSummary summary;
  State state;
};

/// From the start to t_end at a tolerance of 1e-14; its balance must close.
inline FrictionRun ran_to(const System& system, double t_end, double energy_tolerance = 1e-11) {
  FrictionRun r{.summary = {}, .state = State::initial(system)};
  r.summary =
      propagate(system, {.tolerance = 1e-14, .t_end = t_end, .energy_tolerance = energy_tolerance}, r.state);
  INFO(r.summary.brief_report());
  CHECK(r.summary.ok());
  return r;
}

}  // namespace drev::test
