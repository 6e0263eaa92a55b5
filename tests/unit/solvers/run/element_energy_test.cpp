// Covers: channel_values.hpp, element_totals.hpp
// Energy, power and heat of elements over runs, against closed forms.
#include <drev/core/assembler.hpp>
#include <drev/core/channel.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/run/element_totals.hpp>
#include <drev/solvers/run/evaluated_state.hpp>
#include <drev/solvers/run/peaks.hpp>
#include <drev/solvers/run/recorder.hpp>

#include <cmath>
#include <functional>

#include "tests/catch.hpp"

using namespace drev;

namespace {

constexpr double kSwingInertia = 2.0, kSwingStiffness = 800.0, kSwingDamping = 4.0, kSwingStart = 0.05;

/// J q'' + c q' + k q = T cos(w t), on a wall.
System oscillator(double torque, double w, double start) {
  Model m("oscillator");
  m.add_node("disc");
  m.add<Inertia>("J", {"disc"}, {.inertia = kSwingInertia});
  m.add<GroundSpring>("spring", {"disc"}, {.stiffness = kSwingStiffness});
  m.add<Dashpot>("damper", {"disc"}, {.damping = kSwingDamping});
  m.add<AppliedTorque>("drive", {"disc"}, {.torque = [=](double t) { return torque * std::cos(w * t); }});
  m.set_initial("disc", start, 0.0);
  return m.build();
}

Method method_of(const std::string& name) {
  return name == kExact ? Method{kExact, 0.0, 1e-12} : Method{name, 1e-4, 0.0};
}

template <class Task>
std::string message_of(const Task& task) {
  try {
    task();
  } catch (const ModelError& error) {
    return error.what();
  }
  return {};
}

}  // namespace

TEST_CASE("Heat of a damped oscillator is the energy that it has lost", "[element_energy]") {
  // q = A exp(-d t) cos(w t - p): energy and heat by the closed form.
  const double d = kSwingDamping / (2.0 * kSwingInertia),
               w = std::sqrt(kSwingStiffness / kSwingInertia - d * d);
  const auto energies = [&](double t) {
    const double e = kSwingStart * std::exp(-d * t);
    const double q = e * (std::cos(w * t) + d / w * std::sin(w * t));
    const double v = -e * (w + d * d / w) * std::sin(w * t);
    return std::pair{0.5 * kSwingStiffness * q * q, 0.5 * kSwingInertia * v * v};
  };
  const double all = 0.5 * kSwingStiffness * kSwingStart * kSwingStart;
  for (const std::string name : {"exact", "average_acceleration"}) {
    INFO(name);
    const double tolerance = name == "exact" ? 1e-11 : 2e-6;  // the other: second order at h w = 2e-3
    const System system = oscillator(0.0, 1.0, kSwingStart);
    Recorder recorder(system,
                      {"damper.dissipated_J", "spring.stored_J", "J.kinetic_J", "damper.dissipation_W",
                       "spring.work_J", "damper.power_W", "damper.work_J"},
                      0.05);
    Peaks peaks(find_channels(system, {"damper.dissipation_W", "J.kinetic_J"}));
    run_method(system, method_of(name), {.t_end = 1.0}, {&recorder, &peaks});
    REQUIRE(recorder.times().size() == 21);
    for (std::size_t i = 0; i < recorder.times().size(); ++i) {
      const auto [stored, kinetic] = energies(recorder.times()[i]);
      const auto at = [&](std::size_t c) { return recorder.samples(c)[i]; };
      CHECK(at(0) == Approx(all - stored - kinetic).margin(tolerance * all));
      CHECK(at(1) == Approx(stored).margin(tolerance * all));
      CHECK(at(2) == Approx(kinetic).margin(tolerance * all));
      CHECK(at(3) == Approx(2.0 * kSwingDamping / kSwingInertia * kinetic).margin(10.0 * tolerance * all));
      CHECK(at(4) == Approx(all - stored).margin(tolerance * all));
      CHECK(at(5) == -at(3));
      CHECK(at(6) == Approx(-at(0)).margin(1e-15 * all));
    }
    // Largest where v' = 0: tan(w t) = w / d, between recorded times.
    const double t = std::atan2(w, d) / w;
    const double kinetic = energies(t).second;
    CHECK(peaks.peaks()[1].max == Approx(kinetic).epsilon(10.0 * tolerance));
    CHECK(peaks.peaks()[0].max ==
          Approx(2.0 * kSwingDamping / kSwingInertia * kinetic).epsilon(10.0 * tolerance));
    CHECK(peaks.peaks()[0].max_time == Approx(t).epsilon(name == "exact" ? 1e-6 : 1e-3));
  }
}

