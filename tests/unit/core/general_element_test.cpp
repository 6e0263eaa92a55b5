// General elements with history and with unsymmetric tangents, simulated against closed forms.
#include <drev/core/verify.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/run/recorder.hpp>
#include <drev/solvers/statics.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <cmath>
#include <complex>

#include "tests/catch.hpp"
#include "tests/problems/general_elements.hpp"

using namespace drev;

namespace {

/// Largest difference of a channel from an exact curve over a run.
template <class Exact>
double worst_error(const System& s, const char* channel, double step, double end, Exact exact) {
  TransientOptions options{.step = step, .t_end = end};
  options.energy_tolerance = 1.0;  // these elements report no energies
  Recorder recorder(s, {channel}, end / 200);
  const RunSummary summary = simulate(s, options, {&recorder});
  REQUIRE((summary.ok() || summary.status == RunStatus::energy_error));
  REQUIRE(!summary.newton_on_contacts);
  double worst = 0.0;
  for (std::size_t i = 0; i < recorder.times().size(); ++i)
    worst = std::max(worst, std::abs(recorder.samples(0)[i] - exact(recorder.times()[i])));
  return worst;
}

}  // namespace

TEST_CASE("Jenkins friction: stick, slip, and the rest that remains") {
  // J = 1, k = 100, slip at 2 N m, from rest with 1 rad/s: sticks to x = 0.02, slips with -2 rad/s^2 to a
  // stop, then swings about a point 0.02 short of that for ever.
  Model m("friction");
  m.add_node("disc");
  m.add<Inertia>("disc", {"disc"}, {.inertia = 1.0});
  m.add<problems::Jenkins>("clutch", {"disc"}, {.stiffness = 100.0, .slip = 2.0});
  m.set_initial("disc", 0.0, 1.0);
  const System s = m.build();
  CHECK(s.history_size() == 1);
  const double t_slip = std::asin(0.2) / 10.0, v_slip = std::sqrt(1.0 - 0.04);
  const double t_stop = t_slip + v_slip / 2.0, x_max = 0.02 + v_slip * v_slip / 4.0;
  const auto exact = [&](double t) {
    if (t < t_slip) return 0.1 * std::sin(10.0 * t);
    const double u = t - t_slip;
    if (t < t_stop) return 0.02 + v_slip * u - u * u;
    return x_max - 0.02 + 0.02 * std::cos(10.0 * (t - t_stop));
  };
  // Second order away from the two kinks, of which each costs O(h^2).
  const double coarse = worst_error(s, "disc.angle_rad", 1e-3, 1.0, exact);
  const double fine = worst_error(s, "disc.angle_rad", 2.5e-4, 1.0, exact);
  CHECK(coarse < 2e-5);
  CHECK(fine < coarse / 6.0);
}

TEST_CASE("Maxwell element: relaxation of an oscillator, second order") {
  // q'' + y = 0, y' = k q' - r y with r = k/c; q(0) = y(0) = 0, v(0) = 1. Hence v'' = -y' = -k v - r v',
  // v'(0) = 0:  v = e^(-r t/2) (cos w t + r/(2 w) sin w t),  w^2 = k - r^2/4.
  const double k = 100.0, c = 20.0, r = k / c, w = std::sqrt(k - r * r / 4);
  Model m("relaxation");
  m.add_node("disc");
  m.add<Inertia>("disc", {"disc"}, {.inertia = 1.0});
  m.add<problems::Maxwell>("damper", {"disc"}, {.stiffness = k, .damping = c});
  m.set_initial("disc", 0.0, 1.0);
  const System s = m.build();
  const auto speed = [&](double t) {
    return std::exp(-r * t / 2) * (std::cos(w * t) + r / (2 * w) * std::sin(w * t));
  };
  const double e_1 = worst_error(s, "disc.speed_rad_per_s", 1e-2, 2.0, speed);
  const double e_2 = worst_error(s, "disc.speed_rad_per_s", 5e-3, 2.0, speed);
  CHECK(e_2 < 1e-3);
  CHECK(std::log2(e_1 / e_2) == Approx(2.0).margin(0.1));
}

TEST_CASE("Circulatory coupling: unsymmetric tangent, solved by LU") {
  // J z'' + (k - i s) z = 0 for z = q_1 + i q_2 under f = s (q_2, -q_1).
  const double k = 50.0, s_c = 8.0;
  Model m("circulatory");
  for (const char* name : {"x", "y"}) {
    m.add_node(name);
    m.add<Inertia>(std::string("J_") + name, {name}, {.inertia = 1.0});
    m.add<GroundSpring>(std::string("k_") + name, {name}, {.stiffness = k});
  }
  m.add<problems::Circulatory>("seal", {"x", "y"}, {.coupling = s_c});
  m.set_initial("x", 0.01, 0.0);
  const System s = m.build();
  CHECK(!s.symmetric_tangent());
  const std::complex<double> omega = std::sqrt(std::complex<double>(k, -s_c));
  const auto exact = [&](double t) { return (0.01 * std::cos(omega * t)).imag(); };
  const double e_1 = worst_error(s, "y.angle_rad", 5e-3, 2.0, exact);
  const double e_2 = worst_error(s, "y.angle_rad", 2.5e-3, 2.0, exact);
  CHECK(e_2 < 1e-4);
  CHECK(std::log2(e_1 / e_2) == Approx(2.0).margin(0.1));

  SECTION("statics: (k - i s) z = 1") {
    Model loaded = m;
    loaded.add<AppliedTorque>("load", {"x"}, {.torque = [](double) { return 1.0; }});
    const System still = loaded.build();
    const StaticResult result = solve_static(still);
    const std::complex<double> z = 1.0 / std::complex<double>(k, -s_c);
    CHECK(result.state.z[0] == Approx(z.real()));
    CHECK(result.state.z[1] == Approx(z.imag()));
  }
}

TEST_CASE("History is part of the state: a copy is a checkpoint") {
  Model m("friction");
  m.add_node("disc");
  m.add<Inertia>("disc", {"disc"}, {.inertia = 1.0});
  m.add<problems::Jenkins>("clutch", {"disc"}, {.stiffness = 100.0, .slip = 2.0});
  m.set_initial("disc", 0.0, 1.0);
  const System s = m.build();
  State state = State::initial(s);
  simulate(s, {.step = 1e-3, .t_end = 0.3, .energy_tolerance = 1e9}, state);
  const State checkpoint = state;
  CHECK(state.history[0] > 0.05);  // it has slipped
  simulate(s, {.step = 1e-3, .t_start = 0.3, .t_end = 0.6, .energy_tolerance = 1e9}, state);
  State again = checkpoint;
  simulate(s, {.step = 1e-3, .t_start = 0.3, .t_end = 0.6, .energy_tolerance = 1e9}, again);
  CHECK(again.z == state.z);
  CHECK(again.history == state.history);
}

TEST_CASE("check_element() passes sound general elements") {
  CHECK(check_element(problems::Circulatory({.coupling = 3.0}), 2).text() == "");
}
