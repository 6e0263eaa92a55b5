// Covers solvers/periodic/sweep_peaks.hpp: what is located between the speeds beside the half range, undamped resonances,
// and the section of a critical, against closed forms of one and two degrees of freedom.
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/periodic/linear_sweep.hpp>

#include <algorithm>
#include <cmath>
#include <complex>

#include "core/dense/eigenvalues.hpp"
#include "core/dense/factorization.hpp"
#include "tests/catch.hpp"

using namespace drev;

namespace {

using Complex = std::complex<double>;

const std::vector<Harmonic> three_orders = {
    {1.0, 50.0, deg(10.0)}, {2.0, 40.0, deg(50.0)}, {3.0, 30.0, deg(100.0)}};

/// Discs of 2 and 3 kg m2 on a shaft of 10 kN m/rad: free, with torques on the first, such as orders 1, 2 and 3 of 50, 40 and
/// 30 N m.
System two_discs(double damping, const std::vector<Harmonic>& harmonics = three_orders) {
  Model m("two discs");
  m.add_node("a");
  m.add_node("b");
  m.set_reference("a", constant_speed(rpm(600.0)));
  m.add<Inertia>("J_a", {"a"}, {.inertia = 2.0});
  m.add<Inertia>("J_b", {"b"}, {.inertia = 3.0});
  m.add<ShaftSpring>("s", {"a", "b"}, {.stiffness = 1e4, .damping = damping});
  m.add<EngineOrderTorque>("gas", {"a"}, {.harmonics = harmonics, .mean = 100.0, .twist_feedback = false});
  m.add<EngineOrderTorque>("load", {"b"}, {.mean = -100.0, .twist_feedback = false});
  return m.build();
}

std::vector<double> rpm_speeds(double first, double step, double last) {
  std::vector<double> speeds;
  for (double here = first; here <= last; here += step) speeds.push_back(rpm(here));
  return speeds;
}

}  // namespace

TEST_CASE("Twist, heat and extremes are taken at the peaks between the speeds", "[sweep_peaks]") {
  const LinearSweep coarse =
      sweep_linear(two_discs(5.0), {.speeds = rpm_speeds(300.0, 100.0, 1500.0), .orders = {1.0, 2.0, 3.0}});
  // mu x'' + c x' + k x = mu/J_a p, mu = 1.2: maxima of its sums by a separate program.
  const SweepLargest half = largest_half_range(coarse, 0), twist = largest_twist(coarse, 0),
                     heat = largest_heat(coarse, 0);
  CHECK(half.value == Approx(656.0853417).epsilon(1e-8));
  CHECK(to_rpm(half.speed) == Approx(871.2029223).epsilon(1e-6));
  CHECK(twist.value == Approx(0.0655419845).epsilon(1e-6));
  CHECK(heat.value == Approx(90.06277346).epsilon(1e-9));
  CHECK(to_rpm(heat.speed) == Approx(871.7270173).epsilon(1e-6));
  // The grid alone has less than six tenths of the twist and about a third of the heat.
  CHECK(coarse.sections[0].twist_half_range.maxCoeff() == Approx(0.0372062).epsilon(1e-5));
  CHECK(coarse.sections[0].heat.maxCoeff() == Approx(30.4965).epsilon(1e-5));
  const SweepPeak& peak = coarse.peaks.front();
  CHECK(peak.heat == Approx(90.00031947).epsilon(1e-6));
  CHECK(std::abs(peak.mean) == Approx(100.0).epsilon(1e-9));
  CHECK(0.5 * (peak.maximum - peak.minimum) == Approx(peak.half_range).epsilon(1e-12));
}