TEST_CASE("Heat is summed up with few looks inside a step, and what is rounding is not halved",
          "[element_energy]") {
  // Heat of c v^2 for a given v, which is shown as the motion of the step.
  struct Given final : StepMotion {
    Given(const System& system, std::function<double(double)> given)
        : assembler(system), v(std::move(given)) {
      point.state = State::initial(system);
    }
    Point at(double t) override {
      ++looks;
      point.state.t = t;
      point.state.v[0] = v(t);
      return {assembler, point};
    }
    Assembler assembler;
    std::function<double(double)> v;
    EvaluatedState point;
    int looks = 0;
  };
  const System system = oscillator(0.0, 1.0, kSwingStart);
  const auto heat_of = [&](Given& motion, double t_1, int steps) {
    std::vector<Channel> channels = energy_channels(system);
    std::erase_if(channels, [](const Channel& c) { return c.name() != "damper.dissipated_J"; });
    ChannelValues values(channels);
    values.look_through(motion);
    EvaluatedState from = motion.point, to = from;
    values.start(motion.assembler, from);
    for (int i = 0; i < steps; ++i) {
      from.state.t = t_1 * i / steps, to.state.t = t_1 * (i + 1) / steps;
      values.step(motion.assembler, from, to);
    }
    return values.value(0, motion.assembler, to);
  };
  // v = cos t: c (t/2 + sin(2 t)/4). Short steps take seven looks each, and long ones what they need.
  const double heat = kSwingDamping * (1.5 + 0.25 * std::sin(6.0));
  Given fine(system, [](double t) { return std::cos(t); }), coarse = fine;
  CHECK(heat_of(fine, 3.0, 100) == Approx(heat).epsilon(1e-12));
  CHECK(fine.looks == 700);
  CHECK(heat_of(coarse, 3.0, 1) == Approx(heat).epsilon(1e-12));
  CHECK(coarse.looks > 15);
  // 1 J is stored at the start; a speed of 1e-13 rad/s with no sense in it is rounding.
  Given rounding(system, [](double t) { return 1e-13 * std::sin(1e9 * t); });
  CHECK(heat_of(rounding, 1e-3, 10) < 1e-25);
  CHECK(rounding.looks == 70);
}

