// Periodic steady state against closed forms and against the last turn of long runs.
// Covers solvers/periodic/harmonic_balance.hpp and load_harmonics.hpp through solve_periodic().
#include <drev/core/law_element.hpp>
#include <drev/core/ritz_projection.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/models/ready_made.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/periodic/periodic_response.hpp>
#include <drev/solvers/run/peaks.hpp>

#include <algorithm>
#include <cmath>
#include <complex>

#include "tests/catch.hpp"
#include "tests/problems/driven_gear.hpp"
#include "tests/problems/general_elements.hpp"

using namespace drev;

namespace {

using Complex = std::complex<double>;

/// J on a spring to ground under cosines of the time, w = 10 rad/s.
struct Driven {
  double inertia = 2.0, damping = 3.0, stiffness = 800.0;
  std::vector<Harmonic> harmonics = {{1.0, 5.0, 0.3}, {3.0, 2.0, -1.0}};
  double mean = 4.0, speed = 10.0;

  Model model() const {
    Model m("driven oscillator");
    m.add_node("clock");
    m.add_node("disc");
    m.add<Inertia>("J", {"disc"}, {.inertia = inertia});
    m.add<ShaftSpring>("shaft", {"clock", "disc"}, {.stiffness = stiffness});
    if (damping > 0.0) m.add<Dashpot>("drag", {"clock", "disc"}, {.damping = damping});
    m.add<EngineOrderTorque>("torque", {"disc"},
                             {.harmonics = harmonics, .mean = mean, .twist_feedback = false});
    m.constant_speed("clock", speed);
    return m;
  }
  /// y_n = A e^(i phase) / (k - (n w)^2 J + i n w c)
  Complex exact(const Harmonic& h) const {
    const double w = h.order * speed;
    return h.amplitude * std::exp(Complex(0.0, h.phase)) / Complex(stiffness - w * w * inertia, w * damping);
  }
};

}  // namespace

TEST_CASE("Periodic response of a damped oscillator is its closed form, harmonic by harmonic") {
  const Driven p;
  const System system = p.model().build();
  const PeriodicResponse r =
      solve_periodic(system, {.channels = {"disc.angle_rad", "disc.acceleration_rad_per_s2"}});
  INFO(r.reason);
  REQUIRE(r.found);
  CHECK(r.period == Approx(kTwoPi / p.speed).epsilon(1e-15));
  CHECK(r.order_step == Approx(1.0).epsilon(1e-15));
  CHECK(r.contact_closed);
  CHECK(r.error < 1e-12);
  CHECK(std::abs(r.amplitudes[0][0] - p.mean / p.stiffness) < 1e-16);
  for (const Harmonic& h : p.harmonics) {
    const Complex y = p.exact(h);
    const auto n = static_cast<std::size_t>(h.order);
    CHECK(std::abs(r.amplitudes[0][n] - y) < 1e-14 * std::abs(y));
    CHECK(std::abs(r.amplitudes[1][n] + h.order * h.order * 100.0 * y) < 1e-12 * 100.0 * std::abs(y));
  }
  CHECK(std::abs(r.amplitudes[0][2]) < 1e-16);
  double max = -1.0, min = 1.0;
  for (int s = 0; s < 100000; ++s) {
    double y = p.mean / p.stiffness;
    for (const Harmonic& h : p.harmonics)
      y += (p.exact(h) * std::exp(Complex(0.0, kTwoPi * h.order * s / 100000))).real();
    max = std::max(max, y);
    min = std::min(min, y);
  }
  // Cubic between 128 samples: (2 pi 3 / 128)^4 / 384 = 1e-6 of the third harmonic.
  CHECK(r.peaks[0].max == Approx(max).epsilon(1e-6));
  CHECK(r.peaks[0].min == Approx(min).epsilon(1e-6));
}

