// Figures from a time on, and the speed at which a part really turns.
#include <drev/core/assembler.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/run/after_time.hpp>
#include <drev/solvers/run/peaks.hpp>
#include <drev/solvers/run/recorder.hpp>

#include <cmath>

#include "solvers/run/mean_speed.hpp"
#include "tests/catch.hpp"

using namespace drev;

namespace {

/// Let go at 1 rad: q = exp(-t) (cos(w t) + sin(w t) / w), w^2 = 100 - 1.
System let_go_disc() {
  Model model("decaying");
  const NodeId disc = model.add_node("disc");
  model.add<Inertia>("J", {disc}, {.inertia = 1.0});
  model.add<GroundSpring>("spring", {disc}, {.stiffness = 100.0, .damping = 2.0});
  model.set_initial(disc, 1.0, 0.0);
  return model.build();
}

double largest_after(const System& system, const Method& method, double begin) {
  Peaks peaks(find_channels(system, {"disc.angle_rad"}), method.tolerance > 0.0);
  AfterTime after(begin, {&peaks});
  REQUIRE(run_method(system, method, {.t_end = 5.0}, {&after}).ok());
  CHECK(after.started());
  CHECK(peaks.peaks()[0].time() >= begin * (1.0 - 1e-12));
  return peaks.peaks()[0].amplitude();
}

}  // namespace

TEST_CASE("Figures from a time on are those of the motion there, by every kind of method") {
  const System system = let_go_disc();
  const double w = std::sqrt(99.0), begin = 1.2345;
  const auto q = [&](double t) { return std::exp(-t) * (std::cos(w * t) + std::sin(w * t) / w); };
  double expected = 0.0;  // extremes of q lie at whole half periods
  for (double t = begin; t < 5.0; t += 1e-5) expected = std::max(expected, std::abs(q(t)));
  CHECK(std::abs(largest_after(system, {.name = kExact, .tolerance = 1e-12}, begin) - expected) < 1e-6);
  CHECK(std::abs(largest_after(system, {.name = "dormand_prince", .tolerance = 1e-9}, begin) - expected) <
        1e-6);
  CHECK(std::abs(largest_after(system, {.step = 1e-4}, begin) - expected) < 1e-4);
  CHECK(largest_after(system, {.name = kExact, .tolerance = 1e-12}, 0.0) == 1.0);
}

TEST_CASE("Observers that start later see that time exactly, and ask for their times from there") {
  const System system = let_go_disc();
  for (const Method& method : {Method{.name = kExact, .tolerance = 1e-10}, Method{.step = 1e-3}}) {
    Recorder recorder(system, {"disc.angle_rad"}, 0.1);
    AfterTime after(0.77, {&recorder});
    REQUIRE(run_method(system, method, {.t_end = 1.0}, {&after}).ok());
    REQUIRE(recorder.times().size() == 3);
    for (int i = 0; i < 3; ++i)
      CHECK(std::abs(recorder.times()[static_cast<std::size_t>(i)] - (0.77 + 0.1 * i)) < 1e-9);
  }
  Recorder never(system, {"disc.angle_rad"}, 0.1);
  AfterTime later(2.0, {&never});
  REQUIRE(run_method(system, {.step = 1e-3}, {.t_end = 1.0}, {&later}).ok());
  CHECK(!later.started());
  CHECK(never.times().empty());
}

TEST_CASE("A part that only torques balance turns at the speed at which they do") {
  // 10 N m drive the shaft against 0.1 N m s/rad: 100 rad/s, whatever speed is nominal.
  const double inertia = 0.05;
  Model model("balance");
  const NodeId shaft = model.add_node("shaft");
  model.add<Inertia>("J", {shaft}, {.inertia = inertia});
  model.add<Dashpot>("drag", {shaft}, {.damping = 0.1});
  model.add<EngineOrderTorque>("drive", {shaft},
                               {.harmonics = {{.order = 2.0, .amplitude = 3.0}}, .mean = 10.0});
  model.set_reference(shaft, constant_speed(120.0));
  const System system = model.build();
  MeanSpeed speed(system, 10.0, 20.0);
  AfterTime settled(10.0, {&speed});
  REQUIRE(run_method(system, {.name = kExact, .tolerance = 1e-9}, {.t_end = 20.0}, {&settled}).ok());
  REQUIRE(speed.parts().size() == 1);
  const PartSpeed part = speed.parts().front();
  CHECK(part.node == "shaft");
  CHECK(std::abs(part.nominal - 120.0) < 1e-9);
  CHECK(std::abs(part.actual - 100.0) < 1e-3);
  CHECK(std::abs(part.deviation() + 1.0 / 6.0) < 1e-4);

  Model held("held");
  const NodeId disc = held.add_node("disc"), grid = held.add_node("grid");
  held.add<Inertia>("J", {disc}, {.inertia = 1.0});
  held.add<ShaftSpring>("shaft", {disc, grid}, {.stiffness = 10.0});
  held.constant_speed(grid, 100.0);
  const System tied = held.build();
  MeanSpeed none(tied, 0.0, 1.0);
  REQUIRE(run_method(tied, {.name = kExact, .tolerance = 1e-9}, {.t_end = 1.0}, {&none}).ok());
  CHECK(none.parts().empty());
}
