// Orders over a run-up, against closed forms.
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/periodic/order_tracking.hpp>
#include <drev/solvers/run/after_time.hpp>
#include <drev/solvers/run/recorder.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <memory>

#include "tests/catch.hpp"

using namespace drev;

namespace {

/// A disc on a shaft from a held node that runs up; orders 2 and 3.5 act on the disc.
System run_up_system(double stiffness, double damping) {
  Model m("up");
  const NodeId end = m.add_node("end"), disc = m.add_node("disc");
  m.set_reference(end, run_up(20.0, 80.0, 0.0, 60.0));
  m.hold(end);
  m.add<Inertia>("J", {disc}, {.inertia = 1.0});
  m.add<ShaftSpring>("shaft", {end, disc}, {.stiffness = stiffness, .damping = damping});
  m.add<EngineOrderTorque>("load", {disc},
                           {.harmonics = {{.order = 2.0, .amplitude = 3.0}, {.order = 3.5, .amplitude = 1.0}},
                            .twist_feedback = false});
  return m.build();
}

}  // namespace

TEST_CASE("Tracked orders of a slow run-up follow the frequency response over the speed") {
  const double stiffness = 10000.0, damping = 10.0;  // 100 rad/s: order 2 resonates at 50 rad/s
  const System system = run_up_system(stiffness, damping);
  for (const bool own_times : {true, false}) {
    OrderTracking tracking(system, {"disc.angle_rad"}, {2.0, 3.5}, 4.0, own_times);
    const Method method = own_times ? Method{.name = kExact, .tolerance = 1e-9} : Method{.step = 2e-4};
    REQUIRE(run_method(system, method, {.t_end = 60.0}, {&tracking}).ok());
    const OrderTracks& tracks = tracking.tracks();
    REQUIRE(tracks.speed.size() > 200);
    CHECK(std::is_sorted(tracks.speed.begin(), tracks.speed.end()));
    const auto check = [&](std::size_t k, double order, double load, double within) {
      for (std::size_t i = 0; i < tracks.speed.size(); ++i) {
        if (tracks.time[i] < 2.0) continue;  // the start from rest
        const double w = order * tracks.speed[i];
        const double steady = load / std::hypot(stiffness - w * w, damping * w);
        const double peak = load / (damping * 100.0);
        CHECK(std::abs(tracks.amplitude[0][k][i] - steady) < within * peak);
      }
    };
    check(0, 2.0, 3.0, 0.08);  // passing at 1 rad/s^2 lags and lowers the resonance a little
    check(1, 3.5, 1.0, 0.12);
    const auto top = std::max_element(tracks.amplitude[0][0].begin(), tracks.amplitude[0][0].end());
    const double at = tracks.speed[static_cast<std::size_t>(top - tracks.amplitude[0][0].begin())];
    CHECK(std::abs(at - 50.0) < 1.5);
  }
}

TEST_CASE("Windows are whole turns: a load that is its own order comes out exactly at any speed") {
  const System system = run_up_system(1e4, 10.0);
  OrderTracking tracking(system, {"load.torque_Nm"}, {1.0, 2.0, 3.5}, 4.0, true);
  REQUIRE(run_method(system, {.name = kExact, .tolerance = 1e-9}, {.t_end = 20.0}, {&tracking}).ok());
  const OrderTracks& tracks = tracking.tracks();
  REQUIRE(!tracks.speed.empty());
  for (std::size_t i = 0; i < tracks.speed.size(); ++i) {
    CHECK(std::abs(tracks.amplitude[0][0][i]) < 1e-3);
    CHECK(std::abs(tracks.amplitude[0][1][i] - 3.0) < 1e-3);
    CHECK(std::abs(tracks.amplitude[0][2][i] - 1.0) < 1e-3);
    CHECK(std::abs(tracks.speed[i] - (20.0 + tracks.time[i])) < 1e-2);
  }
}