TEST_CASE("An undamped mode at a harmonic at which nothing acts stays at rest, unless a law may reach it") {
  // 1 N m at 10 rad/s, natural frequency 20 rad/s: k/(k - w^2 J).
  const Driven p{
      .inertia = 2.0, .damping = 0.0, .stiffness = 800.0, .harmonics = {{1.0, 1.0, 0.3}}, .mean = 0.0};
  const PeriodicResponse r = solve_periodic(p.model().build(), {.channels = {"shaft.torque_Nm"}});
  INFO(r.reason);
  REQUIRE(r.found);
  CHECK(r.peaks[0].max == Approx(4.0 / 3.0).epsilon(1e-6));
  Driven excited = p;
  excited.harmonics.push_back({2.0, 1e-6, 0.0});
  CHECK(solve_periodic(excited.model().build(), {}).reason.find("undamped resonance") != std::string::npos);
  Model bent = p.model();
  bent.add<PolylineSpring>("stop", {"clock", "disc"}, {.x = {-1.0, 1.0, 2.0}, .y = {0.0, 0.0, 1.0}});
  CHECK_FALSE(solve_periodic(bent.build(), {}).found);
}

TEST_CASE("Periodic response of two masses is the solution of the two complex equations") {
  const double w = 30.0, tau = 7.0;
  Model m("chain");
  for (const char* name : {"clock", "a", "b"}) m.add_node(name);
  m.add<Inertia>("J_a", {"a"}, {.inertia = 0.5});
  m.add<Inertia>("J_b", {"b"}, {.inertia = 2.0});
  m.add<ShaftSpring>("first", {"clock", "a"}, {.stiffness = 900.0, .damping = 2.0});
  m.add<ShaftSpring>("second", {"a", "b"}, {.stiffness = 400.0, .damping = 1.5});
  m.add<EngineOrderTorque>("torque", {"b"}, {.harmonics = {{0.5, tau, 0.0}}, .twist_feedback = false});
  m.constant_speed("clock", w);
  const System system = m.build();
  // Half an order: two turns.
  const PeriodicResponse r =
      solve_periodic(system, {.channels = {"a.angle_rad", "b.angle_rad", "second.torque_Nm"}, .turns = 2.0});
  REQUIRE(r.found);
  CHECK(r.order_step == Approx(0.5).epsilon(1e-15));
  const Complex i_w(0.0, 0.5 * w), first = 900.0 + 2.0 * i_w, second = 400.0 + 1.5 * i_w;
  Eigen::Matrix2cd s;
  s << first + second + 0.5 * i_w * i_w, -second, -second, second + 2.0 * i_w * i_w;
  const Eigen::Vector2cd y = s.inverse() * Eigen::Vector2cd(0.0, tau);
  CHECK(std::abs(r.amplitudes[0][1] - y[0]) < 1e-13 * std::abs(y[0]));
  CHECK(std::abs(r.amplitudes[1][1] - y[1]) < 1e-13 * std::abs(y[1]));
  const Complex torque = second * (y[1] - y[0]);
  CHECK(std::abs(r.amplitudes[2][1] - torque) < 1e-13 * std::abs(torque));
  CHECK(r.peaks[2].amplitude() == Approx(std::abs(torque)).epsilon(1e-6));
}

namespace {

/// y = k x + k3 x^3 [N m].
struct CubicLaw {
  double k = 0.0, k3 = 0.0;
  ScalarResponse operator()(const ScalarInput& in) const {
    const double x = in.x;
    return {.y = x * (k + k3 * x * x),
            .dy_dx = k + 3 * k3 * x * x,
            .stored_energy = x * x * (0.5 * k + 0.25 * k3 * x * x)};
  }
};

}  // namespace