TEST_CASE("The largest heat is that of the highest top, not of the highest point, and may be beside an end",
          "[sweep_peaks]") {
  // Heat c W^2 |x|^2 / 2 of mu x'' + c x' + k x = mu/J_a p over the orders.
  constexpr double k = 1e4, mu = 1.2;
  const double natural = std::sqrt(k / mu);
  const auto heat_of_order = [&](double c, double W, double p) {
    return 0.5 * c * W * W * std::norm(mu / 2.0 * p / Complex(k - mu * W * W, c * W));
  };
  // A speed of the sweep is at the top of order 4; all points about the higher one of order 1 are lower.
  const double c = 0.6 * std::sqrt(k * mu), first = 48.5, fourth = 48.0;
  double best = 0.0, at = 0.0;
  for (double w = 80.0; w < 100.0; w += 1e-3) {
    const double heat = heat_of_order(c, w, first) + heat_of_order(c, 4.0 * w, fourth);
    if (heat > best) best = heat, at = w;
  }
  const LinearSweep two = sweep_linear(two_discs(c, {{1.0, first, 0.0}, {4.0, fourth, 0.0}}),
                                       {.speeds = {10.0, natural / 4.0, 45.0, 130.0}, .orders = {1.0, 4.0}});
  CHECK(two.sections[0].heat_peak == Approx(best).epsilon(1e-9));
  CHECK(two.sections[0].heat_peak_speed == Approx(at).margin(2e-3));
  // Overdamped: no order has a resonance, and the top p'^2 / (2 c) at the natural frequency is between the last two speeds,
  // of which the last has the more heat.
  const double strong = 2.0 * std::sqrt(k * mu), force = mu / 2.0 * 50.0;
  const LinearSweep end = sweep_linear(two_discs(strong, {{1.0, 50.0, 0.0}}),
                                       {.speeds = {30.0, 60.0, natural + 3.0}, .orders = {1.0}});
  CHECK(end.sections[0].heat_peak == Approx(0.5 * force * force / strong).epsilon(1e-10));
  CHECK(end.sections[0].heat_peak_speed == Approx(natural).epsilon(1e-6));
}

TEST_CASE("A top of the half range beside an end of the speeds is followed", "[sweep_peaks]") {
  // Torque k* p' / (k* - mu w^2) with k* = k + i c w of an overdamped shaft: its top is at no natural frequency.
  constexpr double k = 1e4, mu = 1.2;
  const double c = 2.0 * std::sqrt(k * mu);
  const auto torque = [&](double w) {
    const Complex z(k, c * w);
    return std::abs(mu / 2.0 * 50.0 * z / (z - mu * w * w));
  };
  double best = 0.0, at = 0.0;
  for (double w = 10.0; w < 200.0; w += 1e-3)
    if (torque(w) > best) best = torque(w), at = w;
  for (const std::vector<double>& speeds : {std::vector<double>{0.95 * at, 3.0 * at, 4.0 * at},
                                            std::vector<double>{0.1 * at, 0.2 * at, 1.05 * at}}) {
    const LinearSweep sweep =
        sweep_linear(two_discs(c, {{1.0, 50.0, 0.0}}), {.speeds = speeds, .orders = {1.0}});
    CHECK(largest_half_range(sweep, 0).value == Approx(best).epsilon(1e-9));
    CHECK(largest_half_range(sweep, 0).speed == Approx(at).margin(2e-3));
    REQUIRE(sweep.peaks.size() == 1);
    CHECK_FALSE(sweep.peaks.front().at_end);
  }
  // Past the top the curve falls throughout: its largest value is at the first speed.
  const LinearSweep past = sweep_linear(two_discs(c, {{1.0, 50.0, 0.0}}),
                                        {.speeds = {1.5 * at, 3.0 * at, 4.0 * at}, .orders = {1.0}});
  REQUIRE(past.peaks.size() == 1);
  CHECK(past.peaks.front().at_end);
  CHECK(past.peaks.front().half_range == Approx(torque(1.5 * at)).epsilon(1e-12));
}

TEST_CASE("Peaks and heat of modes that coincide are located", "[sweep_peaks]") {
  // Six equal branches on a hub, with torques that add up to nothing: the hub stands still, each branch is one of its own.
  constexpr int branches = 6;
  constexpr double k = 2e4, J = 0.5, p = 100.0;
  const double c = 0.2 * 2.0 * std::sqrt(k * J);
  Model m("star");
  m.add_node("hub");
  m.set_reference("hub", constant_speed(rpm(1000.0)));
  m.add<Inertia>("J_hub", {"hub"}, {.inertia = 0.2});
  for (int b = 0; b < branches; ++b) {
    const std::string n = std::to_string(b), node = "b" + n;
    m.add_node(node);
    m.add<Inertia>("J" + n, {node}, {.inertia = J});
    m.add<ShaftSpring>("k" + n, {"hub", node}, {.stiffness = k, .damping = c});
    m.add<EngineOrderTorque>("t" + n, {node},
                             {.harmonics = {{1.0, p, deg(60.0 * b)}}, .twist_feedback = false});
  }
  const auto torque = [&](double w) {
    const Complex z(k, c * w);
    return std::abs(z * p / (z - J * w * w));
  };
  double best = 0.0, at = 0.0;
  for (double w = 180.0; w < 210.0; w += 1e-3)
    if (torque(w) > best) best = torque(w), at = w;
  const LinearSweep sweep =
      sweep_linear(m.build(), {.speeds = rpm_speeds(100.0, 100.0, 3000.0), .orders = {1.0}});
  for (int b = 0; b < branches; ++b) {
    const SweepLargest half = largest_half_range(sweep, b);
    CHECK(half.value == Approx(best).epsilon(1e-9));
    CHECK(half.speed == Approx(at).margin(2e-3));
    CHECK(largest_heat(sweep, b).value == Approx(0.5 * p * p / c).epsilon(1e-10));
  }
}