TEST_CASE("Three orders with their phases over a run-up from 1000 rpm: amplitudes and phases stay the same") {
  // cos(phi/2 + 0.3) + 2 cos(3 phi - 1.1) + cos(6 phi + 0.7)/2 while the speed is 1000 + 150 t rpm, ten seconds.
  Model m("three orders");
  const NodeId end = m.add_node("end"), disc = m.add_node("disc");
  m.set_reference(end, run_up(rpm(1000.0), rpm(2500.0), 0.0, 10.0));
  m.hold(end);
  m.add<Inertia>("J", {disc}, {.inertia = 1.0});
  m.add<ShaftSpring>("shaft", {end, disc}, {.stiffness = 1e4, .damping = 10.0});
  m.add<EngineOrderTorque>(
      "load", {disc},
      {.harmonics = {{0.5, 1.0, 0.3}, {3.0, 2.0, -1.1}, {6.0, 0.5, 0.7}}, .twist_feedback = false});
  const System system = m.build();
  std::vector<double> even;
  for (int k = 1; k <= 26; ++k) even.push_back(0.25 * k);
  OrderTracking three(system, {"load.torque_Nm"}, {0.5, 3.0, 6.0}, 4.0, true),
      waterfall(system, {"load.torque_Nm"}, even, 4.0, true);
  REQUIRE(
      run_method(system, {.name = kExact, .tolerance = 1e-9}, {.t_end = 10.0}, {&three, &waterfall}).ok());
  const double amplitude[] = {1.0, 2.0, 0.5}, phase[] = {0.3, -1.1, 0.7};
  const OrderTracks& tracks = three.tracks();
  REQUIRE(tracks.time.size() > 100);
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t w = 0; w < tracks.time.size(); ++w) {
      CHECK(tracks.amplitude[0][k][w] == Approx(amplitude[k]).margin(1e-4));
      CHECK(tracks.phase[0][k][w] == Approx(phase[k]).margin(1e-3));
    }
  // The waterfall: what is no order of the load is half a window's line away from one, or zero.
  const OrderTracks& map = waterfall.tracks();
  for (std::size_t k = 0; k < even.size(); ++k) {
    double distance = 100.0, beside = 0.0;
    for (int i = 0; i < 3; ++i)
      if (std::abs(even[k] - tracks.orders[std::size_t(i)]) < distance)
        distance = std::abs(even[k] - tracks.orders[std::size_t(i)]), beside = amplitude[i];
    for (std::size_t w = 0; w < map.time.size(); ++w) {
      double expected = distance == 0.0 ? beside : distance == 0.25 ? 0.5 * beside : 0.0;
      // The line of one period in the window, fitted beside the mean: from cos(phi/2 + 0.3) the normal equations with
      // the means 1, 1/2, 1/2 of w, w cos^2, w sin^2 and -1/2 of w cos give cos 0.3 and half of sin 0.3.
      if (even[k] == 0.25) expected = std::hypot(std::cos(0.3), 0.5 * std::sin(0.3));
      CHECK(map.amplitude[0][k][w] == Approx(expected).margin(1e-3));
    }
  }
}

