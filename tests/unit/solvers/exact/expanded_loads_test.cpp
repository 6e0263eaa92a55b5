// Smooth loads as power series, in steps with kinks of theirs and of tables, and with a mesh whose damping grows with
// penetration: the motion, at the end and inside steps, is that of Runge-Kutta, which knows of no series, knot or sweep.
// Covers solvers/exact/expanded_loads.hpp and the sweep with expanded_laws.hpp.
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/run/recorder.hpp>

#include <cmath>
#include <random>

#include "solvers/exact/kink_moments.hpp"
#include "tests/catch.hpp"
#include "tests/unit/solvers/exact/placed_load.hpp"

using namespace drev;

namespace {

/// Two throws, a flywheel, and a camshaft behind a mesh, driven by all that exact propagation expands.
System engine_with_camshaft(unsigned seed) {
  std::mt19937 generator(seed);
  const auto between = [&](double low, double high) {
    return low + (high - low) * std::uniform_real_distribution<>()(generator);
  };
  Model m("engine with camshaft");
  for (const char* node : {"throw_1", "throw_2", "flywheel", "pinion", "camshaft", "cam"}) m.add_node(node);
  m.add<Inertia>("J_1", {"throw_1"}, {.inertia = between(0.02, 0.06)});
  m.add<Inertia>("J_2", {"throw_2"}, {.inertia = between(0.02, 0.06)});
  m.add<Inertia>("J_flywheel", {"flywheel"}, {.inertia = 1.0});
  m.add<Inertia>("J_pinion", {"pinion"}, {.inertia = between(0.003, 0.01)});
  m.add<Inertia>("J_camshaft", {"camshaft"}, {.inertia = between(0.01, 0.03)});
  m.add<Inertia>("J_cam", {"cam"}, {.inertia = between(0.004, 0.01)});
  m.add<ShaftSpring>("web", {"throw_1", "throw_2"}, {.stiffness = between(1e5, 4e5), .damping = 10.0});
  m.add<ShaftSpring>("shaft", {"throw_2", "flywheel"}, {.stiffness = between(2e5, 5e5), .damping = 10.0});
  m.add<ShaftSpring>("front", {"throw_1", "pinion"}, {.stiffness = between(5e4, 1e5), .damping = 3.0});
  m.add<ShaftSpring>("camshaft", {"camshaft", "cam"}, {.stiffness = between(1e4, 4e4), .damping = 1.0});
  m.add<GearMesh>("mesh", {"pinion", "camshaft"},
                  {.base_radius_1 = 0.03,
                   .base_radius_2 = 0.06,
                   .stiffness = between(5e7, 2e8),
                   .normal_backlash = between(5e-5, 2e-4),
                   .damping = between(500.0, 5000.0)});
  m.add<AbsoluteDamper>("drag", {"throw_1"}, {.damping = 1.0});
  m.add<AbsoluteDamper>("cam_drag", {"cam"}, {.damping = 0.5});
  m.add<Dashpot>("load", {"flywheel"}, {.damping = 2.0});
  GasPressure::Params gas{.angle = {deg(0), deg(4), deg(11), deg(30), deg(80), deg(140), deg(360), deg(660)},
                          .pressure = {70e5, 88e5, 60e5, 22e5, 6e5, 2e5, 1e5, 14e5},
                          .interpolation = seed % 2 == 0 ? Interpolation::linear : Interpolation::cubic};
  m.add<EngineCylinders>("engine", {"throw_1", "throw_2"},
                         {.bore = 0.08,
                          .stroke = 0.09,
                          .rod = 0.15,
                          .oscillating_mass = 0.8,
                          .firing_angles = EngineCylinders::even_firing("1-2", 4, deg(10)),
                          .gas = gas,
                          .crankcase_pressure = 1e5});
  m.add<EngineOrderTorque>("valves", {"cam"},
                           {.harmonics = {{4.0, between(10.0, 60.0), 0.3}, {12.5, between(1.0, 8.0), 1.0}},
                            .mean = -8.0,
                            .twist_feedback = seed % 3 != 0});
  m.add<CamTorque>(
      "pump", {"camshaft"},
      {.angle_table = PeriodicTable({0.0, 0.2, 0.45, 0.5, 0.9}, {0.0, -20.0, 25.0, 4.0, 0.0}, kTwoPi / 4.0),
       .twist_feedback = true,
       .interpolation = seed % 4 < 2 ? Interpolation::linear : Interpolation::cubic});
  m.set_reference("flywheel", constant_speed(between(120.0, 250.0)));
  return m.build();
}

}  // namespace