TEST_CASE("An order that meets an undamped mode is an infinite peak at their speed", "[sweep_peaks]") {
  const LinearSweep sweep =
      sweep_linear(two_discs(0.0), {.speeds = rpm_speeds(300.0, 100.0, 1500.0), .orders = {1.0, 2.0, 3.0}});
  const double natural = std::sqrt(1e4 / 1.2);
  int infinite = 0;
  for (const SweepPeak& peak : sweep.peaks) {
    // 1e9 N m would be the rounding of a frequency.
    if (std::isfinite(peak.half_range)) CHECK(peak.half_range < 1e4);
    if (std::isfinite(peak.half_range)) continue;
    ++infinite;
    const bool first = std::abs(peak.speed - natural) < 1e-9 * natural;
    CHECK((first || peak.speed == Approx(0.5 * natural).epsilon(1e-9)));
  }
  CHECK(infinite == 2);
  CHECK(std::isinf(largest_half_range(sweep, 0).value));
  CHECK(std::isinf(largest_twist(sweep, 0).value));
  REQUIRE(sweep.criticals.size() == 2);
  for (const SweepCritical& critical : sweep.criticals) {
    CHECK(critical.damping_ratio == 0.0);
    CHECK_FALSE(std::signbit(critical.damping_ratio));
  }
}

TEST_CASE("An undamped mode that the loads do not excite is no resonance", "[sweep_peaks]") {
  // Three equal discs with equal torques on the outer ones and a damper on the middle one: the mode at w^2 = k/J moves the
  // outer discs against each other. The others move alike: (k - J w^2) a - k b = p, (2 k - J w^2 + i c w) b - 2 k a = 0.
  constexpr double torque = 10.0, damping = 10.0;
  for (const double natural : {20.0 * kPi, 50.0, 1e3 / 3.0}) {
    const double k = natural * natural;
    Model m("symmetric");
    for (const char* node : {"a", "b", "c"}) m.add_node(node);
    m.set_reference("a", constant_speed(natural));
    for (const char* node : {"a", "b", "c"})
      m.add<Inertia>(std::string("J_") + node, {node}, {.inertia = 1.0});
    m.add<ShaftSpring>("k1", {"a", "b"}, {.stiffness = k});
    m.add<ShaftSpring>("k2", {"b", "c"}, {.stiffness = k});
    m.add<AbsoluteDamper>("d", {"b"}, {.damping = damping});
    for (const char* node : {"a", "c"})
      m.add<EngineOrderTorque>(std::string("p_") + node, {node},
                               {.harmonics = {{1.0, torque, 0.0}}, .twist_feedback = false});
    const System system = m.build();
    const Complex b = -torque / k, a = b * (k + Complex(0.0, damping * natural)) / (2.0 * k);
    for (const std::vector<double>& speeds :
         {std::vector{natural}, std::vector{0.5 * natural, natural, 1.5 * natural},
          std::vector{0.999 * natural, 1.001 * natural}}) {
      INFO(natural << " rad/s, " << speeds.size() << " speeds");
      const LinearSweep sweep = sweep_linear(system, {.speeds = speeds, .orders = {1.0}});
      for (const SweepPeak& peak : sweep.peaks) CHECK(std::isfinite(peak.half_range));
      REQUIRE(sweep.criticals.size() == 1);
      const SweepCritical& critical = sweep.criticals.front();
      CHECK(critical.speed == Approx(natural).epsilon(1e-9));
      CHECK(critical.half_range == Approx(k * std::abs(a - b)).epsilon(1e-6));
      CHECK(critical.own_amplitude == 0.0);
      if (speeds.size() == 2) continue;
      const auto at = static_cast<Eigen::Index>(speeds.size() / 2);
      CHECK(std::abs(sweep.sections[0].amplitude(0, at)) == Approx(k * std::abs(a - b)).epsilon(1e-6));
      CHECK(sweep.sections[2].heat[at] == Approx(0.5 * damping * std::norm(natural * b)).epsilon(1e-6));
    }
  }
}

