// Internal nodes that move along a line: a pinion with the mass of its rack, free or on a spring to ground.
#include <drev/core/channel.hpp>
#include <drev/core/law_element.hpp>
#include <drev/core/system.hpp>
#include <drev/core/verify.hpp>
#include <drev/elements/couplings/torsional_damper.hpp>
#include <drev/elements/distributed_shaft.hpp>
#include <drev/elements/inertia.hpp>
#include <drev/elements/machines/speed_governor.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/modes/modes.hpp>
#include <drev/solvers/run/recorder.hpp>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <numbers>

#include "tests/catch.hpp"
#include "tests/problems/findings.hpp"

using namespace drev;
using problems::only_fault;

namespace {

struct ToothLaw {
  double k;  ///< N/m
  ScalarResponse operator()(const ScalarInput& in) const {
    return {.y = k * in.x, .dy_dx = k, .stored_energy = 0.5 * k * in.x * in.x};
  }
};

/// A pinion of radius r [m] drives a rack of mass m [kg], its internal node, through teeth of stiffness k
/// [N/m]: x = r theta - s. A spring of k_ground [N/m] may hold the rack to ground.
class Rack final : public Element {
 public:
  struct Params {
    double r, m, k, k_ground = 0.0;
    bool mixes = true;
  };
  explicit Rack(Params p) : p_(p), teeth_(ToothLaw{p.k}) {}
  std::string_view type() const override { return "rack"; }
  int min_nodes() const override { return 1; }
  std::vector<NodeKind> internal_nodes() const override { return {NodeKind::translational}; }
  bool mixes_kinds() const override { return p_.mixes; }
  void check(ParameterCheck& check) const override { check.positive("m", p_.m, "kg"); }
  void describe(int, Terms& terms) const override {
    terms.mass(1, 1) = p_.m;
    terms.stiffness(1, 1) = p_.k_ground;
    LocalRow b(2);
    b << p_.r, -1.0;
    terms.scalars.push_back({.b = b, .force = &teeth_});
    terms.speed_ratio_constraints.push_back({.b = b});
    if (p_.k_ground > 0.0) {
      LocalRow held(2);
      held << 0.0, 1.0;
      terms.speed_ratio_constraints.push_back({.b = held});
    }
  }

 private:
  Params p_;
  LawForce<ToothLaw> teeth_;
};

constexpr double kInertia = 0.02, kRadius = 0.05, kMass = 3.0, kTeeth = 4e6;  // kg m^2, m, kg, N/m

Model pinion_with(const Rack::Params& rack) {
  Model m("rack and pinion");
  m.add_node("pinion");
  m.add<Inertia>("J", {"pinion"}, {.inertia = kInertia});
  m.add<Rack>("rack", {"pinion"}, rack);
  return m;
}

}  // namespace

TEST_CASE("An internal node may be translational: channels, rules and checks are those of its kind") {
  const Rack::Params params{.r = kRadius, .m = kMass, .k = kTeeth};
  CHECK(check_element(Rack(params), 1).text().empty());
  const System s = pinion_with(params).build();
  CHECK(s.node_kind(s.node("rack_1")) == NodeKind::translational);
  const std::vector<std::pair<std::string, std::string>> units{{"rack_1.position_m", "m"},
                                                               {"rack_1.velocity_m_per_s", "m/s"},
                                                               {"rack_1.acceleration_m_per_s2", "m/s^2"},
                                                               {"rack.force_N", "N"},
                                                               {"rack.deflection_m", "m"}};
  for (const auto& [name, unit] : units) CHECK(find_channel(s, name).unit() == unit);
  CHECK(only_fault(pinion_with({.r = kRadius, .m = kMass, .k = kTeeth, .mixes = false}),
                   {"node = rack_1", "is translational", "a rack joins nodes of one kind"}));
}

TEST_CASE("A free rack and pinion: one rigid motion and omega^2 = k (r^2/J + 1/m)") {
  const System s = pinion_with({.r = kRadius, .m = kMass, .k = kTeeth}).build();
  const ModeSet modes = solve_modes(s);
  CHECK(modes.rigid_modes == 1);
  REQUIRE(modes.count() == 1);
  const double omega = std::sqrt(kTeeth * (kRadius * kRadius / kInertia + 1.0 / kMass));
  CHECK(modes.omega(0) == Approx(omega).epsilon(1e-12));
}

TEST_CASE("A rack on a spring: both frequencies are the roots of the free bodies' equation") {
  const double k_ground = 1e6;
  const ModeSet modes =
      solve_modes(pinion_with({.r = kRadius, .m = kMass, .k = kTeeth, .k_ground = k_ground}).build());
  // J theta'' = -r k (r theta - s), m s'' = k (r theta - s) - k_ground s: with lambda = omega^2
  // lambda^2 - (k r^2/J + (k + k_ground)/m) lambda + k r^2 k_ground/(J m) = 0.
  const double sum = kTeeth * kRadius * kRadius / kInertia + (kTeeth + k_ground) / kMass;
  const double product = kTeeth * kRadius * kRadius * k_ground / (kInertia * kMass);
  const double root = std::sqrt(0.25 * sum * sum - product);
  CHECK(modes.rigid_modes == 0);
  REQUIRE(modes.count() == 2);
  CHECK(modes.omega(0) == Approx(std::sqrt(product / (0.5 * sum + root))).epsilon(1e-12));
  CHECK(modes.omega(1) == Approx(std::sqrt(0.5 * sum + root)).epsilon(1e-12));
}