TEST_CASE("Smooth loads as series, kinks and a mesh with damping together: the motion of Runge-Kutta",
          "[exact][once]") {
  constexpr double kEnd = 0.02;
  long changes = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const System system = engine_with_camshaft(seed);
    State exact = State::initial(system), other = exact;
    const std::vector<std::string> channels{"cam.angle_rad", "throw_1.speed_rad_per_s"};
    Recorder shown(system, channels, kEnd / 40.0), reference(system, channels, kEnd / 40.0);
    const RunSummary run = propagate(system, {.tolerance = 1e-9, .t_end = kEnd}, exact, {&shown});
    const RunSummary known = run_method(system, {.name = "dormand_prince", .tolerance = 1e-12},
                                        {.t_end = kEnd}, other, {&reference});
    REQUIRE(run.ok());
    REQUIRE(known.ok());
    INFO("seed " << seed << ": " << run.steps << " steps, " << run.contact_changes << " contact changes");
    CHECK((exact.z - other.z).lpNorm<Eigen::Infinity>() < 2e-9 * other.z.lpNorm<Eigen::Infinity>());
    CHECK((exact.v - other.v).lpNorm<Eigen::Infinity>() < 2e-8 * other.v.lpNorm<Eigen::Infinity>());
    CHECK(std::abs(run.energy.relative_error()) < 1e-8);
    REQUIRE(shown.times().size() == reference.times().size());
    for (std::size_t c = 0; c < channels.size(); ++c) {
      double largest = 0.0, off = 0.0;
      for (std::size_t i = 0; i < shown.times().size(); ++i) {
        largest = std::max(largest, std::abs(reference.samples(c)[i]));
        off = std::max(off, std::abs(shown.samples(c)[i] - reference.samples(c)[i]));
      }
      INFO(channels[c]);
      CHECK(off < 2e-8 * largest);
    }
    changes += run.contact_changes;
  }
  CHECK(changes > 20);
}

TEST_CASE("Moments of a curved force behind a knot: in closed form along a straight path") {
  // theta = 0.1 + 0.4 s passes 0.22 at s = 0.3; the force c_1 x + c_2 x^2 + c_3 x^3 of x = 0.4 u, u = s - 0.3.
  const std::vector<double> force{3.0, -7.0, 11.0};
  const double place = 0.3, rate = 0.4, end = 0.9, r = end - place;
  KinkMoments kinks;
  const PlacedLoad load = load_on(1, 0.1);
  kinks.add(load, 0.22, force, 0.1 + 0.4 * end);
  constexpr int kDegree = 6, kStride = 8;
  std::vector<double> columns(2 * kStride);
  columns[kStride + 1] = rate;
  kinks.expand(columns.data(), kStride, 2, 3, {});
  const auto moments = kinks.find_moments(end, kDegree, 8, 3);
  CHECK(kinks.place(0) == Approx(place).epsilon(1e-9));
  for (int j = 0; j <= kDegree; ++j) {
    double truth = 0.0;  // int_0^r (r - u)^j/j! u^q du = q! r^(j+q+1)/(j+q+1)!
    for (int q = 1; q <= 3; ++q)
      truth += force[static_cast<std::size_t>(q - 1)] * std::pow(rate, q) * std::tgamma(q + 1) *
               std::pow(r, j + q + 1) / std::tgamma(j + q + 2);
    CHECK(moments.values[j * moments.step] == Approx(truth).epsilon(1e-12));
  }
  const double x = rate * r;
  const KinkMoments::Force f = kinks.force(0, x);
  CHECK(f.value == Approx(3.0 * x - 7.0 * x * x + 11.0 * x * x * x));
  CHECK(f.slope == Approx(3.0 - 14.0 * x + 33.0 * x * x));
  CHECK(f.integral == Approx(1.5 * x * x - 7.0 / 3.0 * x * x * x + 2.75 * x * x * x * x));
}
