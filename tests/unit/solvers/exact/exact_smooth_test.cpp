// Exact propagation of what is not linear in pieces: torques that are functions, of time and of speed, mesh
// stiffness by phase, transmission error, damping that grows with penetration. Against closed forms and
// against Runge-Kutta, which knows nothing of pieces, knots or projections.
// Covers solvers/exact/projected_laws.hpp, smooth_loads.hpp and tangent_load.hpp through propagate().
#include <drev/core/element.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/run/recorder.hpp>
#include <drev/solvers/stepping/step_scheme.hpp>

#include <cmath>

#include "tests/catch.hpp"
#include "tests/problems/unit_oscillator.hpp"
#include "tests/stability/runge_kutta.hpp"

using namespace drev;

namespace {

/// A pinion driven by a torque that is a function, its wheel held by a shaft to a node of constant speed.
System pair_of_gears(const GearMesh::Params& mesh) {
  Model m("pair");
  for (const char* node : {"pinion", "wheel", "load"}) m.add_node(node);
  m.constant_speed("load", -100.0);
  m.add<Inertia>("J_pinion", {"pinion"}, {.inertia = 1e-3});
  m.add<Inertia>("J_wheel", {"wheel"}, {.inertia = 2e-3});
  m.add<ShaftSpring>("shaft", {"wheel", "load"}, {.stiffness = 500.0});
  m.add<GearMesh>("mesh", {"pinion", "wheel"}, mesh);
  m.add<AppliedTorque>("drive", {"pinion"},
                       {.torque = [](double t) { return 5.0 + 8.0 * std::sin(900.0 * t); }});
  return m.build();
}

/// Torque -c omega |omega| of a fan, on the node's actual speed.
class Fan final : public Element, public Load {
 public:
  using Params = double;
  explicit Fan(double c) : c_(c) {}
  std::string_view type() const override { return "fan"; }
  int min_nodes() const override { return 1; }
  void check(ParameterCheck&) const override {}
  void describe(int, Terms& terms) const override { terms.loads.push_back({0, this}); }
  LoadResponse evaluate(const LoadInput& in) const override {
    return {.torque = -c_ * in.speed * std::abs(in.speed), .dtorque_dspeed = -2 * c_ * std::abs(in.speed)};
  }

 private:
  double c_;
};

double difference(const Vector& a, const Vector& b) {
  return (a - b).lpNorm<Eigen::Infinity>() / b.lpNorm<Eigen::Infinity>();
}

}  // namespace

TEST_CASE("Exact propagation: a torque that is a function of time") {
  // x'' + w^2 x = sin 3 t from rest: (sin 3 t - (3/w) sin w t)/(w^2 - 9), w = 2 pi.
  Model m = unit_oscillator();
  m.add<AppliedTorque>("drive", {"m"}, {.torque = [](double t) { return std::sin(3 * t); }});
  const System system = m.build();
  State state = State::initial(system);
  const RunSummary run = propagate(system, {.tolerance = 1e-12, .t_end = 20.0}, state);
  INFO(run.brief_report());
  CHECK(run.ok());
  CHECK(std::abs(run.energy.relative_error()) < 1e-12);
  const double w = kTwoPi, exact = (std::sin(60.0) - 3 / w * std::sin(20.0 * w)) / (w * w - 9);
  CHECK(state.z[0] == Approx(exact).margin(1e-13));
}

TEST_CASE("Exact propagation: a run of one step at the largest tolerance, all of which is that step's") {
  // x'' + w^2 x = sin 3 t, as above.
  Model m = unit_oscillator();
  m.add<AppliedTorque>("drive", {"m"}, {.torque = [](double t) { return std::sin(3 * t); }});
  const System system = m.build();
  const double w = kTwoPi, t = 0.3, exact = (std::sin(3 * t) - 3 / w * std::sin(w * t)) / (w * w - 9);
  for (const double tolerance : {ExactOptions::kTolerance.high, 2e-3, 1e-3}) {
    State state = State::initial(system);
    const RunSummary run = propagate(system, {.tolerance = tolerance, .t_end = t}, state);
    INFO(run.brief_report());
    CHECK(run.ok());
    CHECK(run.steps <= 3);
    CHECK(std::abs(state.z[0] - exact) < tolerance * exact);
  }
}

