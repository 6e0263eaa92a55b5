// Assembler: loads, nominal motion, given motions, tangents, contact states, products.
#include <drev/core/assembler.hpp>
#include <drev/elements/catalogue.hpp>

#include <cmath>

#include "tests/catch.hpp"
#include "tests/problems/dense.hpp"
#include "tests/problems/general_elements.hpp"

using namespace drev;
using problems::dense;

namespace {

void add_disc(Model& m, const char* name, double inertia) {
  m.add_node(name);
  m.add<Inertia>(std::string("J_") + name, {name}, {.inertia = inertia});
}

/// Shafts, two meshes with backlash, a stop, cam and engine torques, a general element with history;
/// one node driven, one tied by an ideal gear.
Model everything() {
  Model m("everything");
  add_disc(m, "crank", 2.0);
  add_disc(m, "idler", 0.5);
  add_disc(m, "cam", 0.8);
  add_disc(m, "tail", 0.3);
  add_disc(m, "pump", 0.1);
  add_disc(m, "shaker", 1.0);
  m.add<GearMesh>("mesh_1", {"crank", "idler"},
                  {.base_radius_1 = 0.1,
                   .base_radius_2 = 0.2,
                   .stiffness = 5e4,
                   .normal_backlash = 2e-3,
                   .damping = 30.0});
  m.add<GearMesh>("mesh_2", {"idler", "cam"},
                  {.base_radius_1 = 0.2, .base_radius_2 = 0.15, .stiffness = 4e4});
  m.add<ShaftSpring>("shaft", {"cam", "tail"}, {.stiffness = 300.0, .damping = 2.0});
  m.add<PolylineSpring>("stop", {"cam", "tail"}, PolylineSpring::dead_band(500.0, 0.02, 0.4));
  m.add<IdealGear>("gear", {"tail", "pump"}, {.ratio = -3.0});
  m.add<PolylineSpring>("coupling", {"crank", "shaker"}, {.x = {-1, 0, 1}, .y = {-80, 0, 40}});
  m.add<CamTorque>("cam_load", {"tail"}, {.angle_table = PeriodicTable({0.0, 2.0, 4.0}, {1.0, 6.0, -3.0})});
  m.add<EngineOrderTorque>("gas", {"crank"}, {.harmonics = {{.order = 2, .amplitude = 9.0}}});
  m.add<EngineOrderTorque>("pump_load", {"pump"}, {.harmonics = {{.order = 1, .amplitude = 4.0}}});
  m.add<problems::Maxwell>("damper", {"cam", "tail"}, {.stiffness = 60.0, .damping = 5.0});
  m.add<RayleighDamping>("rayleigh", {}, {.alpha_mass = 0.2, .beta_stiffness = 1e-3});
  m.given_motion("shaker", {[](double t) {
                   return MotionPoint{0.1 * std::sin(t), 0.1 * std::cos(t), -0.1 * std::sin(t)};
                 }});
  return m;
}

}  // namespace

TEST_CASE("Run-up loads every inertia with -J n phi''") {
  Model m("run_up");
  add_disc(m, "crank", 2.0);
  add_disc(m, "wheel", 0.5);
  add_disc(m, "pump", 0.3);
  m.add<GearMesh>("mesh", {"crank", "wheel"},
                  {.base_radius_1 = 0.1, .base_radius_2 = 0.25, .stiffness = 1e8});
  m.add<IdealGear>("gear", {"wheel", "pump"}, {.ratio = 5.0});
  m.set_reference("crank", run_up(0.0, 20.0, 1.0, 5.0));  // 5 rad/s^2
  const System s = m.build();
  REQUIRE(s.size() == 2);
  Assembler a(s);
  Vector p;
  const Vector zero = Vector::Zero(2);
  a.set_time(0.5);
  a.external(zero, zero, p);
  CHECK(p.isZero(0.0));
  a.set_time(2.0);
  a.external(zero, zero, p);
  CHECK(p[0] == Approx(-2.0 * 5.0));
  // wheel n = -0.4, pump n = -2 and its deviation is 5 times the wheel's.
  CHECK(p[1] == Approx(0.5 * 0.4 * 5.0 + 5.0 * 0.3 * 2.0 * 5.0));
  CHECK(a.nominal().value == Approx(2.5));
  CHECK(a.node_angle(s.node("wheel"), zero) == Approx(-1.0));
  const Vector moved = Vector::Constant(2, 0.01);
  CHECK(a.node_angle(s.node("pump"), moved) == Approx(-5.0 + 0.05));
}