TEST_CASE(
    "A run-up through a resonance: the motion itself, and amplitude and phase of its order by the window") {
  // x'' + 0.02 x' + x = cos(alpha t^2 / 2 + p) on a shaft that runs up at alpha: the disc's own inertia torque is taken
  // off by a constant one. References: a separate program (Runge-Kutta of order 8 at 1e-13, Gauss's rule over the
  // angle), which also gives amplitudes through rectangular windows that were computed elsewhere, to their 7 digits.
  const double alpha = 1e-3;
  const auto model = [&](double phase) {
    Model m("resonance");
    const NodeId end = m.add_node("end"), disc = m.add_node("disc");
    m.set_reference(end, run_up(0.0, 1.26, 0.0, 1260.0));
    m.hold(end);
    m.add<Inertia>("J", {disc}, {.inertia = 1.0});
    m.add<ShaftSpring>("shaft", {end, disc}, {.stiffness = 1.0, .damping = 0.02});
    m.add<EngineOrderTorque>("load", {disc},
                             {.harmonics = {{.order = 1.0, .amplitude = 1.0, .phase = phase}},
                              .mean = alpha,
                              .twist_feedback = false});
    return m.build();
  };
  const double speeds[] = {0.9, 1.0, 1.05, 1.1, 1.2};
  std::vector<std::unique_ptr<OrderTracking>> trackers;
  std::vector<std::unique_ptr<AfterTime>> later;
  std::vector<std::vector<double>> parts;  // imaginary, then real part of the complex motion, every 10 s
  for (const double phase : {-0.25 * kTwoPi, 0.0}) {
    const System system = model(phase);
    Recorder recorder(system, {"disc.angle_rad"}, 10.0);
    std::vector<Observer*> observers{&recorder};
    if (parts.empty())
      for (const double w : speeds) {
        // A window of four turns with its middle where the speed is w.
        const double middle = 0.5 * w * w / alpha;
        trackers.push_back(std::make_unique<OrderTracking>(system, std::vector<std::string>{"disc.angle_rad"},
                                                           std::vector<double>{1.0}, 4.0, true));
        later.push_back(std::make_unique<AfterTime>(std::sqrt(2.0 * (middle - 2.0 * kTwoPi) / alpha),
                                                    std::vector<Observer*>{trackers.back().get()}));
        observers.push_back(later.back().get());
      }
    REQUIRE(run_method(system, {.name = kExact, .tolerance = 1e-13}, {.t_end = 1260.0}, observers).ok());
    parts.push_back(recorder.samples(0));
  }
  const std::pair<double, double> motion[] = {
      {0.8, 2.764951332},   {0.9, 5.068443328},   {0.95, 8.462379217},
      {1.0, 16.750317053},  {1.02, 21.867109336}, {1.04, 26.682614433},
      {1.05, 28.094979333}, {1.1, 10.799320982},  {1.2, 6.504213071}};
  for (const auto& [w, amplitude] : motion) {
    INFO("speed " << w);
    const auto i = static_cast<std::size_t>(std::lround(w / alpha / 10.0));
    CHECK(std::hypot(parts[0][i], parts[1][i]) == Approx(amplitude).margin(2e-9));
  }
  const std::pair<double, double> tracked[] = {{5.075893480937, -99.98964447},
                                               {16.717416271797, -144.05470021},
                                               {27.583322795447, 138.12741599},
                                               {9.676310694937, -43.55155789},
                                               {5.192055066565, 138.40411836}};
  for (std::size_t i = 0; i < trackers.size(); ++i) {
    INFO("speed " << speeds[i]);
    const OrderTracks& tracks = trackers[i]->tracks();
    REQUIRE_FALSE(tracks.speed.empty());
    CHECK(tracks.amplitude[0][0][0] == Approx(tracked[i].first).epsilon(1e-5));
    CHECK(to_deg(tracks.phase[0][0][0]) == Approx(tracked[i].second).margin(1e-3));
  }
}