TEST_CASE("Exact propagation: a torque that is a function of speed") {
  // J w' = -c w^2: w = w_0/(1 + c w_0 t/J).
  Model m("fan");
  m.add_node("rotor");
  m.add<Inertia>("J", {"rotor"}, {.inertia = 2.0});
  m.add<Fan>("fan", {"rotor"}, 0.5);
  m.set_initial("rotor", 0.0, 3.0);
  const System system = m.build();
  State state = State::initial(system);
  const RunSummary run = propagate(system, {.tolerance = 1e-12, .t_end = 10.0}, state);
  INFO(run.brief_report());
  CHECK(run.ok());
  CHECK(state.v[0] == Approx(3.0 / (1 + 0.5 * 3.0 * 10.0 / 2.0)).epsilon(1e-11));
  CHECK(state.z[0] == Approx(2.0 / 0.5 * std::log(1 + 0.5 * 3.0 * 10.0 / 2.0)).epsilon(1e-11));
}

TEST_CASE("Exact propagation: meshes that are smooth, stepped or damped by penetration", "[once]") {
  const GearMesh::Params plain{.base_radius_1 = 0.05,
                               .base_radius_2 = 0.1,
                               .teeth_1 = 20,
                               .teeth_2 = 40,
                               .stiffness = 2e7,
                               .normal_backlash = 1e-4,
                               .damping = 50.0};
  const auto check = [](const char* name, const GearMesh::Params& mesh, double allowed) {
    const System system = pair_of_gears(mesh);
    State exact = State::initial(system), tight = exact, fine = exact, coarse = exact;
    const double end = 0.004;
    const RunSummary run =
        propagate(system, {.tolerance = 1e-10, .t_end = end, .energy_tolerance = 1e-10}, exact);
    INFO(name << ": " << run.brief_report());
    CHECK(run.ok());
    CHECK(propagate(system, {.tolerance = 1e-13, .t_end = end}, tight).ok());
    runge_kutta(system, end, 2e-8, fine);
    runge_kutta(system, end, 2e-7, coarse);
    INFO("against tolerance 1e-13 " << difference(exact.z, tight.z) << ", Runge-Kutta 2e-8 "
                                    << difference(exact.z, fine.z) << ", 2e-7 "
                                    << difference(exact.z, coarse.z));
    // Letting go and limiting are kinks of the law in x' that it does not tell of.
    CHECK(difference(exact.z, tight.z) < 1e-8);
    CHECK(difference(exact.z, fine.z) < allowed);
  };
  check("proportional", plain, 1e-9);
  GearMesh::Params mesh = plain;
  mesh.stiffness = MeshStiffness::fourier(2e7, {{1.0, 4e6, 0.1}, {2.0, 2e6, 0.0}});
  check("fourier, proportional", mesh, 1e-8);
  mesh.damping_law = MeshDamping::limited;
  check("fourier, limited", mesh, 1e-8);
  mesh.normal_backlash = 0.0;
  check("fourier, no backlash", mesh, 1e-12);
  // Runge-Kutta is of first order across the jumps.
  mesh = plain;
  mesh.stiffness = MeshStiffness::step(1.5e7, 2.5e7, 1.6);
  mesh.normal_backlash = 0.0;
  check("step, no backlash", mesh, 1e-6);
  mesh = plain;
  mesh.damping = 0.0;
  mesh.transmission_error = TransmissionError({{1.0, 5e-6, 0.0}});
  check("transmission error", mesh, 1e-8);
}

TEST_CASE("Exact propagation: what is recorded is on the curve, and recording changes nothing") {
  // A free oscillation, x = cos w t: one step spans many samples.
  Model m = unit_oscillator();
  m.set_initial("m", 1.0, 0.0);
  const System system = m.build();
  Recorder recorder(system, {"m.position_m"}, 0.007);
  State watched = State::initial(system), alone = watched;
  const RunSummary a = propagate(system, {.tolerance = 1e-13, .t_end = 3.0}, watched, {&recorder});
  const RunSummary b = propagate(system, {.tolerance = 1e-13, .t_end = 3.0}, alone);
  CHECK(a.steps == b.steps);
  CHECK(a.steps < 100);
  CHECK(watched.z == alone.z);
  CHECK(watched.v == alone.v);
  REQUIRE(recorder.times().size() == 429);
  for (std::size_t i = 0; i < recorder.times().size(); ++i) {
    CHECK(recorder.times()[i] == Approx(0.007 * static_cast<double>(i)).epsilon(1e-14));
    CHECK(recorder.samples(0)[i] == Approx(std::cos(kTwoPi * recorder.times()[i])).margin(1e-12));
  }
}

