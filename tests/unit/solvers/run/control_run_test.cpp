// Covers: control_run.hpp, core/control/sampled_controller.hpp, core/control/signal.hpp
// Sampled controllers against the recurrences that a train of one inertia obeys between communication points.
#include <drev/core/control/sampled_controller.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/modes/damped_modes.hpp>
#include <drev/solvers/modes/modes.hpp>
#include <drev/solvers/nonlinear_sweep.hpp>
#include <drev/solvers/periodic/linear_sweep.hpp>
#include <drev/solvers/periodic/periodic_response.hpp>
#include <drev/solvers/run/recorder.hpp>
#include <drev/solvers/statics.hpp>

#include <cmath>
#include <functional>

#include "tests/catch.hpp"

using namespace drev;

namespace {

/// outputs[0] = law(t, inputs), at the start and at every communication point.
using Sampled = std::function<double(double t, std::span<const double> inputs)>;

class TestController final : public SampledController {
 public:
  TestController(double step, Hold hold, std::vector<std::string> inputs, std::function<Sampled()> begin)
      : SampledController(step, hold, 1), inputs_(std::move(inputs)), begin_(std::move(begin)) {}
  std::string_view type() const override { return "controller of the test"; }
  std::vector<std::string> inputs() const override { return inputs_; }
  std::unique_ptr<ControlSession> open(double t_start, double /*t_end*/) const override {
    class Session final : public ControlSession {
     public:
      Session(Sampled law, double t) : law_(std::move(law)), t_(t) {}
      void start(std::span<const double> inputs, std::span<double> outputs) override {
        outputs[0] = law_(t_, inputs);
      }
      void step(double t, double h, std::span<const double> /*before*/, std::span<const double> inputs,
                std::span<double> outputs) override {
        outputs[0] = law_(t + h, inputs);
      }

     private:
      Sampled law_;
      double t_;
    };
    return std::make_unique<Session>(begin_(), t_start);
  }

 private:
  std::vector<std::string> inputs_;
  std::function<Sampled()> begin_;
};

constexpr double kDiscInertia = 2.0, kGain = 30.0, kIntegral = 400.0, kLoad = 5.0, kStep = 0.01;
constexpr double kNominal = 100.0;  // rad/s

/// y_k = K_p e_k + K_i I_k, I_k = I_{k-1} + h e_k, e = w_n - w.
Sampled pi_governor() {
  return [integral = 0.0](double /*t*/, std::span<const double> w) mutable {
    const double e = kNominal - w[0];
    integral += kStep * e;
    return kGain * e + kIntegral * integral;
  };
}

/// An inertia at its nominal speed, from which a load of -kLoad is taken at t = 0, and a governor.
System governed(Hold hold = Hold::zero_order) {
  Model model("governed");
  const NodeId engine = model.add_node("engine");
  model.set_reference(engine, constant_speed(kNominal));
  model.add<Inertia>("J", {engine}, {.inertia = kDiscInertia});
  model.add<AppliedTorque>("load", {engine}, {.table = TimeTable({0.0}, {-kLoad})});
  model.add("governor", {engine},
            std::make_shared<TestController>(
                kStep, hold, std::vector<std::string>{"engine.actual_speed_rad_per_s"}, pi_governor));
  return model.build();
}

/// The deviation of the speed at t_k, by the z-transform of the loop: w_{k+1} = (2 - a - b) w_k - (1 - a) w_{k-1} with
/// a = K_p h/J, b = K_i h^2/J, w_0 = 0, w_1 = -h L/J; its roots are r exp(+-i phi).
double speed_at(int k) {
  const double a = kGain * kStep / kDiscInertia, b = kIntegral * kStep * kStep / kDiscInertia;
  const double r = std::sqrt(1.0 - a), phi = std::acos((2.0 - a - b) / (2.0 * r));
  return -kStep * kLoad / kDiscInertia * std::pow(r, k - 1) * std::sin(k * phi) / std::sin(phi);
}

std::vector<double> speeds_of(const System& system, const Method& method, double t_end) {
  Recorder recorder(system, {"engine.speed_rad_per_s"}, kStep);
  const RunSummary summary = run_method(system, method, {.t_end = t_end}, {&recorder});
  INFO(summary.reason);
  CHECK(summary.ok());
  return recorder.samples(0);
}

}  // namespace

