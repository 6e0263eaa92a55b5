// An observer of one's own (solvers/run/own_observer.hpp), as that header shows it.
#include <drev/core/error.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/run/after_time.hpp>
#include <drev/solvers/run/own_observer.hpp>

#include <algorithm>

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