TEST_CASE("A cubic spring under the torque that x = A cos w t needs") {
  const double inertia = 2.0, c = 3.0, k = 800.0, k3 = 8e5, w = 10.0, a = 0.03, cube = k3 * a * a * a;
  Model m("cubic");
  m.add_node("clock");
  m.add_node("disc");
  m.add<Inertia>("J", {"disc"}, {.inertia = inertia});
  m.add<LawElement<CubicLaw>>("spring", {"clock", "disc"}, {k, k3});
  m.add<Dashpot>("drag", {"clock", "disc"}, {.damping = c});
  // cos^3 = 3/4 cos + 1/4 cos 3
  m.add<EngineOrderTorque>("torque", {"disc"},
                           {.harmonics = {{1.0, (k - w * w * inertia) * a + 0.75 * cube, 0.0},
                                          {1.0, c * w * a, kPi / 2},
                                          {3.0, 0.25 * cube, 0.0}},
                            .twist_feedback = false});
  m.constant_speed("clock", w);
  const PeriodicResponse r = solve_periodic(m.build(), {.tolerance = 1e-10, .channels = {"disc.angle_rad"}});
  INFO(r.reason);
  REQUIRE(r.found);
  CHECK(r.iterations > 1);
  CHECK(std::abs(r.amplitudes[0][1] - a) < 1e-11 * a);
  for (std::size_t n = 0; n < 10; ++n)
    if (n != 1) CHECK(std::abs(r.amplitudes[0][n]) < 1e-11 * a);
}

TEST_CASE("A gap that stays closed is a linear mesh with an offset, on both flanks") {
  const double b = 0.3, c = 0.1, w = 0.5;
  for (const double mean : {1.0, -1.0}) {
    const problems::DrivenGear gear{
        .speed = w, .half_gap = b, .damping = c, .mean = mean, .harmonics = {{1.0, 0.2, 0.0}}};
    const PeriodicResponse r = solve_periodic(gear.build(), {.channels = {"wheel.angle_rad"}});
    INFO(r.reason);
    REQUIRE(r.found);
    CHECK(r.contact_closed);
    CHECK(std::abs(r.amplitudes[0][0] - mean * (1.0 + b)) < 1e-12);
    CHECK(std::abs(r.amplitudes[0][1] - 0.2 / Complex(1.0 - w * w, w * c)) < 1e-12);
  }
}

TEST_CASE("A gap that opens, a stiffness by phase: exact propagation comes back to where the period began") {
  const problems::DrivenGear open{
      .speed = 0.8, .half_gap = 0.2, .damping = 0.1, .mean = 0.5, .harmonics = {{1.0, 0.5, 0.0}}};
  const problems::DrivenGear varying{
      .speed = 0.8, .stiffness = MeshStiffness::fourier(1.0, {{1.0, 0.3, 0.5}}), .damping = 0.1, .mean = 0.5};
  for (const problems::DrivenGear& gear : {open, varying}) {
    const System system = gear.build();
    const PeriodicResponse r =
        solve_periodic(system, {.channels = {"wheel.angle_rad", "wheel.speed_rad_per_s"}});
    INFO(r.reason);
    REQUIRE(r.found);
    CHECK(r.contact_closed == (gear.half_gap == 0.0));
    State state = State::initial(system);
    const auto at_start = [&](std::size_t c) {
      Complex sum = 0.0;
      for (const Complex& a : r.amplitudes[c]) sum += a;
      return sum.real();
    };
    state.z[0] = at_start(0);
    state.v[0] = at_start(1);
    Peaks peaks(find_channels(system, {"wheel.angle_rad"}), true);
    REQUIRE(propagate(system, {.t_end = r.period}, state, {&peaks}).ok());
    CHECK(std::abs(state.z[0] - at_start(0)) < 1e-5 * r.peaks[0].amplitude());
    CHECK(std::abs(state.v[0] - at_start(1)) < 1e-5 * r.peaks[1].amplitude());
    CHECK(r.peaks[0].max == Approx(peaks.peaks()[0].max).epsilon(1e-5));
    CHECK(r.peaks[0].min == Approx(peaks.peaks()[0].min).epsilon(1e-5));
  }
}