TEST_CASE("Dashpots load the mean motion") {
  Model m("drag");
  add_disc(m, "crank", 2.0);
  add_disc(m, "wheel", 0.5);
  m.add<GearMesh>("mesh", {"crank", "wheel"}, {.base_radius_1 = 0.1, .base_radius_2 = 0.2, .stiffness = 1e8});
  m.set_reference("crank", constant_speed(30.0));
  const Vector zero = Vector::Zero(2);
  Vector p;
  SECTION("to ground: -c n omega") {
    m.add<Dashpot>("bearing", {"wheel"}, {.damping = 0.2});
    const System s = m.build();
    Assembler(s).external(zero, zero, p);
    CHECK(p[0] == 0.0);
    CHECK(p[1] == Approx(0.2 * 15.0));
  }
  SECTION("between shafts of different speed: 30 and -15 rad/s") {
    m.add<Dashpot>("slip", {"crank", "wheel"}, {.damping = 0.2});
    const System s = m.build();
    Assembler(s).external(zero, zero, p);
    CHECK(p[0] == Approx(-0.2 * 45.0));
    CHECK(p[1] == Approx(0.2 * 45.0));
  }
  SECTION("a shaft's damping and Rayleigh damping do not drag") {
    add_disc(m, "disc", 1.0);
    m.add<ShaftSpring>("shaft", {"wheel", "disc"}, {.stiffness = 1.0, .damping = 7.0});
    m.add<RayleighDamping>("rayleigh", {}, {.alpha_mass = 3.0});
    const System s = m.build();
    const Vector three = Vector::Zero(3);
    Assembler(s).external(three, three, p);
    CHECK(p.lpNorm<Eigen::Infinity>() < 1e-12);
  }
}

TEST_CASE("A given motion drives its neighbours through spring, damper and shared mass") {
  Model m("shaker");
  add_disc(m, "table", 2.0);
  add_disc(m, "load", 1.0);
  m.add<DistributedShaft>("bar", {"table", "load"},
                          {.shear_modulus = 8e10, .density = 8000.0, .outer_diameter = 0.02, .length = 0.5});
  m.add<Dashpot>("slip", {"table", "load"}, {.damping = 4.0});
  m.given_motion("table", {[](double) { return MotionPoint{0.3, -2.0, 50.0}; }});
  const System s = m.build();
  // I_p = pi d^4/32; k = G I_p/L; consistent mass couples J/6.
  const double area_moment = 3.14159265358979323846 * 1.6e-7 / 32.0;
  const double k = 8e10 * area_moment / 0.5, j = 8000.0 * area_moment * 0.5;
  Vector p;
  const Vector zero = Vector::Zero(1);
  Assembler a(s);
  a.external(zero, zero, p);
  CHECK(p[0] == Approx(k * 0.3 + 4.0 * -2.0 - j / 6.0 * 50.0));
  // Standing still, the table has its place but no rate.
  a.stand_at_angle(0.0);
  a.external(zero, zero, p);
  CHECK(p[0] == Approx(k * 0.3));
}

TEST_CASE("Tangents against finite differences of the forces, in contact, apart and at angles") {
  const System s = everything().build();
  REQUIRE(s.size() == 4);
  Assembler a(s);
  const double h = 1e-6;
  for (int sample = 0; sample < 20; ++sample) {
    a.set_time(0.05 * (sample + 1));
    Vector z(4), v(4);
    for (int i = 0; i < 4; ++i) {
      z[i] = 0.03 * std::sin(1.7 * sample + 2.3 * i);
      v[i] = std::cos(2.9 * sample + 1.3 * i);
    }
    Vector history(3);
    history << 0.05 * sample, 0.01, 0.3;
    Vector values;
    a.tangent_values({0, 0, 1}, z, v, history, true, values);
    const Eigen::MatrixXd k = dense(s, values);
    a.tangent_values({0, 1, 0}, z, v, history, true, values);
    const Eigen::MatrixXd c = dense(s, values);
    a.tangent_values({2, 3, 5}, z, v, history, true, values);
    CHECK((dense(s, values) - 5 * k - 3 * c - 2 * dense(s, s.mass_values())).norm() <= 1e-12 * k.norm());
    for (int i = 0; i < 4; ++i) {
      const Vector e = Vector::Unit(4, i) * h;
      const Vector by_z =
          (problems::forces(a, z + e, v, history) - problems::forces(a, z - e, v, history)) / (2 * h);
      const Vector by_v =
          (problems::forces(a, z, v + e, history) - problems::forces(a, z, v - e, history)) / (2 * h);
      INFO("sample " << sample << ", column " << i);
      // Differences of forces of 1e3 over 1e-6 leave 1e-7 relative to the stiffest column; none of the
      // samples stands within h of a kink.
      CHECK((by_z - k.col(i)).lpNorm<Eigen::Infinity>() <= 1e-6 * k.norm());
      CHECK((by_v - c.col(i)).lpNorm<Eigen::Infinity>() <= 1e-6 * k.norm());
    }
  }
}