TEST_CASE("Stored energy has the rate of its own change along the motion, on either flank and in the gap",
          "[element_energy]") {
  Model m("mesh on a wall");
  m.add_node("wall");
  m.add_node("wheel");
  m.add_node("disc");
  m.constant_speed("wall", 0.0);
  for (const char* name : {"wheel", "disc"})
    m.add<Inertia>(std::string("J_") + name, {name}, {.inertia = 1.0});
  m.add<ShaftSpring>("spring", {"wall", "disc"}, {.stiffness = kSwingStiffness});
  m.add<GearMesh>("mesh", {"wall", "wheel"},
                  {.base_radius_1 = 0.1,
                   .base_radius_2 = 0.2,
                   .stiffness = 1e7,
                   .normal_backlash = 1e-4,
                   .damping = 800.0});
  const System system = m.build();
  std::vector<Channel> stored = energy_channels(system);
  std::erase_if(stored, [](const Channel& c) { return !c.name().ends_with(".stored_J"); });
  REQUIRE(stored.size() == 2);
  const Assembler assembler(system);
  State state = State::initial(system);
  for (const double angle : {-2e-3, 0.0, 2e-3})
    for (const double speed : {-0.7, 0.3}) {
      state.z.setConstant(angle), state.v.setConstant(speed);
      // Half of the gap is 5e-5 m, 2.5e-4 rad.
      const double beyond = std::copysign(std::max(std::abs(angle) - 2.5e-4, 0.0), angle);
      for (const Channel& c : stored) {
        CAPTURE(c.name(), angle, speed);
        const double right = c.name() == "spring.stored_J" ? kSwingStiffness * angle * speed
                                                           : 1e7 * 0.2 * 0.2 * beyond * speed;
        const std::optional<double> rate = c.rate(assembler, state);
        REQUIRE(rate);
        CHECK(*rate == Approx(right).epsilon(1e-12).margin(1e-12));
      }
    }
}

TEST_CASE("Power in is heat, cycle by cycle, of a forced oscillator that starts on its steady motion",
          "[element_energy]") {
  // From rest the transient has gone after 30 time constants; the mean power is c w^2 A^2 / 2.
  const double torque = 30.0, w = 25.0, cycle = kTwoPi / w, t_0 = 30.0;
  const System system = oscillator(torque, w, 0.0);
  Recorder recorder(system, {"drive.work_J", "damper.dissipated_J", "spring.work_J"}, t_0);
  Recorder later(system, {"drive.work_J", "damper.dissipated_J"}, t_0 + cycle);
  run_method(system, method_of("exact"), {.t_end = t_0 + cycle}, {&recorder, &later});
  const double amplitude = torque / std::hypot(kSwingStiffness - kSwingInertia * w * w, kSwingDamping * w);
  const double heat = 0.5 * kSwingDamping * w * w * amplitude * amplitude * cycle;
  const auto over_cycle = [&](std::size_t c) { return later.samples(c).back() - recorder.samples(c).back(); };
  CHECK(over_cycle(0) == Approx(heat).epsilon(1e-9));
  CHECK(over_cycle(1) == Approx(heat).epsilon(1e-9));
}

TEST_CASE("A driven train: actual speeds, and every element's work is what it loses and stores",
          "[element_energy]") {
  // A turning train with a mesh, backlash, a shaft, Rayleigh damping, damping on deviations and a load on each end.
  Model m("train");
  for (const char* name : {"engine", "pinion", "wheel"}) {
    m.add_node(name);
    m.add<Inertia>(std::string("J_") + name, {name}, {.inertia = 0.4});
  }
  m.add<ShaftSpring>("shaft", {"engine", "pinion"}, {.stiffness = 3e3, .damping = 1.0});
  m.add<GearMesh>("mesh", {"pinion", "wheel"},
                  {.base_radius_1 = 0.1,
                   .base_radius_2 = 0.2,
                   .stiffness = 1e7,
                   .normal_backlash = 1e-4,
                   .damping = 800.0});
  m.add<RayleighDamping>("rayleigh", {}, {.alpha_mass = 0.0, .beta_stiffness = 2e-4});
  m.add<AbsoluteDamper>("bearing", {"engine"}, {.damping = 0.3});
  m.add<EngineOrderTorque>("gas", {"engine"},
                           {.harmonics = {{2.0, 60.0, 0.0}}, .mean = 50.0, .twist_feedback = false});
  m.add<EngineOrderTorque>("load", {"wheel"}, {.mean = 100.0, .twist_feedback = false});
  m.set_reference("engine", constant_speed(50.0));
  const System system = m.build();
  ElementTotals totals(system);
  const std::vector<std::string> stored{"shaft.stored_J", "mesh.stored_J"};
  Recorder ends(
      system,
      {"shaft.stored_J", "mesh.stored_J", "J_engine.kinetic_J", "J_pinion.kinetic_J", "J_wheel.kinetic_J"},
      0.4);
  const RunSummary summary = run_method(system, method_of("exact"), {.t_end = 0.4}, {&totals, &ends});
  REQUIRE(summary.ok());
  const auto change = [&](std::size_t c) { return ends.samples(c).back() - ends.samples(c).front(); };
  double work = 0.0, kinetic = change(2) + change(3) + change(4), largest = 0.0;
  std::size_t with_heat = 0;
  for (const ElementTotals::Row& row : totals.rows()) {
    INFO(row.element);
    if (row.work) work += *row.work, largest = std::max(largest, std::abs(*row.work));
    if (row.dissipated) ++with_heat;
    if (row.element == "shaft" || row.element == "mesh") {
      const double held = change(row.element == "shaft" ? 0 : 1);
      CHECK(*row.work == Approx(-*row.dissipated - held).epsilon(1e-8).margin(1e-9));
      CHECK(*row.dissipated > 0.0);
      CHECK(*row.largest_stored > 0.0);
      CHECK(*row.mean_loss() == Approx(*row.dissipated / 0.4));
    }
    if (row.element == "load") CHECK(*row.work < 0.0);  // it turns backwards with the wheel
    if (row.element == "gas") CHECK(*row.work == Approx(50.0 * 50.0 * 0.4).epsilon(0.2));
  }
  CHECK(with_heat == 3);  // shaft, mesh, bearing
  CHECK(work == Approx(kinetic).margin(1e-9 * largest));
}

