// What a tired user gets wrong: everything ends in a clear error, never in a crash, a hang or nonsense.
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/run/recorder.hpp>
#include <drev/solvers/statics.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tests/catch.hpp"
#include "tests/problems/oscillator.hpp"
#include "tests/unit/not_finite.hpp"

using namespace drev;

namespace {

/// Ends with an error of the engine or a status that says so.
bool refused(const System& system) {
  try {
    const RunSummary summary = simulate(system, {.step = 1e-3, .t_end = 0.02});
    return !summary.ok() && !summary.reason.empty();
  } catch (const SolverError&) {
    return true;
  } catch (const ModelError&) {
    return true;
  }
}

Model pair() {
  Model m("pair");
  for (const char* name : {"a", "b"}) {
    m.add_node(name);
    m.add<Inertia>(std::string("J_") + name, {name}, {.inertia = 1.0});
  }
  m.add<ShaftSpring>("shaft", {"a", "b"}, {.stiffness = 1e3, .damping = 1.0});
  return m;
}

}  // namespace

TEST_CASE("Functions that return NaN, at once or later") {
  for (const double from : {0.0, 0.0105}) {
    INFO("NaN from " << from);
    const auto motion = [from](double t) { return t < from ? MotionPoint{} : MotionPoint{kNan, kNan, kNan}; };
    Model driven = pair();
    driven.given_motion("a", {motion});
    CHECK(refused(driven.build()));
    Model turning = pair();
    turning.set_reference("a", {motion});
    CHECK(refused(turning.build()));
    Model loaded = pair();
    loaded.add<AppliedTorque>("torque", {"b"},
                              {.torque = [from](double t) { return t < from ? 0.0 : kNan; }});
    CHECK(refused(loaded.build()));
  }
  Model held = pair();
  held.hold("a");
  held.add<AppliedTorque>("torque", {"b"}, {.torque = [](double) { return kNan; }});
  REQUIRE_THROWS_AS(solve_static(held.build()), SolverError);
  Model angle = pair();
  angle.set_reference("a", {[](double) { return MotionPoint{kNan, 0.0, 0.0}; }});
  angle.add<EngineOrderTorque>("gas", {"b"}, {.harmonics = {{.order = 1, .amplitude = 1.0}}});
  CHECK(refused(angle.build()));
}

TEST_CASE("A function that throws: the exception arrives, and the system can be used again") {
  Model m = pair();
  bool broken = true;
  m.add<AppliedTorque>("torque", {"b"}, {.torque = [&broken](double t) {
                         if (broken && t > 0.005) throw std::runtime_error("sensor lost");
                         return 1.0;
                       }});
  const System s = m.build();
  REQUIRE_THROWS_AS(simulate(s, {.step = 1e-3, .t_end = 0.02}), std::runtime_error);
  State state = State::initial(s);
  REQUIRE_THROWS_AS(simulate(s, {.step = 1e-3, .t_end = 0.02}, state), std::runtime_error);
  CHECK(state.t == Approx(0.005).margin(1.5e-3));  // the last accepted state is not lost
  CHECK(state.z.size() == s.size());
  broken = false;
  CHECK(simulate(s, {.step = 1e-3, .t_end = 0.02}).ok());
}

TEST_CASE("Scales from 1e-12 to 1e12 give the same motion") {
  for (const double scale : {1e-12, 1e-6, 1.0, 1e6, 1e12}) {
    const problems::Oscillator o{
        .inertia = 2.0 * scale, .damping = 3.0 * scale, .stiffness = 800.0 * scale, .torque = 5.0 * scale};
    const System s = o.model().build();
    Recorder recorder(s, {"disc.angle_rad"}, 0.05);
    const RunSummary summary = simulate(s, {.step = 1e-4, .t_end = 0.5}, {&recorder});
    INFO("scale " << scale << ": " << summary.brief_report());
    CHECK(summary.ok());
    // Average acceleration: phase error (w h)^2/12 w t = 3.3e-6 * 10, times the amplitude 0.004.
    for (std::size_t i = 0; i < recorder.times().size(); ++i)
      CHECK(recorder.samples(0)[i] == Approx(o.exact(recorder.times()[i])).margin(1e-6));
    Model still = o.model();
    const System built = still.build();
    CHECK(solve_static(built).state.z[0] == Approx(5.0 / 800.0));
  }
}