TEST_CASE("A critical at the first or only speed is found, and each of several undamped ones is a peak",
          "[sweep_peaks]") {
  const double natural = std::sqrt(1e4 / 1.2);
  for (const std::vector<double>& speeds :
       {std::vector{natural}, std::vector{natural, 2.0 * natural}, std::vector{0.4 * natural, natural}}) {
    const LinearSweep sweep = sweep_linear(two_discs(0.0), {.speeds = speeds, .orders = {1.0, 3.0}});
    CHECK(sweep.criticals.size() == 1);
    CHECK(std::isinf(largest_half_range(sweep, 0).value));
  }
  const LinearSweep wide =
      sweep_linear(two_discs(0.0), {.speeds = {0.3 * natural, 2.0 * natural}, .orders = {1.0, 2.0, 3.0}});
  CHECK(std::count_if(wide.peaks.begin(), wide.peaks.end(), [](const SweepPeak& peak) {
          return peak.section == 0 && std::isinf(peak.half_range);
        }) == 3);
}

TEST_CASE("A critical is in the section that its mode moves, not in the one with the quasi-static torque",
          "[sweep_peaks]") {
  // Clock, soft coupling, engine of two discs on a stiff crank. Opposite torques on the discs twist the crank; a part of
  // them is left for the coupling.
  constexpr double soft = 9e3, stiff = 1.2e6, beta = 1.2e-3, first = 1.5, second = 0.4, torque = 800.0,
                   rest = 8.0, order = 1.5;
  Model m("engine on a soft coupling");
  for (const char* node : {"clock", "a", "b"}) m.add_node(node);
  m.constant_speed("clock", 150.0);
  m.add<ShaftSpring>("coupling", {"clock", "a"}, {.stiffness = soft, .damping = beta * soft});
  m.add<ShaftSpring>("crank", {"a", "b"}, {.stiffness = stiff, .damping = beta * stiff});
  m.add<Inertia>("J_a", {"a"}, {.inertia = first});
  m.add<Inertia>("J_b", {"b"}, {.inertia = second});
  m.add<EngineOrderTorque>("gas_a", {"a"}, {.harmonics = {{order, torque, 0.0}}, .twist_feedback = false});
  m.add<EngineOrderTorque>("gas_b", {"b"},
                           {.harmonics = {{order, torque - rest, kPi}}, .twist_feedback = false});
  std::vector<double> speeds;
  for (double speed = 30.0; speed <= 100.0; speed += 5.0) speeds.push_back(speed);
  const LinearSweep sweep = sweep_linear(m.build(), {.speeds = speeds, .orders = {order}});
  REQUIRE(sweep.criticals.size() == 1);
  const SweepCritical& critical = sweep.criticals.front();
  const auto number = static_cast<std::size_t>(critical.section);
  CHECK(sweep.sections[number].name == "coupling.torque_Nm");
  // The order is far larger in the crank.
  CHECK(critical.amplitude < 0.2 * torque);

  // The two unknowns solved by Cramer's rule: torque of the coupling at a speed.
  const auto amplitude = [&](double speed) {
    const Complex s(0.0, order * speed), damped = 1.0 + beta * s, k1 = soft * damped, k2 = stiff * damped;
    const Complex a11 = k1 + k2 + first * s * s, a22 = k2 + second * s * s;
    return std::abs(k1 * (torque * a22 - (torque - rest) * k2) / (a11 * a22 - k2 * k2));
  };
  double best = 0.0, at = 0.0;
  for (double speed = 45.0; speed < 65.0; speed += 1e-4)
    if (amplitude(speed) > best) best = amplitude(speed), at = speed;
  CHECK(critical.speed == Approx(at).margin(2e-4));
  CHECK(critical.amplitude == Approx(best).epsilon(1e-6));
  CHECK(critical.in_sections[number].speed == critical.speed);

  // The mode's residue: C = beta K, so that mode n of the undamped train with omega has lambda^2 + beta omega^2 lambda +
  // omega^2 = 0, and phi phi' p / (lambda - conj lambda) at the pole.
  const Eigen::MatrixXd mass{{first, 0.0}, {0.0, second}}, stiffness{{soft + stiff, -stiff}, {-stiff, stiff}};
  const SymmetricEigen modes = symmetric_eigen(stiffness, mass);
  const double omega = std::sqrt(modes.values[0]), decay = 0.5 * beta * omega * omega,
               damped = std::sqrt(omega * omega - decay * decay);
  const Eigen::Vector2d phi = modes.vectors.col(0);
  const double force = phi.dot(Eigen::Vector2d(torque, -(torque - rest)));
  const double own =
      std::abs(soft * (1.0 + beta * Complex(0.0, damped)) * phi[0] * force / (2.0 * damped)) / decay;
  const double ratio = decay / omega;
  CHECK(critical.damping_ratio == Approx(ratio).epsilon(1e-9));
  CHECK(critical.own_amplitude == Approx(own).epsilon(1e-9));
  // In the crank the mode's part is below a tenth of the quasi-static torque: it has no speed of its own.
  CHECK(critical.in_sections[1 - number].speed == Approx(damped / order).epsilon(1e-6));
}

