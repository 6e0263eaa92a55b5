// LateralGearMesh: torsion and motion along the line of action, against closed forms.
#include <drev/core/channel.hpp>
#include <drev/core/system.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/modes/modes.hpp>
#include <drev/solvers/run/recorder.hpp>
#include <drev/solvers/statics.hpp>

#include <algorithm>
#include <cmath>

#include "tests/catch.hpp"
#include "tests/unit/elements/checks.hpp"

using namespace drev;

namespace {

constexpr double kRadius = 0.05, kInertia = 0.01, kMass = 8.0, kMesh = 3e8, kBearing = 2e8;

/// Two like gears on like bearings.
Model like_gears(LateralGearMesh::Params mesh) {
  Model m("gears on bearings");
  m.add_node("gear_1"), m.add_node("gear_2");
  m.add_node("centre_1", NodeKind::translational);
  m.add_node("centre_2", NodeKind::translational);
  for (const char* n : {"1", "2"}) {
    const std::string gear = std::string("gear_") + n, centre = std::string("centre_") + n;
    m.add<Inertia>("J_" + gear, {gear}, {.inertia = kInertia});
    m.add<Inertia>("m_" + centre, {centre}, {.inertia = kMass});
    m.add<GroundSpring>("bearing_" + centre, {centre}, {.stiffness = kBearing});
  }
  m.add<LateralGearMesh>("mesh", {"gear_1", "gear_2", "centre_1", "centre_2"}, std::move(mesh));
  return m;
}

LateralGearMesh::Params closed_mesh() {
  return {.base_radius_1 = kRadius, .base_radius_2 = kRadius, .stiffness = kMesh};
}

}  // namespace

TEST_CASE(
    "Gears on bearings: modes of two like gears in closed form, and with rigid bearings the gear mesh") {
  const System system = like_gears(closed_mesh()).build();
  // U = r (theta_1 + theta_2), Y = y_1 + y_2: (2 k - m_e w^2)(2 k + k_b - m w^2) = 4 k^2, m_e = J/r^2; y_1 - y_2 on the
  // bearings alone; the pair turns freely.
  const double m_e = kInertia / (kRadius * kRadius), k = kMesh;
  const double a = m_e * kMass, b = -(2.0 * k * kMass + (2.0 * k + kBearing) * m_e), c = 2.0 * k * kBearing;
  const double low = (-b - std::sqrt(b * b - 4.0 * a * c)) / (2.0 * a),
               high = (-b + std::sqrt(b * b - 4.0 * a * c)) / (2.0 * a);
  std::vector<double> expected{std::sqrt(low), std::sqrt(kBearing / kMass), std::sqrt(high)};
  std::sort(expected.begin(), expected.end());
  const ModeSet modes = solve_modes(system, {.count = 3});
  CHECK(modes.rigid_modes == 1);
  for (std::size_t i = 0; i < 3; ++i) CHECK(hz(modes.frequency_Hz[i]) == Approx(expected[i]).epsilon(1e-9));
  // Held centres: w^2 = 2 k r^2/J, that of a gear mesh.
  Model held = like_gears(closed_mesh());
  held.hold("centre_1"), held.hold("centre_2");
  CHECK(hz(solve_modes(held.build(), {.count = 1}).frequency_Hz[0]) ==
        Approx(std::sqrt(2.0 * k * kRadius * kRadius / kInertia)).epsilon(1e-9));
}

TEST_CASE("Gears on bearings: the centres carry the mesh's force, an internal pair's go the same way") {
  for (const bool internal : {false, true}) {
    LateralGearMesh::Params p = closed_mesh();
    p.internal = internal;
    if (internal) p.base_radius_2 = 3.0 * kRadius;
    Model m = like_gears(p);
    m.hold("gear_2");
    m.add<AppliedTorque>("load", {"gear_1"}, {.table = TimeTable({0.0}, {100.0})});
    const System system = m.build();
    const double force = 100.0 / kRadius, sign = internal ? -1.0 : 1.0;
    const Vector z = solve_static(system).state.z;
    const auto at = [&](const char* node) { return z[system.node_map(system.node(node)).unknown]; };
    CHECK(at("centre_1") == Approx(-force / kBearing).epsilon(1e-9));
    CHECK(at("centre_2") == Approx(-sign * force / kBearing).epsilon(1e-9));
    CHECK(at("gear_1") * kRadius == Approx(force / kMesh + 2.0 * force / kBearing).epsilon(1e-9));
  }
}

TEST_CASE("Gears on bearings with backlash rattle alike by exact propagation and by steps, energy closes") {
  LateralGearMesh::Params p = closed_mesh();
  p.normal_backlash = 60e-6;
  p.damping = 2e3;
  p.damping_law = MeshDamping::limited;
  Model m = like_gears(p);
  m.set_reference("gear_1", constant_speed(100.0));
  m.add<AppliedTorque>("drive", {"gear_1"}, {.table = TimeTable({0.0}, {20.0})});
  m.add<AppliedTorque>("swing", {"gear_2"}, {.harmonics = {{300.0, 60.0, 0.0}}});
  m.add<Dashpot>("drag", {"gear_2"}, {.damping = 0.2});
  const System system = m.build();
  CHECK(system.ratio(system.node("gear_2")) == Approx(-1.0));
  CHECK(system.ratio(system.node("centre_1")) == 0.0);
  CHECK(find_channel(system, "mesh.force_N").unit() == "N");
  State exact = State::initial(system), stepped = exact;
  const RunSummary run =
      propagate(system, {.tolerance = 1e-11, .t_end = 0.01, .energy_tolerance = 1e-8}, exact);
  CHECK(run.ok());
  CHECK(run.contact_changes > 4);
  CHECK(run_method(system, {.step = 2e-8}, {.t_end = 0.01}, stepped).ok());
  for (Eigen::Index i = 0; i < exact.z.size(); ++i)
    CHECK(std::abs(exact.z[i] - stepped.z[i]) < 2e-4 * exact.z.lpNorm<Eigen::Infinity>());
}

TEST_CASE("Gears on bearings: parameters are the gear mesh's, the nodes' kinds are told") {
  CHECK(check_element(LateralGearMesh(closed_mesh()), 4).failures == std::vector<std::string>{});
  CHECK(test::contains(test::findings(LateralGearMesh({})), "stiffness"));
  Model m("wrong");
  for (const char* n : {"a", "b", "c", "d"}) {
    m.add_node(n);
    m.add<Inertia>(std::string("J_") + n, {n}, {.inertia = 1.0});
  }
  m.add<LateralGearMesh>("mesh", {"a", "b", "c", "d"}, closed_mesh());
  CHECK_THROWS_AS(m.build(), ModelError);
}