TEST_CASE("From rest without nominal speed orders are of the actual angle, beside a separate computation") {
  // J_1 theta'' = M + A cos(2 theta + p) + k x + c x', J_2 (theta + x)'' = -k x - c x': a rotor that a constant torque
  // speeds up, with a torque over its actual angle, and a disc on its shaft; 4th-order Runge-Kutta, by hand.
  const double inertia_1 = 1.0, inertia_2 = 0.05, k = 150.0, c = 0.15, amplitude = 3.0, phase = 0.4;
  for (const double mean : {5.0, -5.0}) {
    Model m("from rest");
    m.add_node("rotor");
    m.add_node("disc");
    m.add<Inertia>("J_1", {"rotor"}, {.inertia = inertia_1});
    m.add<Inertia>("J_2", {"disc"}, {.inertia = inertia_2});
    m.add<ShaftSpring>("shaft", {"rotor", "disc"}, {.stiffness = k, .damping = c});
    m.add<EngineOrderTorque>("torque", {"rotor"}, {.harmonics = {{2.0, amplitude, phase}}, .mean = mean});
    const System system = m.build();
    OrderTracking tracking(system, {"shaft.torque_Nm"}, {1.0, 2.0}, 4.0, false, "rotor"),
        own_points(system, {"shaft.torque_Nm"}, {1.0, 2.0}, 4.0, true, "rotor");
    REQUIRE(run_method(system, {.step = 1e-4}, {.t_end = 10.0}, {&tracking}).ok());
    REQUIRE(run_method(system, {.name = kExact, .tolerance = 1e-10}, {.t_end = 10.0}, {&own_points}).ok());

    using State4 = std::array<double, 4>;  // theta, x, their rates
    const auto rates = [&](const State4& s) {
      const double spring = k * s[1] + c * s[3];
      const double a_1 = (mean + amplitude * std::cos(2.0 * s[0] + phase) + spring) / inertia_1;
      return State4{s[2], s[3], a_1, -spring / inertia_2 - a_1};
    };
    const double h = 1e-4;
    std::vector<double> angle, torque, time;
    State4 s{};
    for (int i = 0; i <= 100000; ++i) {
      angle.push_back(s[0]);
      torque.push_back(k * s[1] + c * s[3]);
      time.push_back(i * h);
      const auto at = [&](const State4& r, double part) {
        State4 moved = s;
        for (std::size_t j = 0; j < 4; ++j) moved[j] += part * h * r[j];
        return moved;
      };
      const State4 r1 = rates(s), r2 = rates(at(r1, 0.5)), r3 = rates(at(r2, 0.5)), r4 = rates(at(r3, 1.0));
      for (std::size_t j = 0; j < 4; ++j) s[j] += h / 6.0 * (r1[j] + 2.0 * r2[j] + 2.0 * r3[j] + r4[j]);
    }
    const double sense = mean > 0.0 ? 1.0 : -1.0;
    // The same window, which begins at a point of the run.
    const auto check = [&](const OrderTracks& tracks, double first, double within) {
      REQUIRE(tracks.time.size() > 10);
      CHECK(tracks.shaft == "rotor");
      CHECK(std::is_sorted(tracks.speed.begin(), tracks.speed.end(),
                           [&](double a, double b) { return sense * a < sense * b; }));
      const double width = 4.0 * kTwoPi;
      for (std::size_t w = 0; w < tracks.time.size(); ++w) {
        const double begin = first + 0.5 * width * static_cast<double>(w);
        std::complex<double> sums[2] = {};
        double weights = 0.0, lasts = 0.0;
        for (std::size_t i = 0; i + 1 < angle.size(); ++i) {
          const double phi = 0.5 * sense * (angle[i] + angle[i + 1]), part = (phi - begin) / width;
          if (part <= 0.0 || part >= 1.0) continue;
          const double weight = std::pow(std::sin(0.5 * kTwoPi * part), 2);
          const double dphi = sense * (angle[i + 1] - angle[i]);
          weights += weight * dphi;
          lasts += weight * (time[i + 1] - time[i]);
          for (int o = 0; o < 2; ++o)
            sums[o] += 0.5 * (torque[i] + torque[i + 1]) * weight * dphi * std::polar(1.0, -(o + 1.0) * phi);
        }
        INFO("window " << w << ", sense " << sense);
        CHECK(sense * tracks.speed[w] == Approx(weights / lasts).epsilon(within));
        for (std::size_t o = 0; o < 2; ++o) {
          const std::complex<double> found = std::polar(tracks.amplitude[0][o][w], tracks.phase[0][o][w]);
          CHECK(std::abs(found - 2.0 * sums[o] / weights) < within);
        }
      }
    };
    // The first window begins at the first point beyond a tenth of a turn.
    const auto begun =
        std::find_if(angle.begin(), angle.end(), [](double a) { return std::abs(a) >= 0.1 * kTwoPi; });
    check(tracking.tracks(), std::abs(*begun), 2e-3);
    REQUIRE(own_points.tracks().time.size() == tracking.tracks().time.size());
    // With points of its own the begin is another; orders change little over so short a way.
    for (std::size_t w = 1; w < own_points.tracks().time.size(); ++w)
      CHECK(own_points.tracks().speed[w] == Approx(tracking.tracks().speed[w]).epsilon(0.05));
  }
  Model m("none");
  m.add_node("rotor");
  m.add<Inertia>("J", {"rotor"}, {.inertia = 1.0});
  CHECK_THROWS(OrderTracking(m.build(), {"rotor.angle_rad"}, {1.0}, 4.0, false, "stator"));
}

