// The same fault has the same message from stepping, lockstep and exact propagation; with it, when the
// caller is asked (solvers/run/progress.hpp) and what is left of a step that fails
// (solvers/stepping/halved_step.hpp).
#include "solvers/run/run_verdict.hpp"

#include <drev/core/law_element.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/batch/simulate_many.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <cctype>
#include <charconv>
#include <functional>

#include "tests/catch.hpp"
#include "tests/problems/unit_oscillator.hpp"
#include "tests/unit/not_finite.hpp"

using namespace drev;

namespace {

struct Ended {
  RunSummary summary;
  State state;
};

struct Paths {
  Ended stepping, lockstep, exact;
};

VariantResult in_lockstep(const System& system, const TransientOptions& options) {
  ManyResult many = simulate_many(1, [&](std::size_t) { return system; }, options, {.threads = 1});
  CHECK(many.variants[0].in_lockstep);
  CHECK(many.variants[0].error == "");
  return std::move(many.variants[0]);
}

Paths run_all(const System& system, const TransientOptions& options) {
  Paths paths;
  State& state = paths.stepping.state = State::initial(system);
  paths.stepping.summary = simulate(system, options, state);
  VariantResult variant = in_lockstep(system, options);
  paths.lockstep = {variant.summary, variant.state};
  paths.exact.state = State::initial(system);
  paths.exact.summary = propagate(
      system,
      {.t_end = options.t_end, .energy_tolerance = options.energy_tolerance, .progress = options.progress},
      paths.exact.state);
  return paths;
}

/// All three end as told.
void check_all(const Paths& paths, RunStatus status, const std::string& reason) {
  for (const Ended* run : {&paths.stepping, &paths.lockstep, &paths.exact}) {
    CHECK(run->summary.status == status);
    CHECK(run->summary.reason == reason);
    CHECK(run->state.t == run->summary.t_end);
  }
}

std::string without_numbers(const std::string& text) {
  std::string left;
  for (const char* at = text.data(); at != text.data() + text.size();) {
    double number = 0.0;
    const auto read = std::from_chars(at, text.data() + text.size(), number);
    const bool is_number =
        read.ec == std::errc() && (*at == '-' || std::isdigit(static_cast<unsigned char>(*at)) != 0);
    left += is_number ? '#' : *at;
    at = is_number ? read.ptr : at + 1;
  }
  return left;
}

/// A spring of 1 N/m whose force is no number from a time on, nor beyond a deflection.
struct Breaking {
  double from = kInfinity;  ///< s
  double to = kInfinity;    ///< m
  ScalarResponse operator()(const ScalarInput& in) const {
    if (in.t >= from || in.x > to) return {.y = kNan, .dy_dx = kNan, .stored_energy = kNan};
    return {.y = in.x, .dy_dx = 1.0, .stored_energy = 0.5 * in.x * in.x};
  }
};

AppliedTorque::Params load(const std::function<double(double)>& of_time) {
  return {.torque = of_time, .breakpoints = {0.5}};
}

}  // namespace

TEST_CASE("Same fault, same message: a load that is not finite at the start") {
  Model m = unit_oscillator();
  m.add<AppliedTorque>("bad", {"m"}, load([](double) { return kNan; }));
  check_all(run_all(m.build(), {.step = 1e-3, .t_end = 1.0}), RunStatus::not_finite,
            "oscillator: at t = 0 s: the load of bad is not finite");
}

TEST_CASE("Same fault, same message: a load that is not finite behind a breakpoint") {
  Model m = unit_oscillator();
  m.add_node("free", NodeKind::translational);
  m.add<Inertia>("first", {"free"}, {.inertia = 1.0});
  m.add<AppliedTorque>("bad", {"m"}, load([](double t) { return t < 0.5 ? 1.0 : kNan; }));
  const System system = m.build();
  check_all(run_all(system, {.step = 1e-3, .t_end = 1.0}), RunStatus::not_finite,
            "oscillator: at t = 0.5 s: the load of bad is not finite");
}

TEST_CASE("Same fault, same message: a law that is not finite behind a breakpoint") {
  Model m = unit_oscillator();
  m.add<LawElement<Breaking>>("rope", {"m"}, {.from = 0.5});
  m.add<AppliedTorque>("push", {"m"}, load([](double) { return 1.0; }));
  check_all(run_all(m.build(), {.step = 1e-3, .t_end = 1.0}), RunStatus::not_finite,
            "oscillator: at t = 0.5 s: the force of rope is not finite");
}

TEST_CASE(
    "A law that is no number beyond a deflection is named by each method, with the time at which it is") {
  Model m = unit_oscillator();
  m.set_initial("m", 0.0, 1.0);
  m.add<LawElement<Breaking>>("rope", {"m"}, {.to = 0.0563});
  const Paths paths = run_all(m.build(), {.step = 1e-3, .t_end = 1.0});
  for (const Ended* run : {&paths.stepping, &paths.lockstep, &paths.exact}) {
    CHECK(run->summary.status == RunStatus::not_finite);
    CHECK(without_numbers(run->summary.reason) == "oscillator: at t = # s: the force of rope is not finite");
  }
  // x = sin(w t)/w with w^2 = 4 pi^2 + 1 is 0.0563 m at 0.0576 s.
  const std::string reason = paths.stepping.summary.reason;
  CHECK(std::stod(reason.substr(reason.find("t = ") + 4)) == Approx(0.0576).epsilon(0.03));
}

