// An observer of one's own (solvers/run/own_observer.hpp), as that header shows it.
#include <drev/core/error.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/periodic/order_tracking.hpp>
#include <drev/solvers/run/after_time.hpp>
#include <drev/solvers/run/contact_statistics.hpp>
#include <drev/solvers/run/element_totals.hpp>
#include <drev/solvers/run/own_observer.hpp>
#include <drev/solvers/run/peaks.hpp>
#include <drev/solvers/run/recorder.hpp>
#include <drev/solvers/strength/rainflow.hpp>

#include <algorithm>

#include "solvers/run/mean_speed.hpp"
#include "tests/catch.hpp"

using namespace drev;

namespace {

class LargestSpeed final : public Observer {
 public:
  void start(const Assembler&, const EvaluatedState& point) override { take(point); }
  void step(const Assembler&, const EvaluatedState&, const EvaluatedState& to) override { take(to); }
  double value = 0.0;

 private:
  void take(const EvaluatedState& point) { value = std::max(value, point.state.v.cwiseAbs().maxCoeff()); }
};

}  // namespace

TEST_CASE("An observer of one's own sees every step, by every kind of method") {
  Model model("disc on a spring");
  model.add_node("disc");
  model.add<Inertia>("J", {"disc"}, {.inertia = 2.0});
  model.add<GroundSpring>("spring", {"disc"}, {.stiffness = 200.0});
  model.set_initial("disc", 0.1, 0.0);
  const System system = model.build();
  // q = 0.1 cos(10 t): the largest speed is 0.1 rad * 10 rad/s.
  for (const Method& method : {Method{.name = kExact, .tolerance = 1e-10}, Method{.step = 1e-4}}) {
    LargestSpeed speed;
    REQUIRE(run_method(system, method, {.t_end = 1.0}, {&speed}).ok());
    CHECK(speed.value == Approx(1.0).epsilon(1e-3));
    CHECK(speed.value <= 1.0 + 1e-9);
  }
}

TEST_CASE("An observer that is null is refused with its place in the list") {
  Model model("disc");
  model.add_node("disc");
  model.add<Inertia>("J", {"disc"}, {.inertia = 2.0});
  const System system = model.build();
  LargestSpeed speed;
  for (const Method& method : {Method{.name = kExact, .tolerance = 1e-10}, Method{.step = 1e-2}})
    CHECK_THROWS_WITH(run_method(system, method, {.t_end = 1.0}, {&speed, nullptr}),
                      Catch::Contains("observers[1] = null, must point to an observer"));
  CHECK_THROWS_AS(AfterTime(0.5, {nullptr}), ModelError);
}

TEST_CASE(
    "An observer made for another system is refused with its place in the list, one of a copy is taken") {
  const auto chain = [](int discs) {
    Model model("chain");
    for (int i = 0; i < discs; ++i) {
      const std::string number = std::to_string(i);
      model.add_node("n" + number);
      model.add<Inertia>("J" + number, {"n" + number}, {.inertia = 2.0});
    }
    model.add<GearMesh>(
        "mesh", {"n0", "n1"},
        {.base_radius_1 = 0.1, .base_radius_2 = 0.1, .stiffness = 1e6, .normal_backlash = 1e-4});
    return model.build();
  };
  const System system = chain(2), larger = chain(300), copy = system;
  const std::vector<std::string> names{"n1.angle_rad"};
  const auto all_of = [&](const System& of, const auto& refused) {
    Recorder recorder(of, {"n*.angle_rad"}, 0.1);
    Peaks peaks(find_channels(of, names));
    RainflowWatch rainflow({{.channel = find_channel(of, names[0])}});
    OrderTracking orders(of, names, {1.0}, 1.0, false);
    ContactStatistics contacts(of);
    ContactEvents events(of);
    ElementTotals totals(of);
    MeanSpeed speeds(of, 0.0, 1.0);
    AfterTime later(0.5, {&recorder});
    LargestSpeed own;
    refused({&own, &recorder, &peaks, &rainflow, &orders, &contacts, &events, &totals, &speeds, &later});
  };
  for (const Method& method : {Method{.name = kExact, .tolerance = 1e-10}, Method{.step = 1e-2}}) {
    all_of(larger, [&](const std::vector<Observer*>& observers) {
      try {
        run_method(system, method, {.t_end = 1.0}, observers);
        FAIL("observers of a larger system were taken");
      } catch (const ModelError& error) {
        REQUIRE(error.findings().size() == observers.size() - 1);
        for (std::size_t i = 1; i < observers.size(); ++i)
          CHECK(error.findings()[i - 1].parameter == "observers[" + std::to_string(i) + "]");
      }
    });
    all_of(copy, [&](const std::vector<Observer*>& observers) {
      CHECK(run_method(system, method, {.t_end = 1.0}, observers).ok());
    });
  }
}