TEST_CASE("Orders of a rotor's own angle and speed from rest are its vibration about the mean motion") {
  // J theta'' = M + A cos(2 theta + p): w^2 = 2 M theta/J but for the vibration, whose angle is -A cos(2 theta + p)/(4 J w^2)
  // and whose speed is -A cos(2 theta + p + pi/2)/(2 J w), relative to A/(J w^2) = 0.01.
  const double mean = 5.0, amplitude = 3.0, phase = 0.4;
  Model m("one rotor");
  m.add_node("rotor");
  m.add<Inertia>("J", {"rotor"}, {.inertia = 1.0});
  m.add<EngineOrderTorque>("torque", {"rotor"}, {.harmonics = {{2.0, amplitude, phase}}, .mean = mean});
  const System system = m.build();
  OrderTracking tracking(system, {"rotor.angle_rad", "rotor.speed_rad_per_s"}, {0.5, 1.0, 2.0, 3.0}, 4.0,
                         true, "rotor");
  REQUIRE(run_method(system, {.name = kExact, .tolerance = 1e-10}, {.t_end = 12.0}, {&tracking}).ok());
  const OrderTracks& tracks = tracking.tracks();
  REQUIRE(tracks.time.size() > 20);
  const double width = 4.0 * kTwoPi;
  int looked_at = 0;
  for (std::size_t w = 0; w < tracks.time.size(); ++w) {
    if (tracks.speed[w] < 20.0) continue;
    ++looked_at;
    const double begin = 0.1 * kTwoPi + 0.5 * width * static_cast<double>(w);
    double angle = 0.0, speed = 0.0, weights = 0.0;
    for (int i = 0; i < 1000; ++i) {
      const double part = (i + 0.5) / 1000.0, phi = begin + part * width;
      const double weight = std::pow(std::sin(0.5 * kTwoPi * part), 2), omega = std::sqrt(2.0 * mean * phi);
      angle += weight * amplitude / (4.0 * omega * omega);
      speed += weight * amplitude / (2.0 * omega);
      weights += weight;
    }
    INFO("window " << w << " at " << tracks.speed[w] << " rad/s");
    const auto found = [&](std::size_t c, std::size_t k) {
      return std::polar(tracks.amplitude[c][k][w], tracks.phase[c][k][w]);
    };
    CHECK(std::abs(found(0, 2) + std::polar(angle / weights, phase)) < 0.02 * angle / weights);
    CHECK(std::abs(found(1, 2) + std::polar(speed / weights, phase + 0.5 * kPi)) < 0.02 * speed / weights);
    for (const std::size_t other : {0, 1, 3}) CHECK(tracks.amplitude[0][other][w] < 0.05 * angle / weights);
  }
  CHECK(looked_at > 10);
}

TEST_CASE("A nominal speed that reverses: its windows are left out, and all others exact in either sense") {
  Model m("back and forth");
  const NodeId end = m.add_node("end"), disc = m.add_node("disc");
  m.set_reference(end, run_up(-60.0, 60.0, 0.0, 5.0));
  m.hold(end);
  m.add<Inertia>("J", {disc}, {.inertia = 1.0});
  m.add<ShaftSpring>("shaft", {end, disc}, {.stiffness = 1e4, .damping = 10.0});
  m.add<EngineOrderTorque>("load", {disc},
                           {.harmonics = {{.order = 1.0, .amplitude = 100.0, .phase = 0.7},
                                          {.order = 2.0, .amplitude = 50.0, .phase = 1.3}},
                            .twist_feedback = false});
  const System system = m.build();
  OrderTracking tracking(system, {"load.torque_Nm"}, {1.0, 2.0}, 4.0, true);
  REQUIRE(run_method(system, {.name = kExact, .tolerance = 1e-9}, {.t_end = 5.0}, {&tracking}).ok());
  const OrderTracks& tracks = tracking.tracks();
  int before = 0, behind = 0;
  for (std::size_t i = 0; i < tracks.time.size(); ++i) {
    INFO(tracks.time[i] << " s");
    ++(tracks.time[i] < 2.5 ? before : behind);
    CHECK(tracks.speed[i] * (tracks.time[i] - 2.5) > 0.0);
    CHECK(tracks.amplitude[0][0][i] == Approx(100.0).epsilon(1e-3));
    CHECK(tracks.amplitude[0][1][i] == Approx(50.0).epsilon(1e-3));
  }
  CHECK(before > 2);
  CHECK(behind > 2);
}