TEST_CASE("Parts of very different scale in one model") {
  Model m("scales");
  m.add_node("rotor");
  m.add_node("watch");
  m.add<Inertia>("rotor", {"rotor"}, {.inertia = 1e12});
  m.add<Inertia>("watch", {"watch"}, {.inertia = 1e-12});
  m.add<GroundSpring>("s_1", {"rotor"}, {.stiffness = 1e12});
  m.add<GroundSpring>("s_2", {"watch"}, {.stiffness = 1e-12});
  m.set_initial("rotor", 1.0, 0.0);
  m.set_initial("watch", 1.0, 0.0);
  const System s = m.build();
  State state = State::initial(s);
  CHECK(simulate(s, {.step = 1e-3, .t_end = 1.0}, state).ok());
  CHECK(state.z[0] == Approx(std::cos(1.0)).epsilon(1e-6));
  CHECK(state.z[1] == Approx(std::cos(1.0)).epsilon(1e-6));
}

TEST_CASE("Breakpoints at the start and the end, before and after, doubled a rounding apart") {
  // A jump of torque at 0.1 s, known to a rounding from two sides.
  const problems::Oscillator o{.torque = 0.0, .start = 0.0};
  const problems::Oscillator after{.start = 0.0};
  Model m = o.model();
  const auto torque = [](double t) { return t < 0.1 ? 0.0 : 5.0; };
  const double above = std::nextafter(0.1, 1.0), below = std::nextafter(0.1, 0.0);
  m.add<AppliedTorque>(
      "jump", {"disc"},
      {.torque = torque, .breakpoints = {0.5, 0.0, 0.1, -3.0, above, 0.1, 7.0, below, 0.1 + 1e-13}});
  const System s = m.build();
  CHECK(s.breakpoints().front() == -3.0);
  CHECK(std::is_sorted(s.breakpoints().begin(), s.breakpoints().end()));
  CHECK(s.breakpoints().size() == 8);
  Recorder recorder(s, {"disc.angle_rad"}, 0.1);
  const RunSummary summary = simulate(s, {.step = 1e-3, .t_end = 0.5}, {&recorder});
  INFO(summary.brief_report());
  CHECK(summary.ok());
  CHECK(summary.steps < 510);
  CHECK(recorder.times().size() == 6);
  CHECK(recorder.samples(0)[1] == Approx(0.0).margin(1e-15));
  // (w h)^2/12 w t times the amplitude: 3.3e-5 * 8 * 0.006.
  for (std::size_t i = 2; i < recorder.times().size(); ++i)
    CHECK(recorder.samples(0)[i] == Approx(after.exact(recorder.times()[i] - 0.1)).margin(5e-6));
}

TEST_CASE("Options and states that do not fit the model") {
  const System s = pair().build();
  State state = State::initial(s);
  REQUIRE_THROWS_AS(simulate(s, {.step = 0.0, .t_end = 1.0}), ModelError);
  REQUIRE_THROWS_AS(simulate(s, {.step = kNan, .t_end = 1.0}), ModelError);
  REQUIRE_THROWS_AS(simulate(s, {.step = 1e-3, .t_end = 0.0}), ModelError);
  State small = state;
  small.z = Vector::Zero(1);
  REQUIRE_THROWS_AS(simulate(s, {.step = 1e-3, .t_end = 1.0}, small), ModelError);
  State wild = state;
  wild.v[1] = kNan;
  REQUIRE_THROWS_AS(simulate(s, {.step = 1e-3, .t_end = 1.0}, wild), ModelError);
  State remembers = state;
  remembers.history = Vector::Zero(3);
  REQUIRE_THROWS_AS(simulate(s, {.step = 1e-3, .t_end = 1.0}, remembers), ModelError);
  REQUIRE_THROWS_AS(Recorder(s, {"a.angle_rad"}, 0.0), ModelError);
  REQUIRE_THROWS_AS(solve_static(s), SolverError);  // floats
}

TEST_CASE("An absurd initial angle: the energy is finite, or the run says that it is not") {
  Model m = pair();
  m.set_initial("a", 1e300, 0.0);
  const System s = m.build();
  const RunSummary summary = simulate(s, {.step = 1e-3, .t_end = 0.01});
  CHECK(summary.status == RunStatus::not_finite);
}
