// Covers solvers/periodic/sweep_peaks.hpp: what loads and couplings that follow the speed do between the speeds of a sweep to modes,
// criticals and peaks, against closed forms of one degree of freedom.
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/periodic/linear_sweep.hpp>

#include <algorithm>
#include <cmath>
#include <complex>

#include "tests/catch.hpp"

using namespace drev;

namespace {

using Lambda = std::complex<double>;

std::vector<double> speeds_by(double first, double step, double last) {
  std::vector<double> speeds;
  for (double here = first; here <= last; here += step) speeds.push_back(rpm(here));
  return speeds;
}

/// A disc of 1 kg m2 on a shaft from a node at constant speed, with an order of 1 N m and a torque that follows its speed.
System disc_on_shaft(double stiffness, double damping, double order, const TorqueCurve::Params& curve) {
  Model m("disc");
  m.add_node("a"), m.add_node("b");
  m.constant_speed("a", rpm(525.0));
  m.add<Inertia>("J", {"b"}, {.inertia = 1.0});
  m.add<ShaftSpring>("s", {"a", "b"}, {.stiffness = stiffness, .damping = damping});
  m.add<TorqueCurve>("p", {"b"}, curve);
  m.add<EngineOrderTorque>("gas", {"b"}, {.harmonics = {{order, 1.0, 0.0}}, .twist_feedback = false});
  return m.build();
}

}  // namespace

TEST_CASE("Damping that loads have at some speeds only counts for the modes and criticals there",
          "[sweep_kinks]") {
  // A disc of 1 kg m2 on 755 N m/rad: natural frequency 524.8 rpm at order 0.5, where only the curve between 500 and 550 rpm damps.
  constexpr double k = 755.0, damping = 0.1;
  const System disc = disc_on_shaft(
      k, damping, 0.5,
      {.speeds = {0.0, rpm(502.0), rpm(552.0), rpm(1200.0)}, .torques = {0.0, 0.0, -100.0, -100.0}});
  const LinearSweep sweep = sweep_linear(disc, {.speeds = speeds_by(100.0, 50.0, 1100.0), .orders = {0.5}});
  const double natural = std::sqrt(k), ratio = 0.5 * (damping + 100.0 / rpm(50.0)) / natural;
  double largest = 0.0;
  for (const Lambda lambda : sweep.modes.lambda.row(0))
    largest = std::max(largest, -lambda.real() / std::abs(lambda));
  CHECK(largest == Approx(ratio).epsilon(1e-9));
  REQUIRE(sweep.criticals.size() == 1);
  CHECK(sweep.criticals[0].damping_ratio == Approx(ratio).epsilon(1e-9));
  CHECK(2.0 * kPi * sweep.criticals[0].frequency_Hz ==
        Approx(natural * std::sqrt(1.0 - ratio * ratio)).epsilon(1e-9));
  // |k + i c w| p / (2 |Re lambda| Im lambda) at the pole, not a hundred times as much.
  CHECK(sweep.criticals[0].own_amplitude < 2.0);
}

TEST_CASE("A load that damps, or feeds a mode, between two speeds of the sweep alone counts there",
          "[sweep_kinks]") {
  // As above, with kinks at the sweep's own speeds: slopes of -100 N m and back over 50 rpm, between which all speeds show none.
  constexpr double k = 755.0, damping = 0.1;
  const double slope = 100.0 / rpm(50.0), natural = std::sqrt(k);
  const System disc =
      disc_on_shaft(k, damping, 0.5,
                    {.speeds = {0.0, rpm(500.0), rpm(550.0), rpm(900.0), rpm(950.0), rpm(1200.0)},
                     .torques = {0.0, 0.0, -100.0, -100.0, 0.0, 0.0}});
  for (const double step : {50.0, 500.0}) {
    const LinearSweep sweep = sweep_linear(disc, {.speeds = speeds_by(100.0, step, 1100.0), .orders = {0.5}});
    const double ratio = 0.5 * (damping + slope) / natural;
    REQUIRE(sweep.criticals.size() == 1);
    CHECK(sweep.criticals[0].damping_ratio == Approx(ratio).epsilon(1e-9));
    CHECK(sweep.growth.rate == Approx(0.5 * (slope - damping)).epsilon(1e-9));
    CHECK(to_rpm(sweep.growth_speed) == Approx(925.0).margin(26.0));
  }
}