TEST_CASE("A mode's own part is its residue, whatever modes lie near", "[sweep_peaks]") {
  // Two trains of two and three discs, order 1 on the first: x' p / x' (2 lambda M + C) x of the companion matrix' modes.
  const std::vector<std::vector<double>> inertia{{2.0, 2.0}, {0.5, 0.5, 2.0}};
  const std::vector<double> spring{100.0, 100.0, 300.0}, damper{0.4, 0.5, 0.5};
  constexpr double kTorque = 10.0;
  for (const double tie : {0.0, 1.0, 20.0})  // between the trains
    for (const double forwards : {1.0, -1.0})
      for (const double scale : {0.41, 0.42, 0.45, 0.7}) {  // of the second train's springs
        INFO("tie " << tie << ", " << forwards << ", springs " << scale);
        Model m("trains");
        for (const char* node : {"a0", "a1", "b0", "b1", "b2"}) m.add_node(node);
        m.set_reference("a0", constant_speed(forwards * 10.0));
        Eigen::MatrixXd M = Eigen::MatrixXd::Zero(5, 5), C = M, K = M;
        const std::vector<const char*> nodes{"a0", "a1", "b0", "b1", "b2"};
        const auto shaft = [&](const std::string& name, int i, int j, double k, double c) {
          const auto at = [&](int n) { return nodes[static_cast<std::size_t>(n)]; };
          m.add<ShaftSpring>(name, {at(i), at(j)}, {.stiffness = k, .damping = c});
          Vector b = Vector::Zero(5);
          b[i] = -1.0, b[j] = 1.0;
          K += k * b * b.transpose(), C += c * b * b.transpose();
        };
        int n = 0;
        for (const std::vector<double>& train : inertia)
          for (const double J : train) {
            m.add<Inertia>("J" + std::to_string(n), {nodes[static_cast<std::size_t>(n)]}, {.inertia = J});
            M(n, n) = J, ++n;
          }
        shaft("sa", 0, 1, spring[0], damper[0]);
        shaft("sb", 2, 3, scale * spring[1], damper[1]);
        shaft("sc", 3, 4, scale * spring[2], damper[2]);
        if (tie > 0.0) shaft("tie", 1, 2, tie, 0.05);
        m.add<EngineOrderTorque>("load", {"a0"},
                                 {.harmonics = {{1.0, kTorque, 0.3}}, .twist_feedback = false});
        const LinearSweep sweep = sweep_linear(m.build(), {.speeds = {1.0, 10.0, 40.0}, .orders = {1.0}});
        Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(10, 10);
        companion.topRightCorner(5, 5).setIdentity();
        companion.bottomLeftCorner(5, 5) = -lu_solve(M, K);
        companion.bottomRightCorner(5, 5) = -lu_solve(M, C);
        const GeneralEigen modes = general_eigen(companion);
        CHECK(sweep.criticals.size() >= 3);
        for (const SweepCritical& critical : sweep.criticals) {
          Eigen::Index nearest = 0;
          (modes.values.array().imag() - 2.0 * kPi * critical.frequency_Hz).abs().minCoeff(&nearest);
          const Complex lambda = modes.values[nearest], iw(0.0, lambda.imag());
          const Eigen::VectorXcd x = modes.vectors.col(nearest).head(5);
          const Complex per = (x.transpose() * (2.0 * lambda * M + C) * x)(0, 0);
          const Eigen::VectorXcd z = x * (x[0] * kTorque / per / std::abs(lambda.real()));
          double most = std::abs((spring[0] + iw * damper[0]) * (z[1] - z[0]));
          most = std::max(most, std::abs((scale * spring[1] + iw * damper[1]) * (z[3] - z[2])));
          most = std::max(most, std::abs((scale * spring[2] + iw * damper[2]) * (z[4] - z[3])));
          if (tie > 0.0) most = std::max(most, std::abs((tie + iw * 0.05) * (z[2] - z[1])));
          INFO(critical.frequency_Hz << " Hz");
          CHECK(critical.own_amplitude == Approx(most).epsilon(1e-9).margin(1e-9));
        }
      }
}

