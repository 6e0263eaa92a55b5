// StraightLoads: what it finds for all loads at once, beside each load asked by itself at many points of the step.
#include "solvers/exact/straight_loads.hpp"

#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>

#include <cmath>
#include <map>
#include <random>
#include <set>

#include "tests/catch.hpp"

using namespace drev;

namespace {

constexpr int kDiscs = 11;
constexpr double kSpeed = 20.0;

/// Discs in a chain, with one table on each, a second one on every third, and one in four over the nominal angle.
Model discs_with_tables() {
  Model m("discs with tables");
  m.add_node("bed");
  m.constant_speed("bed", kSpeed);
  for (int i = 0; i < kDiscs; ++i) {
    const std::string number = std::to_string(i), before = i ? "disc" + std::to_string(i - 1) : "bed";
    m.add_node("disc" + number);
    m.add<Inertia>("J" + number, {"disc" + number}, {.inertia = 0.1 + 0.01 * i});
    m.add<ShaftSpring>("k" + number, {before, "disc" + number}, {.stiffness = 2e4});
    for (int k = 0; k < (i % 3 == 0 ? 2 : 1); ++k)
      m.add<CamTorque>(
          "cam" + number + std::to_string(k), {"disc" + number},
          {.angle_table = PeriodicTable({0.0, 0.4, 0.5, 1.3, 2.0, 4.0}, {0.0, 3.0, -9.0, 4.0, 7.0, 1.0}),
           .phase = 0.31 * i + 0.9 * k,
           .twist_feedback = i % 4 != 1});
  }
  return m;
}

}  // namespace

TEST_CASE("Straight loads: those that pass a knot in a step, and the torques that a step starts with") {
  const System system = discs_with_tables().build();
  const int n = system.size();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> deviation(-0.3, 0.3), rate(-30.0, 30.0);
  int passing = 0, turning = 0, others = 0, left_out = 0;
  for (int trial = 0; trial < 200; ++trial) {
    TaylorSeries series(system);
    series.bound_rates();
    StraightLoads straight(system);
    for (const LoadTerm& term : system.loads()) straight.add(term, series);
    Vector z(n), v(n);
    for (int i = 0; i < n; ++i) {
      z[i] = deviation(random);
      v[i] = rate(random);
    }
    const double t = 0.01 * trial, h = 2e-3;
    straight.move({kSpeed * t, kSpeed, 0.0}, z, v);
    straight.locate(t);
    const std::array<double, 3> phi{kSpeed * t, kSpeed * h, 0.0};
    series.reset();
    std::vector<double> p(static_cast<std::size_t>(3 * series.stride()));
    straight.add_to(series, t, h, phi, p.data());

    // The torques at the start, with what the slopes take from the right side.
    Vector torque = Vector::Zero(n);
    for (const LoadTerm& term : system.loads()) {
      const int row = system.node_map(term.node).unknown;
      torque[row] += term.load->evaluate({.t = t, .nominal_angle = kSpeed * t, .deviation = z[row]}).torque;
    }
    for (int i = 0; i < n; ++i) CHECK(p[static_cast<std::size_t>(i)] == Approx(torque[i]).margin(1e-12));

    REQUIRE(series.expand(z, v, h, 1e-13) == h);
    const auto stride = static_cast<std::size_t>(series.stride());
    std::vector<double> ranges(3 * stride);
    series.ranges(ranges.data(), ranges.data() + stride);
    std::set<const LoadTerm*> found;
    std::map<const LoadTerm*, bool> monotone;
    for (const StraightLoads::Near& near : straight.near_knots(series, 1.0, phi, ranges.data())) {
      found.insert(straight.load_of(near).term);
      monotone[straight.load_of(near).term] = near.monotone;
    }
    Vector at(n), speed(n);
    for (const StraightLoads::Load& load : straight.loads()) {
      bool rises = false, falls = false, passes = false;
      double before = load.angle;
      for (int q = 1; q <= 200; ++q) {
        const double s = q / 200.0;
        series.evaluate(s, at, speed);
        const double angle = kSpeed * (t + s * h) + (load.feedback ? at[load.row] : 0.0);
        rises |= angle > before;
        falls |= angle < before;
        passes |= angle > load.stretch.high + 1e-9 || angle < load.stretch.low - 1e-9;
        before = angle;
      }
      turning += rises && falls;
      if (rises && falls && found.count(load.term) == 1) CHECK_FALSE(monotone[load.term]);
      passing += passes;
      if (passes) CHECK(found.count(load.term) == 1);
      if (passes || (rises && falls)) continue;
      ++others;
      left_out += found.count(load.term) == 0;
    }
  }
  CHECK(passing > 100);
  CHECK(turning > 100);
  CHECK(left_out > 0.7 * others);  // the rest nearly turn
}
