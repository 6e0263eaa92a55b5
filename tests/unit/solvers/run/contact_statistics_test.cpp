// Impact speeds, forces and rattle against motions between stops that have a closed form.
// Covers solvers/run/distribution.hpp.
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/run/contact_statistics.hpp>
#include <drev/solvers/run/peaks.hpp>

#include <cmath>

#include "core/dense/factorization.hpp"
#include "tests/catch.hpp"

using namespace drev;

namespace {

constexpr double kBin = 1.0219;  // 2^(1/32)

void check_all(const Distribution& d, long count, double value, double tolerance) {
  CHECK(d.count() == count);
  CHECK(d.mean() == Approx(value).epsilon(tolerance));
  CHECK(d.largest() == Approx(value).epsilon(tolerance));
  for (const double part : {0.0, 0.5, 0.9, 1.0}) {
    CHECK(d.quantile(part) <= value * (1.0 + tolerance));
    CHECK(d.quantile(part) >= value / kBin);
  }
}

}  // namespace

TEST_CASE("Quantiles of a distribution are within half a bin of the value of that rank") {
  Distribution all, low, high;
  double sum = 0.0;
  for (int i = 1; i <= 1000; ++i) {
    const double value = 1e-6 * std::pow(i, 2.3);
    all.add(value);
    (i <= 300 ? low : high).add(value);
    sum += value;
  }
  CHECK(all.count() == 1000);
  CHECK(all.mean() == Approx(sum / 1000).epsilon(1e-14));
  CHECK(all.largest() == 1e-6 * std::pow(1000, 2.3));
  low.add(high);
  for (const int rank : {1, 10, 500, 900, 990, 1000}) {
    const double value = 1e-6 * std::pow(rank, 2.3);
    CHECK(all.quantile(rank / 1000.0) <= value * kBin);
    CHECK(all.quantile(rank / 1000.0) >= value / kBin);
    CHECK(low.quantile(rank / 1000.0) == all.quantile(rank / 1000.0));
  }
  CHECK(low.count() == 1000);
  Distribution none, zeros;
  CHECK(none.quantile(0.5) == 0.0);
  CHECK(none.mean() == 0.0);
  zeros.add(0.0);
  zeros.add(2.0);
  CHECK(zeros.quantile(0.5) == 0.0);
  CHECK(zeros.quantile(1.0) == Approx(2.0).epsilon(0.022));
}

TEST_CASE("A contact that begins on its flank counts with every method, one that leaves it does not") {
  // From the edge x = b: outwards through half a swing, across the gap, half a swing on the other side; or inwards.
  const double mass = 2.0, k = 5000.0, b = 0.5, v = 1.0, half = kTwoPi / 2.0 / std::sqrt(k / mass);
  for (const double direction : {1.0, -1.0}) {
    Model m("from the edge");
    m.add_node("mass", NodeKind::translational);
    m.add<Inertia>("J", {"mass"}, {.inertia = mass});
    m.add<PolylineSpring>("stops", {"mass"}, PolylineSpring::dead_band(k, b));
    m.set_initial("mass", b, direction * v);
    const System system = m.build();
    for (const Method& method :
         {Method{.name = kExact, .tolerance = 1e-10}, Method{.name = "dormand_prince", .tolerance = 1e-10}}) {
      INFO(method.name << ", direction " << direction);
      ContactStatistics contacts(system);
      ContactEvents events(system);
      REQUIRE(run_method(system, method, {.t_end = 2.0 * b / v + 1.5 * half}, {&contacts, &events}).ok());
      const ContactRecord& r = contacts.records()[0];
      CHECK(r.front_impacts == (direction > 0.0 ? 1 : 0));
      CHECK(r.back_impacts == 1);
      CHECK(r.front_speed.largest() == Approx(direction > 0.0 ? v : 0.0).margin(1e-6));
      CHECK(events.all().size() == (direction > 0.0 ? 3u : 2u));
      CHECK(events.all()[0].made);
      CHECK(events.all()[0].t == Approx(direction > 0.0 ? 0.0 : 2.0 * b / v).margin(1e-6));
    }
  }
}