TEST_CASE("Exact propagation: a cam's slopes on a free mass, the only stiffness there is") {
  // Against Runge-Kutta at a step that no knot disturbs by more than the tolerance.
  Model m("free");
  m.add_node("a");
  m.add<Inertia>("J", {"a"}, {.inertia = 1.0});
  m.add<CamTorque>("cam", {"a"},
                   {.angle_table = PeriodicTable({0, 1.1, 2.5, 4, 5.2}, {50, -30, 80, 10, -60}, 6.3)});
  m.set_initial("a", 0.5, -50.0);
  const System system = m.build();
  State exact = State::initial(system), fine = exact;
  const RunSummary run =
      propagate(system, {.tolerance = 1e-11, .t_end = 3.0, .energy_tolerance = 1e-11}, exact);
  INFO(run.brief_report());
  CHECK(run.ok());
  runge_kutta(system, 3.0, 1e-5, fine);
  CHECK(std::abs(exact.z[0] - fine.z[0]) < 2e-8 * std::abs(fine.z[0]));
  CHECK(std::abs(exact.v[0] - fine.v[0]) < 2e-8 * std::abs(fine.v[0]));
}

TEST_CASE("Exact propagation: a brake that acts beyond a speed, which other torques take the train to") {
  // J w' = A sin(2 pi f t) - c max(0, w - w_1) on the one side of w_1, linear on each: Runge-Kutta of order 4 in steps of 1 us,
  // of which the kinks take 1e-9 or less. Along its tangent, without the sine, a step sees nothing of the brake.
  struct Case {
    double amplitude, frequency, beyond, slope;  // N m, Hz, rad/s, N m s/rad
  };
  for (const Case& c : {Case{20.0, 2.0, 10.5, 100.0}, {60.0, 5.0, 11.0, 1000.0}, {1.0, 1.0, 10.01, 10.0}}) {
    Model m("braked");
    m.add_node("a");
    m.add<Inertia>("J", {"a"}, {.inertia = 1.0});
    m.set_initial("a", 0.0, 10.0);
    m.add<AppliedTorque>("sine", {"a"}, {.harmonics = {{c.frequency, c.amplitude, -0.5 * kPi}}});
    m.add<TorqueFunction>("brake", {"a"}, {.torque = [c](const TorqueVariables& x) {
                            return x.speed > c.beyond ? -c.slope * (x.speed - c.beyond) : Dual(0.0);
                          }});
    const System system = m.build();
    double w = 10.0, angle = 0.0;
    constexpr int kSteps = 1000000;
    const double h = 1.0 / kSteps;
    const auto rate = [&](double t, double speed) {
      return c.amplitude * std::sin(kTwoPi * c.frequency * t) - c.slope * std::max(0.0, speed - c.beyond);
    };
    for (int i = 0; i < kSteps; ++i) {
      const double t = i * h, a_1 = rate(t, w), a_2 = rate(t + 0.5 * h, w + 0.5 * h * a_1),
                   a_3 = rate(t + 0.5 * h, w + 0.5 * h * a_2), a_4 = rate(t + h, w + h * a_3);
      angle += h * (w + h * (a_1 + a_2 + a_3) / 6.0);
      w += h * (a_1 + 2.0 * a_2 + 2.0 * a_3 + a_4) / 6.0;
    }
    for (const double tolerance : {1e-6, 1e-8, 1e-10, 1e-12}) {
      State state = State::initial(system);
      const RunSummary run = propagate(system, {.tolerance = tolerance, .t_end = 1.0}, state);
      INFO(c.frequency << " Hz at " << tolerance << "\n" << run.brief_report());
      CHECK(run.ok());
      CHECK(state.v[0] == Approx(w).epsilon(std::max(10.0 * tolerance, 1e-9)));
      CHECK(state.z[0] == Approx(angle).epsilon(std::max(10.0 * tolerance, 1e-9)));
    }
  }
}