TEST_CASE("Peaks of a mode that grows are found in every section, and are those of one that decays as fast",
          "[sweep_peaks]") {
  const auto swept = [](double slope) {
    Model m("three discs");
    for (const char* node : {"a", "b", "c"}) m.add_node(node);
    m.set_reference("a", constant_speed(rpm(1000.0)));
    m.add<Inertia>("J_a", {"a"}, {.inertia = 0.5});
    m.add<Inertia>("J_b", {"b"}, {.inertia = 0.5});
    m.add<Inertia>("J_c", {"c"}, {.inertia = 2.0});
    m.add<ShaftSpring>("s0", {"a", "b"}, {.stiffness = 1000.0});
    m.add<ShaftSpring>("s1", {"b", "c"}, {.stiffness = 20000.0});
    m.add<EngineOrderTorque>("gas", {"c"}, {.harmonics = {{2.0, 100.0, 0.0}}, .twist_feedback = false});
    m.add<TorqueCurve>("p", {"c"}, {.speeds = {0.0, 1000.0}, .torques = {0.0, 1000.0 * slope}});
    return sweep_linear(m.build(), {.speeds = rpm_speeds(300.0, 300.0, 1500.0), .orders = {2.0}});
  };
  const LinearSweep grows = swept(10.0), decays = swept(-10.0);
  CHECK(grows.growth.rate > 0.0);
  for (int section = 0; section < 2; ++section) {
    const SweepLargest here = largest_half_range(grows, section), there = largest_half_range(decays, section);
    CHECK(here.value == Approx(there.value).epsilon(1e-9));
    CHECK(to_rpm(here.speed) == Approx(1085.36).epsilon(1e-4));
  }
  REQUIRE(grows.criticals.size() == decays.criticals.size());
  CHECK(grows.criticals[0].damping_ratio == Approx(-decays.criticals[0].damping_ratio).epsilon(1e-6));
  CHECK(grows.criticals[0].own_amplitude == Approx(decays.criticals[0].own_amplitude).epsilon(1e-6));
}

TEST_CASE("Loads that cancel but for rounding excite no undamped mode", "[sweep_peaks]") {
  // Orders of three cylinders at 0, 120 and 240 degrees on one node; order 1, which is left, does not meet the mode.
  Model m("two discs");
  m.add_node("a"), m.add_node("b");
  m.set_reference("a", constant_speed(rpm(1000.0)));
  m.add<Inertia>("J_a", {"a"}, {.inertia = 1.0});
  m.add<Inertia>("J_b", {"b"}, {.inertia = 1.0});
  m.add<ShaftSpring>("s", {"a", "b"}, {.stiffness = 1e4});
  for (int i = 0; i < 3; ++i)
    m.add<EngineOrderTorque>("gas_" + std::to_string(i), {"a"},
                             {.harmonics = {{0.5, 100.0, deg(120.0 * i)}}, .twist_feedback = false});
  m.add<EngineOrderTorque>("rest", {"a"}, {.harmonics = {{1.0, 10.0, 0.0}}, .twist_feedback = false});
  const LinearSweep sweep = sweep_linear(
      m.build(), {.speeds = rpm_speeds(2000.0, 500.0, 3000.0), .orders = {0.5, 1.0}, .threads = 1});
  CHECK(std::isfinite(largest_half_range(sweep, 0).value));
  // T = p k / (2 k - w^2) of order 1 at its largest, 2000 rpm.
  const double w = rpm(2000.0);
  CHECK(largest_half_range(sweep, 0).value == Approx(1e5 / (w * w - 2e4)).epsilon(1e-10));
}