TEST_CASE("Camshaft held: the last turn of a long exact run", "[once]") {
  for (const char* loads : {"source", "actual"}) {
    INFO(loads);
    Parameters s("camshaft", camshaft_entry().parameters);
    s.set("drive", "held");
    s.set("loads", loads);
    s.set("damping", "case_1");
    const ModelCase model_case = camshaft_entry().build(s);
    const System system = model_case.model.build();
    std::vector<std::string> names = model_case.torques;
    names.push_back(model_case.deflection);
    const PeriodicResponse r = solve_periodic(system, {.channels = names});
    INFO(r.reason);
    REQUIRE(r.found);
    CHECK(r.error < 1e-3);  // kinks of the loads meet stiff modes: 4096 harmonics do not hold them
    // Free motion decays with exp(-a t/2), a = 15.4 1/s: to 1e-10 in 3 s.
    State state = State::initial(system);
    Peaks last(find_channels(system, names), true);
    const double start = std::ceil(3.0 / r.period) * r.period;
    REQUIRE(propagate(system, {.t_end = start}, state).ok());
    REQUIRE(propagate(system, {.t_start = start, .t_end = start + r.period}, state, {&last}).ok());
    for (std::size_t c = 0; c < names.size(); ++c) {
      const Peak& exact = last.peaks()[c];
      const double least = std::min(1e-5, r.error);
      CHECK(std::abs(r.peaks[c].max - exact.max) < least * exact.amplitude());
      CHECK(std::abs(r.peaks[c].min - exact.min) < least * exact.amplitude());
    }
  }
}

TEST_CASE("A load that follows the motion of a node over several coordinates") {
  // Up to 600 N m/rad beside springs of 800: without these slopes Newton's method does not converge. In
  // other coordinates the motion is the same.
  Model m("two discs");
  m.add_node("clock");
  m.add_node("a");
  m.add_node("b");
  m.add<Inertia>("J_a", {"a"}, {.inertia = 2.0});
  m.add<Inertia>("J_b", {"b"}, {.inertia = 1.0});
  m.add<ShaftSpring>("first", {"clock", "a"}, {.stiffness = 800.0, .damping = 6.0});
  m.add<ShaftSpring>("second", {"a", "b"}, {.stiffness = 800.0, .damping = 3.0});
  m.add<EngineOrderTorque>("torque", {"b"}, {.harmonics = {{2.0, 300.0, 0.3}}, .twist_feedback = true});
  m.constant_speed("clock", 10.0);
  const System system = m.build();
  const Eigen::MatrixXd basis{{1.0, 0.5}, {1.0, -0.5}};
  const std::vector<std::string> channels{"a.angle_rad", "b.angle_rad"};
  const PeriodicResponse full = solve_periodic(system, {.channels = channels});
  const PeriodicResponse other = solve_periodic(ritz_projection(system, basis), {.channels = channels});
  INFO(full.reason << other.reason);
  REQUIRE(full.found);
  REQUIRE(other.found);
  for (std::size_t c = 0; c < 2; ++c)
    CHECK(other.peaks[c].amplitude() == Approx(full.peaks[c].amplitude()).epsilon(1e-6));
  CHECK(other.iterations <= full.iterations + 1);
}

TEST_CASE("At a damped resonance A/(w c), without damping there is no periodic motion to find") {
  Driven p{.harmonics = {{1.0, 5.0, 0.0}}, .mean = 0.0, .speed = 20.0};  // k/J = 400
  const PeriodicResponse damped = solve_periodic(p.model().build(), {.channels = {"disc.angle_rad"}});
  REQUIRE(damped.found);
  CHECK(damped.peaks[0].amplitude() == Approx(5.0 / (20.0 * 3.0)).epsilon(1e-6));
  CHECK(std::abs(damped.amplitudes[0][1] - Complex(0.0, -5.0 / 60.0)) < 1e-14);
  p.damping = 0.0;
  for (const double detuning : {0.0, 1e-13}) {
    p.speed = 20.0 * (1.0 + detuning);
    const PeriodicResponse r = solve_periodic(p.model().build(), {});
    CHECK_FALSE(r.found);
    CHECK(r.reason.find("resonance") != std::string::npos);
    CHECK(r.reason.find("harmonic 1") != std::string::npos);
  }
}