TEST_CASE("Modes and criticals have the stiffness and loss of a coupling under the mean torque at each speed",
          "[sweep_kinks]") {
  // A disc of 1 kg m2 that a torque of 0.5 N m s times its speed brakes: J lambda^2 + (c + eta k / w) lambda + k = 0, w = Im lambda,
  // with k and eta at that torque; w by iteration. With a loss its branches, at lambda in place of i w, add some eta^2 / 4.
  constexpr double c = 0.5, order = 2.0;
  for (const double loss : {0.0, 0.1}) {
    Model m("disc");
    m.add_node("a"), m.add_node("b");
    m.constant_speed("a", rpm(500.0));
    m.add<Inertia>("J", {"b"}, {.inertia = 1.0});
    m.add<ElasticCoupling>(
        "coupling", {"a", "b"},
        {.material = {
             .by_mean_torque = {{0.0, 20.0, 60.0}, {1000.0, 2000.0, 9000.0}, {2.0 * loss, loss, 0.5 * loss}},
             .at_mean_torque = 10.0,
             .lowest_frequency = 3.0,
             .highest_frequency = 20.0,
             .permitted_error = 0.5}});
    m.add<TorqueCurve>("p", {"b"}, {.speeds = {0.0, 1000.0}, .torques = {0.0, -1000.0 * c}});
    m.add<EngineOrderTorque>("gas", {"b"}, {.harmonics = {{order, 1.0, 0.0}}, .twist_feedback = false});
    const auto closed = [&](double speed) {
      const double torque = c * speed, part = torque < 20.0 ? torque / 20.0 : torque / 40.0 - 0.5;
      const double k = torque < 20.0 ? 1000.0 + 1000.0 * part : 2000.0 + 7000.0 * part,
                   eta = loss * (torque < 20.0 ? 2.0 - part : 1.0 - 0.5 * part);
      double w = std::sqrt(k), decay = 0.0;
      for (int i = 0; i < 100; ++i) {
        decay = 0.5 * (c + eta * k / w);
        w = std::sqrt(k - decay * decay);
      }
      return Lambda(-decay, w);
    };
    const LinearSweep sweep =
        sweep_linear(m.build(), {.speeds = speeds_by(100.0, 50.0, 1100.0), .orders = {order}});
    REQUIRE(sweep.modes.speeds.size() > 9);
    for (Eigen::Index i = 0; i < sweep.modes.speeds.size(); ++i) {
      const Lambda expected = closed(sweep.modes.speeds[i]);
      double off = 1.0;  // the coupling's own modes are far off
      for (const Lambda lambda : sweep.modes.lambda.col(i))
        off = std::min(off, std::abs(lambda - expected) / std::abs(expected));
      CHECK(off < (loss > 0.0 ? 0.01 : 1e-10));
    }
    double low = rpm(100.0), high = rpm(1100.0);
    while (high - low > 1e-9)
      (order * (0.5 * (low + high)) < closed(0.5 * (low + high)).imag() ? low : high) = 0.5 * (low + high);
    const Lambda lambda = closed(low);
    REQUIRE(sweep.criticals.size() == 1);
    CHECK(2.0 * kPi * sweep.criticals[0].frequency_Hz ==
          Approx(lambda.imag()).epsilon(loss > 0.0 ? 0.01 : 1e-9));
    CHECK(sweep.criticals[0].damping_ratio ==
          Approx(-lambda.real() / std::abs(lambda)).epsilon(loss > 0.0 ? 0.02 : 1e-9));
    CHECK(sweep.criticals[0].speed == Approx(low).epsilon(0.02));
  }
}

TEST_CASE("A response that jumps where a gate's ramp begins has its peak at the larger side",
          "[sweep_kinks]") {
  // A disc of 1 kg m2 that damps by its shaft alone up to 1000 rpm, and from there on is fed by a torque that rises with the speed:
  // |T| = |k + i c w| p / |k - w^2 + i (c - d) w| at the kink's upper side.
  constexpr double k = 10000.0, c = 20.0, torque = 100.0;
  const double d = torque / rpm(100.0), w = rpm(1000.0);
  const System disc = disc_on_shaft(
      k, c, 1.0,
      {.speeds = {0.0, rpm(1000.0), rpm(1100.0), rpm(2000.0)}, .torques = {0.0, 0.0, torque, torque}});
  const double peak = std::hypot(k, c * w) / std::hypot(k - w * w, (c - d) * w);
  for (const double first : {800.0, 850.0}) {  // 1000 rpm is one of the speeds, or none
    const LinearSweep sweep =
        sweep_linear(disc, {.speeds = speeds_by(first, 100.0, 1300.0), .orders = {1.0}});
    const SweepLargest largest = largest_half_range(sweep, 0);
    CHECK(largest.value == Approx(peak).epsilon(1e-6));
    CHECK(to_rpm(largest.speed) == Approx(1000.0).epsilon(1e-6));
  }
}