TEST_CASE("The mean torque is no part of an order below a half, as that of a shaft geared down") {
  // A held node, a shaft, and behind a gear of 1/3 the load 3000 + 30 cos(psi) N m: in the shaft order 1/3 of 10 N m, raised
  // by the inertia reduced to its end: k/(k - J w^2).
  const double k = 1e6, reduced = 1.0 + 1.0 / 9.0;
  for (const bool own_times : {true, false}) {
    Model m("geared down");
    const NodeId end = m.add_node("end"), pinion = m.add_node("pinion"), wheel = m.add_node("wheel");
    m.set_reference(end, run_up(rpm(600.0), rpm(1200.0), 0.0, 10.0));
    m.hold(end);
    m.add<Inertia>("J_1", {pinion}, {.inertia = 1.0});
    m.add<Inertia>("J_2", {wheel}, {.inertia = 1.0});
    m.add<ShaftSpring>("shaft", {end, pinion}, {.stiffness = k, .damping = 300.0});
    m.add<IdealGear>("gear", {pinion, wheel}, {.ratio = -1.0 / 3.0});
    m.add<EngineOrderTorque>("load", {wheel},
                             {.harmonics = {{1.0, 30.0}}, .mean = 3000.0, .twist_feedback = false});
    const System system = m.build();
    OrderTracking tracking(system, {"shaft.torque_Nm"}, {1.0 / 3.0}, 4.0, own_times),
        waterfall(system, {"load.torque_Nm"}, {0.25, 0.5}, 4.0, own_times);
    const Method method = own_times ? Method{.name = kExact, .tolerance = 1e-9} : Method{.step = 1e-4};
    REQUIRE(run_method(system, method, {.t_end = 10.0}, {&tracking, &waterfall}).ok());
    const OrderTracks& tracks = tracking.tracks();
    REQUIRE(tracks.time.size() > 50);
    for (std::size_t w = 0; w < tracks.time.size(); ++w) {
      if (tracks.time[w] < 1.0) continue;  // the start from rest
      const double rate = tracks.speed[w] / 3.0;
      CHECK(tracks.amplitude[0][0][w] == Approx(10.0 * k / (k - reduced * rate * rate)).epsilon(1e-3));
      // The lines beside order 1/3 hold about its 30 N m, and nothing of the mean.
      for (const std::size_t line : {0, 1}) CHECK(waterfall.tracks().amplitude[0][line][w] < 60.0);
    }
  }
}

TEST_CASE(
    "Orders of angles and speeds of a free train at a nominal run-up are its vibration beside the drift") {
  // Two equal discs on a shaft, and 20 + 50 cos(phi) N m on the second: the angle of the second has the dynamic compliance
  // d/(d^2 - s^2), d = k + i w c - J w^2, s = k + i w c.
  const double k = 1e6, c = 300.0;
  Model m("free");
  const NodeId first = m.add_node("first"), second = m.add_node("second");
  m.set_reference(first, run_up(rpm(600.0), rpm(1200.0), 0.0, 10.0));
  m.add<Inertia>("J_1", {first}, {.inertia = 1.0});
  m.add<Inertia>("J_2", {second}, {.inertia = 1.0});
  m.add<ShaftSpring>("shaft", {first, second}, {.stiffness = k, .damping = c});
  m.add<EngineOrderTorque>("load", {second},
                           {.harmonics = {{1.0, 50.0}}, .mean = 20.0, .twist_feedback = false});
  const System system = m.build();
  OrderTracking tracking(system, {"second.angle_rad", "second.speed_rad_per_s", "shaft.torque_Nm"}, {1.0},
                         4.0, true);
  REQUIRE(run_method(system, {.name = kExact, .tolerance = 1e-9}, {.t_end = 10.0}, {&tracking}).ok());
  const OrderTracks& tracks = tracking.tracks();
  REQUIRE(tracks.time.size() > 50);
  for (std::size_t i = 0; i < tracks.time.size(); ++i) {
    if (tracks.time[i] < 1.0) continue;  // the start from rest
    const double w = tracks.speed[i];
    const std::complex<double> s(k, w * c), d = s - w * w;
    const double angle = 50.0 * std::abs(d / (d * d - s * s));
    CHECK(tracks.amplitude[0][0][i] == Approx(angle).epsilon(1e-3));
    CHECK(tracks.amplitude[1][0][i] == Approx(w * angle).epsilon(2e-3));
    CHECK(tracks.amplitude[2][0][i] == Approx(50.0 * std::abs(s * w * w / (d * d - s * s))).epsilon(2e-3));
  }
}
