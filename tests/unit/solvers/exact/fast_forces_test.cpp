// Peaks of forces that turn several times in a step, since they follow an angle faster than any mode swings.
// Covers solvers/exact/step_expansion.hpp, solvers/run/peak_search.hpp and solvers/run/cubic_peak.hpp through propagate().
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/run/contact_statistics.hpp>
#include <drev/solvers/run/evaluated_state.hpp>
#include <drev/solvers/run/peaks.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "tests/catch.hpp"

using namespace drev;

namespace {

/// Largest and smallest of values at a constant distance in time, with the parabola through three of them.
struct FineExtremes {
  double low = 0.0, high = 0.0;
  double before = 0.0, last = 0.0;
  int count = 0;
  void add(double y) {
    if (count == 0) low = high = y;
    if (count >= 2 && (last - before) * (y - last) < 0.0) {
      const double bend = before - 2.0 * last + y;
      const double turn = last - (y - before) * (y - before) / (8.0 * bend);
      low = std::min(low, turn);
      high = std::max(high, turn);
    }
    low = std::min(low, y);
    high = std::max(high, y);
    before = std::exchange(last, y);
    ++count;
  }
};

GearMesh::Params fast_mesh(MeshStiffness stiffness) {
  return {.base_radius_1 = 0.04, .base_radius_2 = 0.075, .teeth_1 = 31, .stiffness = std::move(stiffness)};
}

constexpr double kPinionSpeed = 6000.0 * kPi / 30.0;
constexpr double kTolerancesAsked[] = {1e-3, 1e-6, 1e-8, 1e-10};

/// Mesh forces at a constant distance in time.
struct FineForces final : Observer {
  static constexpr double kEvery = 1e-7;
  FineExtremes force;
  void start(const Assembler&, const EvaluatedState& point) override { force.add(point.responses[0].y); }
  void step(const Assembler&, const EvaluatedState&, const EvaluatedState& to) override {
    if (std::abs(std::remainder(to.state.t, kEvery)) < 1e-3 * kEvery) force.add(to.responses[0].y);
  }
  double next_stop(double t) const override { return (std::floor(t / kEvery + 1e-3) + 1.0) * kEvery; }
};

}  // namespace

TEST_CASE(
    "Peaks of a mesh force whose transmission error swings 60 times as fast as the mode, in closed form") {
  const std::vector<Harmonic> error{{1.0, 3e-6, 0.4}, {8.0, 1e-6, -1.1}};
  const double k = 2e8, r = 0.075, J = 0.3, w = r * std::sqrt(k / J);
  Model m("mesh with an error");
  for (const char* node : {"pinion", "wheel"}) m.add_node(node);
  m.constant_speed("pinion", kPinionSpeed);
  m.add<Inertia>("J", {"wheel"}, {.inertia = J});
  GearMesh::Params p = fast_mesh(k);
  p.transmission_error = error;
  m.add<GearMesh>("mesh", {"pinion", "wheel"}, p);
  const System system = m.build();

  // J q'' = -r k (r q - e), from rest, with e = sum A cos(nu t + phase); force k (r q - e).
  double a = 0.0, b = 0.0;
  const auto forced = [&](const Harmonic& h, double& nu) {
    nu = h.order * p.teeth_1 * kPinionSpeed;
    return r * k * h.amplitude / (J * (w * w - nu * nu));
  };
  for (const Harmonic& h : error) {
    double nu = 0.0;
    const double q = forced(h, nu);
    a -= q * std::cos(h.phase);
    b += q * nu * std::sin(h.phase) / w;
  }
  FineExtremes expected;
  const double end = 0.01;
  for (int i = 0; i <= 200000; ++i) {
    const double t = end * i / 200000;
    double q = a * std::cos(w * t) + b * std::sin(w * t), e = 0.0;
    for (const Harmonic& h : error) {
      double nu = 0.0;
      q += forced(h, nu) * std::cos(nu * t + h.phase);
      e += h.amplitude * std::cos(nu * t + h.phase);
    }
    expected.add(k * (r * q - e));
  }
  for (const double tolerance : kTolerancesAsked) {
    CAPTURE(tolerance);
    Peaks peaks({find_channel(system, "mesh.force_N")});
    REQUIRE(propagate(system, {.tolerance = tolerance, .t_end = end}, {&peaks}).ok());
    const double within = 2.0 * tolerance + 1e-8;
    CHECK(peaks.peaks()[0].max == Approx(expected.high).epsilon(within));
    CHECK(peaks.peaks()[0].min == Approx(expected.low).epsilon(within));
  }
}

TEST_CASE(
    "Peaks of mesh forces whose stiffness swings faster than any mode are those of the motion sampled "
    "finely",
    "[once]") {
  struct Case {
    const char* name;
    MeshStiffness stiffness;
    double backlash;
  };
  const std::vector<Case> cases{
      {"orders 1 to 3", MeshStiffness::fourier(2e8, {{1.0, 4e7, 0.0}, {2.0, 2e7, 0.0}, {3.0, 1.2e7, 0.0}}),
       0.0},
      {"orders 1 and 40, gap", MeshStiffness::fourier(2e8, {{1.0, 5e7, 0.0}, {40.0, 1e7, 0.5}}), 2e-5},
      {"40 orders of a step", MeshStiffness::fourier_of_step(1.5e8, 2.6e8, 1.5, 40), 0.0}};
  for (const Case& c : cases) {
    Model m("fast mesh");
    for (const char* node : {"pinion", "wheel", "load"}) m.add_node(node);
    m.set_reference("pinion", constant_speed(kPinionSpeed));
    GearMesh::Params p = fast_mesh(c.stiffness);
    p.normal_backlash = c.backlash;
    m.add<GearMesh>("mesh", {"pinion", "wheel"}, p);
    m.add<ShaftSpring>("shaft", {"wheel", "load"}, {.stiffness = 3e4, .damping = 1.0});
    for (const auto& [node, inertia] : {std::pair{"pinion", 0.05}, {"wheel", 0.3}, {"load", 1.0}})
      m.add<Inertia>(std::string("J_") + node, {node}, {.inertia = inertia});
    m.add<AppliedTorque>("drive", {"pinion"}, {.table = TimeTable({0.0}, {40.0})});
    m.add<AppliedTorque>("brake", {"load"}, {.table = TimeTable({0.0}, {75.0})});
    const System system = m.build();
    for (const double tolerance : kTolerancesAsked) {
      CAPTURE(c.name, tolerance);
      const ExactOptions options{.tolerance = tolerance, .t_end = 0.005};
      FineForces sampled;
      REQUIRE(propagate(system, options, {&sampled}).ok());
      REQUIRE(sampled.force.count >= 50000);
      Peaks peaks({find_channel(system, "mesh.force_N")});
      ContactStatistics contacts(system);
      REQUIRE(propagate(system, options, {&peaks, &contacts}).ok());
      const double within = 2.0 * tolerance + 1e-6;
      CHECK(peaks.peaks()[0].max == Approx(sampled.force.high).epsilon(within));
      CHECK(peaks.peaks()[0].min == Approx(sampled.force.low).epsilon(within).margin(1e-6));
      if (c.backlash > 0.0) {
        const double largest = std::max(sampled.force.high, -sampled.force.low);
        CHECK(contacts.records()[0].largest_force == Approx(largest).epsilon(within));
      }
    }
  }
}