TEST_CASE("A mode that dips below an order between two speeds has both criticals", "[sweep_kinks]") {
  // The mean torque passes zero at 1450 rpm and with it the stiffness its least, k = 10000 + 20000 |T| / 100 with T = 1.2 N m a rpm
  // from there: of two discs of 1 kg m2, half of the torque goes through the coupling.
  Model m("two discs");
  m.add_node("a"), m.add_node("b");
  m.set_reference("a", constant_speed(rpm(1000.0)));
  m.add<Inertia>("J_a", {"a"}, {.inertia = 1.0});
  m.add<Inertia>("J_b", {"b"}, {.inertia = 1.0});
  m.add<ElasticCoupling>(
      "c", {"a", "b"},
      {.material = {.by_mean_torque = {{0.0, 100.0}, {10000.0, 30000.0}, {0.0, 0.0}}}, .damping = 1.0});
  m.add<EngineOrderTorque>("gas", {"a"}, {.harmonics = {{1.0, 1.0, 0.0}}, .twist_feedback = false});
  m.add<TorqueCurve>("p", {"b"}, {.speeds = {rpm(1400.0), rpm(1500.0)}, .torques = {-60.0, 60.0}});
  const LinearSweep sweep =
      sweep_linear(m.build(), {.speeds = speeds_by(200.0, 100.0, 1500.0), .orders = {1.0}});
  // w^2 = 2 k at both, to the damping's second order.
  const auto beyond = [](double speed) {
    const double k = 10000.0 + 200.0 * 0.6 * std::abs(speed - 1450.0);
    return rpm(speed) * rpm(speed) - 2.0 * k;
  };
  REQUIRE(sweep.criticals.size() == 2);
  for (const bool upper : {false, true}) {
    double inside = 1450.0, outside = upper ? 1500.0 : 1400.0;
    for (int step = 0; step < 60; ++step) {
      const double middle = 0.5 * (inside + outside);
      (beyond(middle) > 0.0 ? inside : outside) = middle;
    }
    CHECK(60.0 * sweep.criticals[upper ? 1 : 0].frequency_Hz == Approx(inside).epsilon(1e-3));
  }
}

TEST_CASE("Modes that pass each other between the torque of the matrices and the mean torque stay two",
          "[sweep_kinks]") {
  // Discs of 0.5, 10 and 0.5 kg m2 on stiffnesses that are the same without torque; under 100 N m the first is three times as stiff.
  Model m("three discs");
  for (const char* node : {"a", "b", "c"}) m.add_node(node);
  m.set_reference("a", constant_speed(rpm(1000.0)));
  m.add<Inertia>("J_a", {"a"}, {.inertia = 0.5});
  m.add<Inertia>("J_b", {"b"}, {.inertia = 10.0});
  m.add<Inertia>("J_c", {"c"}, {.inertia = 0.5});
  m.add<ElasticCoupling>("s0", {"a", "b"},
                         {.material = {.by_mean_torque = {{0.0, 100.0}, {1000.0, 3000.0}, {0.0, 0.0}}}});
  m.add<ShaftSpring>("s1", {"b", "c"}, {.stiffness = 1000.0});
  m.add<EngineOrderTorque>("gas", {"a"},
                           {.harmonics = {{1.0, 10.0, 0.0}}, .mean = 100.0, .twist_feedback = false});
  const LinearSweep sweep =
      sweep_linear(m.build(), {.speeds = speeds_by(200.0, 100.0, 2000.0), .orders = {1.0}, .balance = "b"});
  // w^4 - p w^2 + q = 0 with p the trace of K / M, q = k0 k1 (sum of inertias) / (product of inertias).
  const double k0 = 3000.0, k1 = 1000.0, p = 2.1 * (k0 + k1), q = 4.4 * k0 * k1;
  const double root = std::sqrt(p * p - 4.0 * q);
  REQUIRE(sweep.modes.lambda.rows() == 2);
  CHECK(sweep.modes.lambda(0, 0).imag() == Approx(std::sqrt(0.5 * (p - root))).epsilon(1e-9));
  CHECK(sweep.modes.lambda(1, 0).imag() == Approx(std::sqrt(0.5 * (p + root))).epsilon(1e-9));
}
