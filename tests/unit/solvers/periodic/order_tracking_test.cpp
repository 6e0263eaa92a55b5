// Orders over a run-up, against closed forms.
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/periodic/order_tracking.hpp>

#include <algorithm>
#include <cmath>

#include "tests/catch.hpp"

using namespace drev;

namespace {

/// A disc on a shaft from a held node that runs up; orders 2 and 3.5 act on the disc.
System run_up_system(double stiffness, double damping) {
  Model m("up");
  const NodeId end = m.add_node("end"), disc = m.add_node("disc");
  m.set_reference(end, run_up(20.0, 80.0, 0.0, 60.0));
  m.hold(end);
  m.add<Inertia>("J", {disc}, {.inertia = 1.0});
  m.add<ShaftSpring>("shaft", {end, disc}, {.stiffness = stiffness, .damping = damping});
  m.add<EngineOrderTorque>("load", {disc},
                           {.harmonics = {{.order = 2.0, .amplitude = 3.0}, {.order = 3.5, .amplitude = 1.0}},
                            .twist_feedback = false});
  return m.build();
}

}  // namespace

TEST_CASE("Tracked orders of a slow run-up follow the frequency response over the speed") {
  const double stiffness = 10000.0, damping = 10.0;  // 100 rad/s: order 2 resonates at 50 rad/s
  const System system = run_up_system(stiffness, damping);
  for (const bool own_times : {true, false}) {
    OrderTracking tracking(system, {"disc.angle_rad"}, {2.0, 3.5}, 4.0, own_times);
    const Method method = own_times ? Method{.name = kExact, .tolerance = 1e-9} : Method{.step = 2e-4};
    REQUIRE(run_method(system, method, {.t_end = 60.0}, {&tracking}).ok());
    const OrderTracks& tracks = tracking.tracks();
    REQUIRE(tracks.speed.size() > 200);
    CHECK(std::is_sorted(tracks.speed.begin(), tracks.speed.end()));
    const auto check = [&](std::size_t k, double order, double load, double within) {
      for (std::size_t i = 0; i < tracks.speed.size(); ++i) {
        if (tracks.time[i] < 2.0) continue;  // the start from rest
        const double w = order * tracks.speed[i];
        const double steady = load / std::hypot(stiffness - w * w, damping * w);
        const double peak = load / (damping * 100.0);
        CHECK(std::abs(tracks.amplitude[0][k][i] - steady) < within * peak);
      }
    };
    check(0, 2.0, 3.0, 0.08);  // passing at 1 rad/s^2 lags and lowers the resonance a little
    check(1, 3.5, 1.0, 0.12);
    const auto top = std::max_element(tracks.amplitude[0][0].begin(), tracks.amplitude[0][0].end());
    const double at = tracks.speed[static_cast<std::size_t>(top - tracks.amplitude[0][0].begin())];
    CHECK(std::abs(at - 50.0) < 1.5);
  }
}

TEST_CASE("Windows are whole turns: a load that is its own order comes out exactly at any speed") {
  const System system = run_up_system(1e4, 10.0);
  OrderTracking tracking(system, {"load.torque_Nm"}, {1.0, 2.0, 3.5}, 4.0, true);
  REQUIRE(run_method(system, {.name = kExact, .tolerance = 1e-9}, {.t_end = 20.0}, {&tracking}).ok());
  const OrderTracks& tracks = tracking.tracks();
  REQUIRE(!tracks.speed.empty());
  for (std::size_t i = 0; i < tracks.speed.size(); ++i) {
    CHECK(std::abs(tracks.amplitude[0][0][i]) < 1e-3);
    CHECK(std::abs(tracks.amplitude[0][1][i] - 3.0) < 1e-3);
    CHECK(std::abs(tracks.amplitude[0][2][i] - 1.0) < 1e-3);
    CHECK(std::abs(tracks.speed[i] - (20.0 + tracks.time[i])) < 1e-2);
  }
}