TEST_CASE(
    "Exact propagation: a narrow gate over the speed and a pulse in time, where no mode bounds the steps") {
  // 1 N m on 1 kg m^2, 0.9 N m against it from 55 to 56 rad/s, over ramps of 0.1 rad/s: t = int dw / (1 - 0.9 g).
  const double inside = 0.8 / 0.1 - 2.0 * std::log(0.1) / 9.0, end = 56.0 + (100.0 - 55.0 - inside);
  Model gate("gate");
  gate.add_node("a");
  gate.add<Inertia>("J", {"a"}, {.inertia = 1.0});
  gate.add<AppliedTorque>("motor", {"a"}, {.torque = [](double) { return 1.0; }});
  gate.add<TorqueFunction>("drag", {"a"},
                           {.torque = [](const TorqueVariables&) { return Dual(-0.9); },
                            .gate = {.from_speed = 55.0, .to_speed = 56.0, .speed_ramp = 0.1}});
  Model pulse("pulse");
  pulse.add_node("a");
  pulse.add<Inertia>("J", {"a"}, {.inertia = 1.0});
  pulse.add<TorqueFunction>("pulse", {"a"}, {.torque = [](const TorqueVariables& x) {
                              return Dual(std::max(0.0, 1.0 - std::abs(x.t - 55.0)));
                            }});
  for (const auto& [model, speed] : {std::pair(gate, end), {pulse, 1.0}})
    for (const double tolerance : {1e-6, 1e-10}) {
      const System system = model.build();
      State state = State::initial(system);
      const RunSummary run = propagate(system, {.tolerance = tolerance, .t_end = 100.0}, state);
      INFO(model.name() << " at " << tolerance << "\n" << run.brief_report());
      CHECK(run.ok());
      CHECK(state.v[0] == Approx(speed).epsilon(std::max(10.0 * tolerance, 1e-9)));
    }
}

TEST_CASE(
    "A drag that is called takes few more steps than one in the matrices, beside masses of every kind") {
  // A light disc, which the drag slows at c/J = 1e4 1/s; and a distributed shaft, whose lightest mass is far from the drag's node.
  const auto train = [](bool light, bool called) {
    Model m("drag");
    for (const char* node : {"a", "b"}) {
      m.add_node(node);
      m.set_initial(node, 0.0, 100.0);
    }
    m.add<Inertia>("J_a", {"a"}, {.inertia = light ? 1.0 : 10.0});
    m.add<Inertia>("J_b", {"b"}, {.inertia = light ? 1e-4 : 0.1});
    if (light)
      m.add<ShaftSpring>("shaft", {"a", "b"}, {.stiffness = 1e4});
    else
      m.add<DistributedShaft>(
          "shaft", {"a", "b"},
          {.shear_modulus = 80e9, .density = 7850.0, .outer_diameter = 0.02, .length = 1.0, .segments = 10});
    const NodeRef node = light ? "b" : "a";
    if (called)
      m.add<TorqueCurve>("drag", {node}, {.speeds = {-1000.0, 1000.0}, .torques = {1000.0, -1000.0}});
    else
      m.add<Dashpot>("drag", {node}, {.damping = 1.0});
    return m.build();
  };
  for (const bool light : {true, false}) {
    const System called = train(light, true), damper = train(light, false);
    State state = State::initial(called), expected = State::initial(damper);
    const double end = light ? 0.1 : 0.01;
    const RunSummary run = propagate(called, {.tolerance = 1e-10, .t_end = end}, state),
                     plain = propagate(damper, {.tolerance = 1e-10, .t_end = end}, expected);
    INFO(light << ": " << run.brief_report() << "; " << plain.brief_report());
    REQUIRE(run.ok());
    REQUIRE(plain.ok());
    CHECK(run.steps < 2 * plain.steps);
    for (Eigen::Index i = 0; i < state.v.size(); ++i)
      CHECK(std::abs(state.v[i] - expected.v[i]) <= 1e-8 * expected.v.cwiseAbs().maxCoeff());
    if (!light) continue;
    // SciPy's matrix exponential of the linear train.
    CHECK(state.z[0] == Approx(9.517209731994035).epsilon(1e-10));
    CHECK(state.v[0] == Approx(90.49278936299397).epsilon(1e-10));
    CHECK(state.v[1] == Approx(90.50183864174686).epsilon(1e-10));
  }
}