TEST_CASE("A mass thrown to and fro between two stops meets each at its speed") {
  // v in the gap of 2 b, half a swing in each stop: period 2 pi/w + 4 b/v, largest force v sqrt(k m).
  const double mass = 2.0, k = 5000.0, b = 0.01, v = 0.7;
  Model m("stops");
  m.add_node("mass", NodeKind::translational);
  m.add<Inertia>("J", {"mass"}, {.inertia = mass});
  m.add<PolylineSpring>("stops", {"mass"}, PolylineSpring::dead_band(k, b));
  m.set_initial("mass", 0.0, v);
  const System system = m.build();
  const double w = std::sqrt(k / mass), period = kTwoPi / w + 4 * b / v;
  const int periods = 25;
  {
    ContactStatistics contacts(system, true);
    REQUIRE(propagate(system, {.t_end = periods * period}, {&contacts}).ok());
    const ContactRecord& r = contacts.records()[0];
    CHECK(r.front_impacts == periods);
    CHECK(r.back_impacts == periods);
    check_all(r.front_speed, periods, v, 1e-10);
    check_all(r.back_speed, periods, v, 1e-10);
    // The cubic between points of exact propagation: 2e-5 of the amplitude.
    check_all(r.front_force, periods, v * std::sqrt(k * mass), 2e-5);
    check_all(r.back_force, periods, v * std::sqrt(k * mass), 2e-5);
    check_all(r.speed(), 2 * periods, v, 1e-10);
    CHECK(r.time_separated == Approx(periods * 4 * b / v).epsilon(1e-9));
    CHECK(r.impact_energy == Approx(2 * periods * 0.5 * mass * v * v).epsilon(1e-10));
    CHECK(r.rattle_index(periods * period) == Approx(mass * v * v / period).epsilon(1e-10));
  }
  ContactStatistics stepped(system);  // the speed is interpolated in the step that passes the edge
  REQUIRE(run_method(system, {.step = 1e-5}, {.t_end = periods * period}, {&stepped}).ok());
  check_all(stepped.records()[0].speed(), 2 * periods, v, 1e-4);
}

TEST_CASE("A mass that falls on one flank: speed sqrt(2 g h), force m g + sqrt((m g)^2 + k m v^2)") {
  const double mass = 0.5, k = 2e4, g = 9.81, height = 0.05, b = 0.1;
  Model m("drop");
  m.add_node("mass", NodeKind::translational);
  m.add<Inertia>("J", {"mass"}, {.inertia = mass});
  m.add<PolylineSpring>("stops", {"mass"}, PolylineSpring::dead_band(k, b));
  m.add<AppliedTorque>("weight", {"mass"}, {.torque = [=](double) { return mass * g; }});
  m.set_initial("mass", b - height, 0.0);
  const System system = m.build();
  const double v = std::sqrt(2 * g * height), w = std::sqrt(k / mass);
  // Half a swing and twice the way from the flank to its middle.
  const double contact = kPi / w + 2 / w * std::atan(g / (w * v)), period = 2 * v / g + contact;
  ContactStatistics contacts(system, true);
  REQUIRE(propagate(system, {.t_end = 10 * period}, {&contacts}).ok());
  const ContactRecord& r = contacts.records()[0];
  CHECK(r.back_impacts == 0);
  check_all(r.front_speed, 10, v, 1e-9);
  const double weight = mass * g;
  check_all(r.front_force, 10, weight + std::sqrt(weight * weight + k * mass * v * v), 2e-5);
  CHECK(r.time_separated == Approx(10 * 2 * v / g).epsilon(1e-8));
}

TEST_CASE("A force that jumps where the contact is made is its largest, beside a load that is projected") {
  // J x'' = A cos(w t) in the gap; the force at the flank, c x', decays behind it.
  const double inertia = 2.0, c = 50.0, half = 0.5, x = 0.25, v = 5.0, load = 5.0, w = 2.0 * kTwoPi;
  Model m("jump");
  m.add_node("a");
  m.add<Inertia>("J", {"a"}, {.inertia = inertia});
  m.add<DeadBandCoupling>(
      "c", {"a"},
      {.stiffness = 10.0, .gap = 2.0 * half, .damping = c, .damping_law = MeshDamping::contact_only});
  m.add<AppliedTorque>("load", {"a"}, {.harmonics = {{.order = 2.0, .amplitude = load}}});
  m.set_initial("a", x, v);
  const auto rate = [&](double t) { return v + load / (inertia * w) * std::sin(w * t); };
  double made = 0.05;
  for (int i = 0; i < 20; ++i)
    made -= (x + v * made + load / (inertia * w * w) * (1.0 - std::cos(w * made)) - half) / rate(made);
  const System system = m.build();
  State state = State::initial(system);
  Peaks peaks({find_channel(system, "c.torque_Nm")});
  ContactStatistics contacts(system);
  REQUIRE(propagate(system, {.t_end = 0.2}, state, {&peaks, &contacts}).ok());
  CHECK(peaks.peaks()[0].max == Approx(c * rate(made)).epsilon(1e-9));
  CHECK(contacts.records()[0].largest_force == Approx(c * rate(made)).epsilon(1e-9));
}