TEST_CASE("The loads' slopes enter the tangent on request alone") {
  Model m("cam");
  add_disc(m, "cam", 1.0);
  m.add<GroundSpring>("spring", {"cam"}, {.stiffness = 10.0});
  m.add<CamTorque>("load", {"cam"}, {.angle_table = PeriodicTable({0.0, 2.0, 4.0}, {0.0, 6.0, 0.0})});
  const System s = m.build();
  const Assembler a(s);
  Vector values;
  const Vector z = Vector::Constant(1, 1.0), v = Vector::Zero(1), none(0);
  a.tangent_values({0, 0, 1}, z, v, none, false, values);
  CHECK(dense(s, values)(0, 0) == Approx(10.0));
  a.tangent_values({0, 0, 1}, z, v, none, true, values);
  CHECK(dense(s, values)(0, 0) == Approx(10.0 - 3.0));
}

TEST_CASE("Contact closed and open") {
  Model m("pair");
  add_disc(m, "a", 1.0);
  add_disc(m, "b", 1.0);
  m.add<GearMesh>("mesh", {"a", "b"},
                  {.base_radius_1 = 0.1,
                   .base_radius_2 = 0.2,
                   .teeth_1 = 20,
                   .stiffness = MeshStiffness::step(1e4, 2e4, 1.5),
                   .normal_backlash = 1e-3,
                   .damping = 50.0});
  const System s = m.build();
  const Assembler a(s);
  Vector values;
  a.contact_values({0, 0, 1}, Contact::closed, values);
  const Eigen::MatrixXd closed = dense(s, values);
  // Mean of 1e4 and 2e4 in equal parts.
  CHECK(closed(0, 0) == Approx(1.5e4 * 0.01));
  CHECK(closed(0, 1) == Approx(1.5e4 * 0.02));
  CHECK(closed(1, 1) == Approx(1.5e4 * 0.04));
  a.contact_values({0, 1, 0}, Contact::closed, values);
  CHECK(dense(s, values)(1, 0) == Approx(50.0 * 0.02));
  a.contact_values({1, 1, 1}, Contact::open, values);
  CHECK((dense(s, values) - Eigen::MatrixXd::Identity(2, 2)).norm() == 0.0);
}

TEST_CASE("multiply() is the product with the matrix") {
  const System s = everything().build();
  const Assembler a(s);
  Vector values, out, x(4);
  x << 1.0, -2.0, 0.5, 3.0;
  a.linear_values({1.0, 0.5, 2.0}, values);
  a.multiply(values, x, out);
  CHECK((out - dense(s, values) * x).norm() <= 1e-14 * out.norm());
  a.multiply(values, Vector::Zero(4), out);
  CHECK(out.isZero(0.0));
}

TEST_CASE("Known matrices of a shaft with damping") {
  Model m("pair");
  add_disc(m, "a", 1.0);
  add_disc(m, "b", 2.0);
  m.add<ShaftSpring>("shaft", {"a", "b"}, {.stiffness = 7.0, .damping = 3.0});
  const System s = m.build();
  Vector values;
  Assembler(s).linear_values({1.0, 10.0, 100.0}, values);
  const Eigen::MatrixXd d = dense(s, values);
  CHECK(d(0, 0) == Approx(1 + 30 + 700));
  CHECK(d(1, 1) == Approx(2 + 30 + 700));
  CHECK(d(0, 1) == Approx(-30 - 700));
}