TEST_CASE("A sampled PI governor gives the motion of its z-transform, by every kind of method") {
  const System system = governed();
  const double largest = kStep * kLoad / kDiscInertia;
  for (const auto& [method, tolerance] : std::vector<std::pair<Method, double>>{
           {{.name = kExact, .tolerance = 1e-12}, 1e-13},
           {{.step = kStep / 3.0}, 1e-12},  // average acceleration is exact where the torque is constant
           {{.name = "dormand_prince", .tolerance = 1e-9}, 1e-9},
           {{.name = "sdirk4", .tolerance = 1e-9}, 1e-9}}) {
    INFO(to_text(method));
    const std::vector<double> speeds = speeds_of(system, method, 1.0);
    REQUIRE(speeds.size() == 101);
    for (int k = 0; k <= 100; ++k)
      CHECK(std::abs(speeds[static_cast<std::size_t>(k)] - speed_at(k)) < tolerance * 10.0 * largest);
  }
}

TEST_CASE("A run that ends between communication points has a short last step") {
  const std::vector<double> speeds =
      speeds_of(governed(), {.name = kExact, .tolerance = 1e-12}, 0.1 + 0.3 * kStep);
  // Over the last, short step the torque is that of t_10.
  CHECK(speeds.size() >= 11);
  CHECK(std::abs(speeds[10] - speed_at(10)) < 1e-13);
}

TEST_CASE("A first-order hold follows a ramp from its second communication point on") {
  constexpr double kRate = 7.0;
  Model model("ramp");
  const NodeId disc = model.add_node("engine");
  model.add<Inertia>("J", {disc}, {.inertia = kDiscInertia});
  model.add(
      "ramp", {disc},
      std::make_shared<TestController>(kStep, Hold::first_order, std::vector<std::string>{"time_s"}, [] {
        return Sampled([](double /*t*/, std::span<const double> time) { return kRate * time[0]; });
      }));
  const std::vector<double> speeds = speeds_of(model.build(), {.name = kExact, .tolerance = 1e-12}, 0.5);
  // Zero over the first step, then the ramp itself: J w = rate (t^2 - h^2)/2.
  const double expected = kRate * (0.25 - kStep * kStep) / (2.0 * kDiscInertia);
  CHECK(std::abs(speeds[50] - expected) < 1e-13);
}

TEST_CASE("What knows no run refuses a sampled controller with the reason") {
  const System system = governed();
  const auto refuses = [](const std::function<void()>& solve) {
    CHECK_THROWS_WITH(solve(), Catch::Contains("governor is a controller that is sampled every 0.01 s") &&
                                   Catch::Contains("run the model in time"));
  };
  refuses([&] { solve_modes(system, {}); });
  refuses([&] { solve_damped_modes(system, {}); });
  refuses([&] { sweep_linear(system, {.speeds = {kNominal}}); });
  refuses([&] { sweep_nonlinear(system, {}); });
  refuses([&] { StaticSolver solver(system); });
  CHECK(why_not_controllers(system, "lockstep"));
  Model empty("empty");
  empty.add<Inertia>("J", {empty.add_node("a")}, {.inertia = 1.0});
  CHECK(!why_not_controllers(empty.build(), "lockstep"));
}

TEST_CASE("A controller takes part in one run at a time, and is free behind it") {
  const System system = governed();
  const auto* governor = sampled_controllers(system).front().controller;
  REQUIRE(governor->acquire());
  CHECK_THROWS_WITH(speeds_of(system, {.name = kExact, .tolerance = 1e-12}, 0.1),
                    Catch::Contains("governor is in use by another run"));
  governor->release();
  const std::vector<double> first = speeds_of(system, {.name = kExact, .tolerance = 1e-12}, 0.1);
  CHECK(first == speeds_of(system, {.name = kExact, .tolerance = 1e-12}, 0.1));
}

TEST_CASE("What a controller throws, reads in vain or leaves not finite ends the run with time and name") {
  const auto run = [](const std::vector<std::string>& inputs, const Sampled& law) {
    Model model("train");
    const NodeId disc = model.add_node("disc");
    model.add<Inertia>("J", {disc}, {.inertia = 1.0});
    model.add("controller", {disc},
              std::make_shared<TestController>(0.1, Hold::zero_order, inputs, [law] { return law; }));
    const System system = model.build();
    run_method(system, {.name = kExact, .tolerance = 1e-10}, {.t_end = 1.0});
  };
  CHECK_THROWS_WITH(
      run({}, [](double t, auto) { return t > 0.25 ? throw std::runtime_error("no fuel") : 0.0; }),
      Catch::Contains("0.3") && Catch::Contains("controller: no fuel"));
  CHECK_THROWS_WITH(run({}, [](double t, auto) { return t > 0.25 ? NAN : 0.0; }),
                    Catch::Contains("not finite"));
  CHECK_THROWS_WITH(run({"disc.actual_sped_rad_per_s"}, [](double, auto) { return 0.0; }),
                    Catch::Contains("is no channel of this model"));
}
