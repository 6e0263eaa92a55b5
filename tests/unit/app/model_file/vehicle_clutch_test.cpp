// models/vehicle_clutch: docs/friction.md says what it gives; with stiff half shafts, the closed form of two rigid bodies.
#include <drev/app/model_file/model_file.hpp>
#include <drev/core/assembler.hpp>
#include <drev/core/channel.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>

#include "tests/catch.hpp"

using namespace drev;

TEST_CASE("The car's clutch engages when two rigid bodies do, and turns into heat what they do") {
  const auto run = [](const std::vector<std::pair<std::string, std::string>>& set, double time, double heat,
                      double within) {
    const app::ModelFile file(DREV_SOURCE_DIR "/models/vehicle_clutch/vehicle_clutch.toml", "");
    Parameters parameters(file.entry().name, file.entry().parameters);
    for (const auto& [key, value] : set) parameters.set(key, value);
    const System system = file.entry().build(parameters).model.build();
    State state = State::initial(system);
    const RunSummary summary = propagate(system, {.t_end = 1.0}, state);
    INFO(summary.brief_report());
    CHECK(summary.ok());
    REQUIRE(summary.friction_events.size() == 4);
    CHECK(summary.friction_events.back().becomes == "stuck");
    CHECK(summary.friction_events.back().t == Approx(time).epsilon(within));
    CHECK(find_channel(system, "clutch.heat_J").evaluate(Assembler(system), state) ==
          Approx(heat).epsilon(within));
  };
  // J_e w_e' = T - M, J_v w_v' = M - R with M = 250 (t - 0.1)/0.8, by hand: 0.8358006641 s, 14751.8766 J.
  run({{"half_shafts_Nm_per_rad", "1e6"}, {"half_shaft_damping_Nms_per_rad", "5000"}}, 0.8358006641,
      14751.8766, 5e-4);
  run({}, 0.8301049465, 14751.8766, 5e-2);  // elastic half shafts: 6 ms earlier
}