TEST_CASE("What has no periodic response, or none that can be found, says why") {
  const auto refused = [](const System& system, const PeriodicOptions& options, const std::string& words) {
    const PeriodicResponse r = solve_periodic(system, options);
    INFO(r.reason);
    CHECK_FALSE(r.found);
    CHECK(r.reason.find(words) != std::string::npos);
  };
  const Driven p;
  refused(p.model().build(), {.period = 0.5}, "does not have the period");
  {
    Model m("free");
    m.add_node("a");
    m.add_node("b");
    m.add<Inertia>("J_a", {"a"}, {.inertia = 1.0});
    m.add<Inertia>("J_b", {"b"}, {.inertia = 1.0});
    m.add<ShaftSpring>("shaft", {"a", "b"}, {.stiffness = 100.0});
    refused(m.build(), {.period = 1.0}, "floats");
    CHECK_THROWS_AS(solve_periodic(m.build(), {}), ModelError);  // no reference shaft
  }
  Model history = p.model();
  history.add<problems::Maxwell>("maxwell", {"clock", "disc"}, {.stiffness = 10.0, .damping = 1.0});
  refused(history.build(), {}, "history");
  // A period that begins with a jump of a load: as its harmonics fall off, 1e-6 would need more than 4096.
  Model jumps = p.model();
  jumps.add<AppliedTorque>("square", {"disc"}, {.torque = [](double t) {
                             return std::fmod(10.0 * t, kTwoPi) < kPi ? 1.0 : -1.0;
                           }});
  refused(jumps.build(), {.channels = {"disc.acceleration_rad_per_s2"}}, "not the tolerance");
  CHECK_THROWS_AS(solve_periodic(p.model().build(), {.harmonics = -1}), ModelError);
  CHECK_THROWS_AS(solve_periodic(p.model().build(), {.tolerance = 0.0}), ModelError);
  CHECK_THROWS_AS(solve_periodic(p.model().build(), {.channels = {"dics.angle_rad"}}), ModelError);
}

TEST_CASE("Sweep over speeds: the worst speed of a damped oscillator is sqrt(k/J - c^2/(2 J^2))", "[once]") {
  Driven p{.harmonics = {{1.0, 5.0, 0.0}}, .mean = 0.0};
  std::vector<double> speeds;
  for (double w = 5.0; w < 41.0; w += 2.5) speeds.push_back(w);
  std::vector<double> solved;
  const auto at_speed = [&](double w) {
    solved.push_back(w);
    p.speed = w;
    return p.model().build();
  };
  const SpeedSweep sweep =
      sweep_speeds(at_speed, speeds, {.channels = {"disc.angle_rad", "disc.speed_rad_per_s"}});
  REQUIRE(sweep.curve.size() == speeds.size());
  for (const SpeedSweep::Point& point : sweep.curve) {
    REQUIRE(point.response.found);
    p.speed = point.speed;
    CHECK(point.response.peaks[0].amplitude() == Approx(std::abs(p.exact(p.harmonics[0]))).epsilon(1e-6));
  }
  const double d = p.damping / (2 * p.inertia), square = p.stiffness / p.inertia;
  CHECK(sweep.worst[0].speed == Approx(std::sqrt(square - 2 * d * d)).epsilon(1e-3));
  CHECK(sweep.worst[0].amplitude == Approx(5.0 / (p.damping * std::sqrt(square - d * d))).epsilon(1e-6));
  CHECK(sweep.worst[1].speed == Approx(std::sqrt(square)).epsilon(1e-3));  // of the rate
  CHECK(sweep.worst[1].amplitude == Approx(5.0 / p.damping).epsilon(1e-6));
  std::sort(solved.begin(), solved.end());
  CHECK(std::unique(solved.begin(), solved.end()) == solved.end());  // once for both channels
  CHECK_THROWS_AS(sweep_speeds(at_speed, {}, {.channels = {"disc.angle_rad"}}), ModelError);
  CHECK_THROWS_AS(sweep_speeds(at_speed, speeds, {}), ModelError);
}