TEST_CASE("Same fault, same message: an energy beyond all numbers") {
  Model m = unit_oscillator();
  m.set_initial("m", 1e300, 0.0);
  check_all(run_all(m.build(), {.step = 1e-3, .t_end = 1.0}), RunStatus::not_finite,
            "oscillator: at t = 0 s: the energy is more than a number can hold; check the largest stiffness, "
            "inertia and load");
}

TEST_CASE("Same fault, same message: stopped by the caller after the same number of steps") {
  Model m = unit_oscillator();
  m.set_initial("m", 1.0, 0.0);
  const Paths paths =
      run_all(m.build(), {.step = 1e-3, .t_end = 1e3, .progress = [](double) { return false; }});
  for (const Ended* run : {&paths.stepping, &paths.lockstep, &paths.exact}) {
    CHECK(run->summary.status == RunStatus::interrupted);
    CHECK(run->summary.steps == 100);
    CHECK(run->state.t == run->summary.t_end);
    CHECK(without_numbers(run->summary.reason) == "oscillator: at t = # s: interrupted");
  }
  CHECK(paths.stepping.summary.reason == paths.lockstep.summary.reason);
}

TEST_CASE("Same fault, same message: an energy balance that is off, with what helps each method") {
  Model m = unit_oscillator();
  m.set_initial("m", 1.0, 0.0);
  m.add<AppliedTorque>("push", {"m"}, load([](double t) { return std::sin(t); }));
  const Paths paths = run_all(m.build(), {.step = 0.1, .t_end = 2.0, .energy_tolerance = 1e-300});
  for (const Ended* run : {&paths.stepping, &paths.lockstep, &paths.exact})
    CHECK(run->summary.status == RunStatus::energy_error);
  const auto balance = [](const Ended& run) {
    std::string text = without_numbers(run.summary.reason);
    for (const std::string way : {"gained from nothing", "lost by the method"})
      if (const auto at = text.find(way); at != std::string::npos) text.replace(at, way.size(), "#");
    return text;
  };
  const std::string head = "the energy balance is off by # % (#, worst at t = # s; at most # % passes): ";
  CHECK(balance(paths.stepping) == head + "take a smaller step");
  CHECK(balance(paths.lockstep) == head + "take a smaller step");
  CHECK(balance(paths.exact) == head + "ask for a smaller tolerance");
}

TEST_CASE("Same fault, same message: a step that fails in its last part, halved in vain") {
  Model m = unit_oscillator();
  m.set_initial("m", 0.0, 1.0);
  m.add<LawElement<Breaking>>("rope", {"m"}, {.to = 0.0563});
  const System system = m.build();
  const TransientOptions options{.step = 1e-2, .t_end = 1.0, .max_halvings = 3};
  State state = State::initial(system);
  const RunSummary stepping = simulate(system, options, state);
  const VariantResult lockstep = in_lockstep(system, options);
  CHECK(stepping.status == RunStatus::not_finite);
  CHECK(stepping.halved == 3);
  CHECK(stepping.steps > 5);  // parts of the sixth step among them
  CHECK(lockstep.summary.status == stepping.status);
  CHECK(lockstep.summary.reason == stepping.reason);
  CHECK(lockstep.summary.steps == stepping.steps);
  CHECK(lockstep.summary.halved == stepping.halved);
  CHECK(lockstep.state.t == state.t);
  CHECK(lockstep.state.z[0] == Approx(state.z[0]).epsilon(1e-12));
  CHECK(lockstep.state.v[0] == Approx(state.v[0]).epsilon(1e-12));
}

TEST_CASE(
    "Controlled steps end before a time or motion behind which a force is no "
    "number") {
  Model in_time = unit_oscillator(), in_motion = unit_oscillator();
  in_time.add<AppliedTorque>("bad", {"m"}, {.torque = [](double t) { return std::sqrt(0.2 - t); }});
  in_motion.set_initial("m", 0.0, 1.0);
  in_motion.add<LawElement<Breaking>>("rope", {"m"}, {.to = 0.0563});
  for (const bool of_time : {true, false})
    for (const char* method :
         {"average_acceleration", "generalized_alpha:0.8", "bathe", "sdirk4", "rk4", "dormand_prince"}) {
      const std::string what = of_time ? "the load of bad" : "the force of rope";
      INFO(method << ": " << what);
      const System system = (of_time ? in_time : in_motion).build();
      State state = State::initial(system);
      int asked = 0;
      const RunSummary run = simulate(system,
                                      {.scheme = step_scheme(method),
                                       .tolerance = 1e-6,
                                       .t_end = 1.0,
                                       .progress = [&](double) { return ++asked < 1000; }},
                                      state);
      CHECK(run.status == RunStatus::not_finite);
      // A load is not named where the step that failed is a rounding of the time long.
      if (std::string(method) == "dormand_prince" || !of_time)
        CHECK(without_numbers(run.reason) == "oscillator: at t = # s: " + what + " is not finite");
      CHECK(state.t == run.t_end);
      CHECK(state.z.allFinite());
      CHECK((of_time ? state.t : state.z[0]) == Approx(of_time ? 0.2 : 0.0563).epsilon(1e-8));
    }
}

TEST_CASE("A run that would take 1e12 steps ends with an error that says so") {
  const System system = unit_oscillator().build();
  CHECK_THROWS_WITH(propagate(system, {.t_end = 1e14}), Catch::Contains("would not end"));
  State state = State::initial(system);
  CHECK(propagate(system, {.t_end = 1e4}, state).ok());
}