TEST_CASE(
    "Rayleigh damping heats by deviations alone: elements of a turning train lose what the energy balance "
    "says",
    "[element_energy]") {
  Model m("discs");
  for (const char* name : {"a", "b"}) {
    m.add_node(name);
    m.add<Inertia>(std::string("J_") + name, {name}, {.inertia = 1.0});
  }
  m.add<ShaftSpring>("shaft", {"a", "b"}, {.stiffness = 1000.0});
  m.add<RayleighDamping>("rayleigh", {}, {.alpha_mass = 10.0, .beta_stiffness = 1e-4});
  m.add<EngineOrderTorque>("gas", {"a"}, {.harmonics = {{1.0, 1.0, 0.0}}});
  m.set_reference("a", constant_speed(1000.0 * kPi / 30.0));
  const System system = m.build();
  ElementTotals totals(system);
  const RunSummary summary = run_method(system, method_of("exact"), {.t_end = 1.0}, {&totals});
  REQUIRE(summary.ok());
  double heat = 0.0;
  for (const ElementTotals::Row& row : totals.rows()) heat += row.dissipated.value_or(0.0);
  CHECK(summary.energy.dissipated > 1e-5);
  CHECK(heat == Approx(summary.energy.dissipated).epsilon(1e-8));
}

TEST_CASE("What is summed up over a run is recorded and refused elsewhere", "[element_energy]") {
  const System system = oscillator(1.0, 3.0, 0.0);
  const std::vector<std::string> name{"damper.dissipated_J"};
  CHECK(message_of([&] { find_channels(system, name); }).find("is summed up over a run") !=
        std::string::npos);
  const Channel channel = find_channels(system, name, OverRun::taken).front();
  CHECK(channel.over_run());
  CHECK(channel.unit() == "J");
  Assembler assembler(system);
  assembler.set_time(0.0);
  CHECK_THROWS_AS(channel.evaluate(assembler, State::initial(system)), SolverError);
  CHECK(message_of([&] {
          find_channels(system, {"damper.disipation_W"});
        }).find("did you mean 'damper.dissipation_W'") != std::string::npos);
  // An inertia has no power of its own, a spring without damping no heat.
  CHECK_THROWS_AS(find_channels(system, {"J.power_W"}, OverRun::taken), ModelError);
  CHECK_THROWS_AS(find_channels(system, {"spring.dissipated_J"}, OverRun::taken), ModelError);
}
