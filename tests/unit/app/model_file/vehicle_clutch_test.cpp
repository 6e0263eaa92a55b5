// models/vehicle_clutch: what its page says, beside the closed form of two rigid bodies and printed answers of textbooks.
#include <drev/app/model_file/model_file.hpp>
#include <drev/core/assembler.hpp>
#include <drev/core/channel.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>

#include <cmath>

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

TEST_CASE("Two bodies on a plate clutch: time, heat and speed as textbooks print them") {
  using Set = std::vector<std::pair<std::string, std::string>>;
  // `digit`: the last one printed; what is printed is rounded or cut.
  struct Printed {
    double value, digit;
  };
  const auto agrees = [](double computed, const Printed& printed) {
    INFO(computed << " beside " << printed.value);
    CHECK(std::abs(computed - printed.value) < printed.digit);
  };
  const auto run = [&](const Set& set, double duration, const Printed& time, const Printed& heat,
                       const Printed& speed) {
    const app::ModelFile file(DREV_SOURCE_DIR "/models/vehicle_clutch/engagement.toml", "");
    Parameters parameters(file.entry().name, file.entry().parameters);
    for (const auto& [key, value] : set) parameters.set(key, value);
    const System system = file.entry().build(parameters).model.build();
    State state = State::initial(system);
    const RunSummary summary = propagate(system, {.t_end = duration}, state);
    INFO(summary.brief_report());
    CHECK(summary.ok());
    REQUIRE(summary.friction_events.size() == 1);
    CHECK(summary.friction_events[0].becomes == "stuck");
    agrees(summary.friction_events[0].t, time);
    const Assembler assembler(system);
    if (heat.value > 0.0) agrees(find_channel(system, "clutch.heat_J").evaluate(assembler, state), heat);
    if (speed.value > 0.0)
      for (const char* channel : {"driving.speed_rad_per_s", "driven.speed_rad_per_s"})
        agrees(find_channel(system, channel).evaluate(assembler, state), speed);
  };
  // V. B. Bhandari, Design of Machine Elements, Example 11.14; R. S. Khurmi, J. K. Gupta, Theory of Machines, pages 47 and
  // 306 (models/vehicle_clutch/README.md).
  run({}, 1.0, {0.409285, 1e-6}, {2046.422713, 1e-6}, {});
  run({{"driving_mass_kg", "60"},
       {"driving_radius_mm", "140"},
       {"driven_mass_kg", "20"},
       {"driven_radius_mm", "80"},
       {"speed_rpm", "750"},
       {"capacity_Nm", "150"}},
      0.1, {0.06, 0.01}, {356.0, 1.0}, {70.8, 0.1});
  Set rotor{{"driving_mass_kg", "800"},  {"driving_radius_mm", "200"}, {"driven_mass_kg", "1300"},
            {"driven_radius_mm", "180"}, {"speed_rpm", "1250"},        {"capacity_Nm", "37.905"}};
  run(rotor, 100.0, {62.8, 0.1}, {156e3, 1e3}, {56.51, 0.01});
  rotor.push_back({"motor_Nm", "-60"});
  run(rotor, 34.0, {33.1, 0.1}, {}, {});
  rotor.back().second = "60";
  run(rotor, 700.0, {624.0, 1.0}, {}, {});
}