TEST_CASE("Equivalent mass of a contact: 1/(b^T M^-1 b), lumped and consistent") {
  Model lumped("lumped");
  for (const char* name : {"a", "b"}) lumped.add_node(name);
  lumped.add<Inertia>("J_a", {"a"}, {.inertia = 0.3});
  lumped.add<Inertia>("J_b", {"b"}, {.inertia = 2.0});
  const GearMesh::Params mesh{
      .base_radius_1 = 0.05, .base_radius_2 = 0.12, .stiffness = 1e8, .normal_backlash = 1e-4};
  lumped.add<GearMesh>("mesh", {"a", "b"}, mesh);
  CHECK(equivalent_masses(lumped.build())[0] ==
        Approx(1.0 / (0.05 * 0.05 / 0.3 + 0.12 * 0.12 / 2.0)).epsilon(1e-14));

  // A shaft of two ends behind gear b: M = J/6 [2 1; 1 2] on (b, c), beside J_b.
  lumped.add_node("c");
  lumped.add<DistributedShaft>(
      "shaft", {"b", "c"}, {.shear_modulus = 8e10, .density = 7850, .outer_diameter = 0.1, .length = 0.5});
  const System system = lumped.build();
  REQUIRE_FALSE(system.mass_is_diagonal());
  const Eigen::MatrixXd mass = [&] {
    SparseMatrix a = system.pattern();
    std::copy(system.mass_values().begin(), system.mass_values().end(), a.valuePtr());
    return Eigen::MatrixXd(a);
  }();
  Vector b = Vector::Zero(system.size());
  b[system.node_map(system.node("a")).unknown] = 0.05;
  b[system.node_map(system.node("b")).unknown] = 0.12;
  CHECK(equivalent_masses(system)[0] == Approx(1.0 / b.dot(ldlt_solve(mass, b))).epsilon(1e-13));
}

TEST_CASE("Two inertias that move together at the edge of their gap meet no flank") {
  Model m("together");
  for (const char* node : {"a", "b"}) m.add_node(node);
  m.add<Inertia>("J_a", {"a"}, {.inertia = 2.0});
  m.add<Inertia>("J_b", {"b"}, {.inertia = 1.0});
  PolylineSpring::Params gap = PolylineSpring::dead_band(100.0, 1.0);
  gap.damping = 1.0;
  m.add<PolylineSpring>("gap", {"a", "b"}, gap);
  m.set_initial("a", 0.0, -1.0);
  m.set_initial("b", 1.0, -1.0);
  const System system = m.build();
  ContactStatistics contacts(system, true);
  REQUIRE(
      run_method(system, {.name = "dormand_prince", .tolerance = 1e-8}, {.t_end = 1.0}, {&contacts}).ok());
  CHECK(contacts.records()[0].impacts() == 0);
}

TEST_CASE("Impacts between prescribed nodes have no energy that is known") {
  Model m("prescribed");
  for (const char* node : {"a", "b", "z"}) m.add_node(node);
  m.given_motion("a", {.at = [](double t) {
                   return MotionPoint{std::sin(kTwoPi * t), kTwoPi * std::cos(kTwoPi * t),
                                      -kTwoPi * kTwoPi * std::sin(kTwoPi * t)};
                 }});
  m.hold("b");
  m.add<Inertia>("J", {"z"}, {.inertia = 1.0});
  m.add<PolylineSpring>("gap", {"a", "b"}, PolylineSpring::dead_band(1e4, 0.1));
  const System system = m.build();
  ContactStatistics contacts(system, true);
  REQUIRE(run_method(system, {.step = 1e-3}, {.t_end = 1.0}, {&contacts}).ok());
  CHECK(contacts.records()[0].impacts() > 1);
  CHECK(std::isinf(contacts.records()[0].impact_energy));
}