TEST_CASE("A rack pushed off: momentum and swing by closed form, by steps and by exact propagation") {
  Model m = pinion_with({.r = kRadius, .m = kMass, .k = kTeeth});
  const double speed = 2.0;  // rad/s of the pinion at the start; the rack is at rest
  m.set_initial("pinion", 0.0, speed);
  const System s = m.build();
  const double omega = std::sqrt(kTeeth * (kRadius * kRadius / kInertia + 1.0 / kMass));
  const double t_end = 2.25 * 2.0 * std::numbers::pi / omega;
  for (const Method& method :
       {Method{.name = "exact", .tolerance = 1e-10}, Method{.name = "sdirk4", .tolerance = 1e-8}}) {
    INFO(to_text(method));
    Recorder recorder(s, {"rack_1.velocity_m_per_s", "pinion.speed_rad_per_s", "rack.force_N"}, t_end / 9);
    REQUIRE(run_method(s, method, {.t_end = t_end}, {&recorder}).ok());
    REQUIRE(recorder.times().size() == 10);
    for (std::size_t i = 0; i < recorder.times().size(); ++i) {
      // Nothing pushes from outside: J theta'/r + m s' stays J theta'(0)/r.
      const double rack = recorder.samples(0)[i], pinion = recorder.samples(1)[i];
      const double start = kInertia * speed / kRadius;
      CHECK(kInertia * pinion / kRadius + kMass * rack == Approx(start).epsilon(1e-6));
      const double force = kTeeth * kRadius * speed / omega * std::sin(omega * recorder.times()[i]);
      CHECK(recorder.samples(2)[i] == Approx(force).margin(1e-5 * kTeeth * kRadius * speed / omega));
    }
  }
}

TEST_CASE(
    "Internal nodes that nothing states start where no force acts on them, beside those that are stated") {
  Model m("shaft and damper");
  for (const char* name : {"a", "b"}) {
    m.add_node(name);
    m.add<Inertia>(std::string("J_") + name, {name}, {.inertia = 1.0});
  }
  m.add<DistributedShaft>("shaft", {"a", "b"},
                          {.shear_modulus = 8e10,
                           .density = 7850.0,
                           .outer_diameter = 0.1,
                           .length = 1.0,
                           .segments = 4,
                           .mass = SegmentMass::lumped});
  m.add<TorsionalDamper>("oil", {"b"}, {.ring_inertia = 0.5, .damping = 2.0});
  m.add<TorsionalDamper>("rubber", {"b"},
                         {.ring_inertia = 0.5, .spring = {.stiffness = 10.0}, .damping = 2.0});
  m.set_initial("a", 1.0, 4.0);
  m.set_initial("b", 5.0, 8.0);
  const System s = m.build();
  const auto starts = [&](const char* node, double deviation, double rate) {
    INFO(node);
    const int k = s.node_map(s.node(node)).unknown;
    CHECK(s.initial_deviation()[k] == Approx(deviation).epsilon(1e-12));
    CHECK(s.initial_rate()[k] == Approx(rate).epsilon(1e-12));
  };
  starts("shaft_1", 2.0, 5.0);
  starts("shaft_2", 3.0, 6.0);
  starts("shaft_3", 4.0, 7.0);
  starts("oil_1", 0.0, 8.0);  // no angle is at rest beside another
  starts("rubber_1", 5.0, 8.0);
}

TEST_CASE("A governor with an actuator starts with the torque of its integral, by closed form") {
  // T tau' + tau = K_p q' + K_i q, J q'' = -tau: (s + 1)(s + 2)(s + 7) = s^3 + 10 s^2 + 23 s + 14.
  Model m("governed");
  m.add_node("a");
  m.add<Inertia>("J", {"a"}, {.inertia = 1.0});
  m.add<SpeedGovernor>("governor", {"a"},
                       {.proportional_gain = 2.3, .integral_gain = 1.4, .actuator_lag = 0.1});
  const double q_0 = 1.0, w_0 = 0.5;
  m.set_initial("a", q_0, w_0);
  const System s = m.build();
  Recorder recorder(s, {"a.angle_rad", "governor.torque_Nm"}, 0.25);
  REQUIRE(run_method(s, {.name = "exact", .tolerance = 1e-10}, {.t_end = 2.0}, {&recorder}).ok());
  Eigen::Matrix3d of;
  of << 1.0, 1.0, 1.0, -1.0, -2.0, -7.0, 1.0, 4.0, 49.0;
  const Eigen::Vector3d part = of.inverse() * Eigen::Vector3d(q_0, w_0, -1.4 * q_0);
  for (std::size_t i = 0; i < recorder.times().size(); ++i) {
    const double t = recorder.times()[i];
    const Eigen::Vector3d e(std::exp(-t), std::exp(-2.0 * t), std::exp(-7.0 * t));
    CHECK(recorder.samples(0)[i] == Approx(part.dot(e)).margin(1e-9));
    CHECK(recorder.samples(1)[i] ==
          Approx(-part.dot(e.cwiseProduct(Eigen::Vector3d(1.0, 4.0, 49.0)))).margin(1e-9));
  }
}
