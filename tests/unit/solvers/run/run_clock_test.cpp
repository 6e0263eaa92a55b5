// Where the time of a run goes: the sections are there if asked for, and only then.
#include "solvers/run/run_clock.hpp"

#include <drev/elements/catalogue.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include "tests/catch.hpp"

using namespace drev;

TEST_CASE("The time of a run is given by section where it was asked for") {
  Model model("one inertia");
  model.add_node("n");
  model.add<Inertia>("J", {"n"}, {.inertia = 1.0});
  model.add<GroundSpring>("k", {"n"}, {.stiffness = 1.0});
  model.set_initial("n", 0.1, 0.0);
  const System system = model.build();
  TransientOptions options{.step = 1e-2, .t_end = 1.0};
  CHECK(simulate(system, options).phases.empty());
  options.newton.time_phases = true;
  const RunSummary timed = simulate(system, options);
  REQUIRE(timed.phases.size() == static_cast<std::size_t>(RunSection::count));
  double seconds = 0.0;
  for (const auto& [name, share] : timed.phases) seconds += share;
  CHECK(seconds > 0.0);

  RunClock off;
  off.enter(RunSection::loads);
  off.enter(RunSection::linear);
  CHECK(off.seconds(RunSection::loads) == 0.0);
}
