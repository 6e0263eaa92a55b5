// Loads that say their knots: what they say is the load itself; looked up all at once they are what each gives when it is
// called; a run, by steps or with knots inside the steps of exact propagation, is that of the same load without them.
// Covers core/law/knotted_load.hpp, core/table_loads.hpp, core/law/curve_cells.hpp.
#include <drev/core/assembler.hpp>
#include <drev/core/element.hpp>
#include <drev/core/law/knotted_load.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/cam_torque.hpp>
#include <drev/elements/couplings/absolute_damper.hpp>
#include <drev/elements/dashpot.hpp>
#include <drev/elements/engine/engine_cylinders.hpp>
#include <drev/elements/gears/planetary_set.hpp>
#include <drev/elements/inertia.hpp>
#include <drev/elements/machines/torque_curve.hpp>
#include <drev/elements/shaft_spring.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <cmath>

#include "core/law/curve_cells.hpp"
#include "tests/catch.hpp"
#include "tests/stability/runge_kutta.hpp"

using namespace drev;

namespace {

/// Few points, far from even, so that every knot is a strong one; firing at 0.
GasPressure::Params rough_gas(Interpolation interpolation = Interpolation::linear) {
  return {
      .angle = {deg(0), deg(4), deg(11), deg(30), deg(80), deg(140), deg(360), deg(560), deg(660), deg(700)},
      .pressure = {70e5, 88e5, 60e5, 22e5, 6e5, 2e5, 1e5, 1.5e5, 14e5, 38e5},
      .interpolation = interpolation};
}

EngineCylinders::Params engine_of(GasPressure::Params gas) {
  return {.bore = 0.1,
          .stroke = 0.12,
          .rod = 0.2,
          .oscillating_mass = 2.0,
          .firing_angles = EngineCylinders::even_firing("1-3-4-2", 4, deg(10)),
          .gas = std::move(gas),
          .crankcase_pressure = 1e5};
}

/// The engines that differ in what they say.
std::vector<EngineCylinders::Params> engines() {
  std::vector<EngineCylinders::Params> all{engine_of(rough_gas()),
                                           engine_of(rough_gas(Interpolation::cubic))};
  all.push_back(all[0]);
  all.back().misfiring_cylinder = 2;
  all.push_back(all[1]);
  all.back().misfiring_cylinder = 3;
  all.push_back(all[0]);  // a curve that does not close
  all.back().gas.angle.push_back(deg(720));
  all.back().gas.pressure.push_back(66e5);
  all.push_back(all[0]);
  all.back().gas.peak_speed = {100.0, 300.0};
  all.back().gas.peak_pressure = {80e5, 140e5};
  all.push_back(all[0]);  // two curves with other angles
  for (const double angle : {0.0, 5.0, 17.0, 90.0, 300.0, 640.0}) {
    all.back().gas.angle.push_back(deg(angle));
    all.back().gas.pressure.push_back(1e5 * (2.0 + 120.0 * std::exp(-angle / 30.0)));
  }
  for (std::size_t i = 0; i < all.back().gas.angle.size(); ++i)
    all.back().gas.load.push_back(i < 10 ? 0.5 : 1.0);
  all.back().gas.at_load = 0.7;
  all.push_back(all.back());  // over the speed, through a gate
  all.back().gas.speed = {50.0, 50.0, 50.0,  50.0,  50.0,  50.0,  50.0,  50.0,
                          50.0, 50.0, 170.0, 170.0, 170.0, 170.0, 170.0, 170.0};
  all.back().gas.load.clear();
  all.back().gas.firing = {.from_speed = 80.0, .speed_ramp = 30.0};
  all.push_back(engine_of({}));
  all.back().mean_tangential_pressure = 3e5;
  all.back().tangential_pressure = {{0.5, 2e5, 0.3}, {1.0, 4e5, -0.4}, {6.5, 1e5, 2.0}};
  return all;
}

/// The same loads without their knots.
class OnlyCalled final : public Element {
 public:
  explicit OnlyCalled(EngineCylinders::Params p) : engine_(std::move(p)) {
    engine_.describe(nodes(), terms_);
    for (const LoadSpec& spec : terms_.loads) loads_.emplace_back(*spec.load);
  }
  int nodes() const { return static_cast<int>(engine_.params().firing_angles.size()); }
  std::string_view type() const override { return "engine that is called"; }
  int min_nodes() const override { return nodes(); }
  void check(ParameterCheck& check) const override { engine_.check(check); }
  void describe(int nodes, Terms& terms) const override {
    engine_.describe(nodes, terms);
    for (std::size_t i = 0; i < loads_.size(); ++i) terms.loads[i].load = &loads_[i];
  }

 private:
  struct Hidden final : Load {
    explicit Hidden(const Load& l) : load(l) {}
    LoadResponse evaluate(const LoadInput& in) const override { return load.evaluate(in); }
    bool depends_on_motion() const override { return load.depends_on_motion(); }
    const Load& load;
  };
  EngineCylinders engine_;
  Terms terms_{nodes()};
  std::vector<Hidden> loads_;
};

template <class Engine>
System train(const EngineCylinders::Params& p, const Motion* nominal) {
  Model m("engine");
  std::vector<NodeRef> throws;
  for (int k = 0; k < 4; ++k) {
    const std::string node = "throw_" + std::to_string(k + 1), before = "throw_" + std::to_string(k);
    m.add_node(node);
    m.add<Inertia>("J_" + node, {node}, {.inertia = 0.05});
    m.add<AbsoluteDamper>("drag_" + node, {node}, {.damping = 2.0});
    if (k > 0) m.add<ShaftSpring>("web_" + node, {before, node}, {.stiffness = 4e5, .damping = 20.0});
    throws.emplace_back(node);
  }
  m.add_node("flywheel");
  m.add<Inertia>("J", {"flywheel"}, {.inertia = 1.0});
  m.add<ShaftSpring>("shaft", {"throw_4", "flywheel"}, {.stiffness = 5e5, .damping = 20.0});
  m.add<Dashpot>("load", {"flywheel"}, {.damping = 3.0});
  m.add("engine", throws, std::make_shared<const Engine>(p));
  if (nominal != nullptr) m.set_reference("flywheel", *nominal);
  return m.build();
}

}  // namespace

TEST_CASE("A cylinder's pieces and curves are its torque, on both sides of every knot", "[exact]") {
  for (const EngineCylinders::Params& p : engines()) {
    const EngineCylinders engine(p);
    Terms terms(4);
    engine.describe(4, terms);
    for (const LoadSpec& spec : terms.loads) {
      const auto* knots = dynamic_cast<const KnottedLoad*>(spec.load);
      REQUIRE(knots != nullptr);
      const CurveCells cells(*knots);
      const double w = 180.0;
      const auto torque = [&](double angle) {
        return spec.load->evaluate({.nominal_angle = angle, .speed = w, .nominal_speed = w}).torque;
      };
      for (const double direction : {1.0, -1.0}) {
        double angle = -31.7;
        for (int i = 0; i < 60; ++i) {
          const CubicPiece piece = knots->piece(angle, direction, w);
          const double bound = direction > 0.0 ? piece.high : piece.low;
          const double end = std::isfinite(bound) ? bound : angle + 0.1 * direction;
          REQUIRE(direction * (end - angle) > 0.0);
          for (const double other : {0.0, 20.0, 90.0, 1000.0}) {
            const CubicPiece there = knots->piece(angle, direction, other);
            CHECK((there.low == piece.low && there.high == piece.high));  // knots do not follow the speed
          }
          for (const double part : {0.01, 0.3, 0.77, 0.99}) {
            const double at = angle + part * (end - angle), x = at - angle;
            const auto& c = piece.terms;
            const double cubic = c[0] + x * (c[1] + x * (c[2] + x * c[3]));
            const KnottedLoad::Curves s = knots->curves(at);
            INFO(at << " " << direction);
            // The steep end of a curve that does not close is 1e-8 rad wide: rounding of its angle counts there.
            const double tolerance = std::abs(end - angle) < 1e-6 ? 10.0 : 1e-6;
            CHECK(std::abs(cubic * s.factor + s.by_speed_squared * w * w - torque(at)) < tolerance);
            const CurveCells::Values v = CurveCells::values(cells.at(at));
            CHECK(v.factor ==
                  Approx(s.factor).margin(1e-12 * std::abs(cells.at(0.0).cell->factor[0]) + 1e-14));
            CHECK(v.by_speed == Approx(s.by_speed_squared).margin(1e-15));
          }
          angle = end;
        }
      }
    }
  }
}

TEST_CASE("Cylinders looked up at once give what each gives when called, and a bound of their slopes",
          "[step]") {
  const Motion steady = constant_speed(200.0), back = constant_speed(-90.0),
               rising = run_up(150.0, 220.0, 0.0, 0.1);
  std::vector<EngineCylinders::Params> all = engines();
  all.push_back(all[0]);
  all.back().twist_feedback = false;
  all.push_back(all[1]);
  all.back().gas.firing = {.from_speed = 120.0, .to_speed = 205.0, .speed_ramp = 20.0};
  for (const EngineCylinders::Params& engine : all)
    for (const Motion* nominal : {&steady, &back, &rising, static_cast<const Motion*>(nullptr)}) {
      const System system = train<EngineCylinders>(engine, nominal),
                   called = train<OnlyCalled>(engine, nominal);
      REQUIRE(system.knotted_loads().size() == 4);
      REQUIRE(system.moving_loads().empty());
      REQUIRE(called.knotted_loads().size() == 0);
      Assembler at_once(system), one_by_one(called);
      Vector z(5), v(5), p, expected, moved;
      std::uint32_t seed = 7;
      const auto random = [&seed] {
        return static_cast<double>((seed = seed * 1664525u + 1013904223u)) / 4294967296.0;
      };
      for (int i = 0; i < 200; ++i) {
        const double t = i < 100 ? 0.001 * i : 0.2 * random();  // by small steps, then anywhere
        for (Eigen::Index k = 0; k < 5; ++k) {
          z[k] = 0.02 * random() + (i % 7 == 0 ? 30.0 * random() : 0.0);
          v[k] = (nominal == nullptr ? 170.0 : 0.0) + 20.0 * random();
        }
        at_once.set_time(t), one_by_one.set_time(t);
        at_once.external(z, v, p);
        one_by_one.external(z, v, expected);
        INFO(i << " t = " << t);
        REQUIRE((p - expected).lpNorm<Eigen::Infinity>() < 1e-9 * 3000.0);
        const double change = 1e-9, rate = 1e4;
        const double bound = change * at_once.load_steepness(rate);
        at_once.external(z.array() + change, v.array() + rate * change, moved);
        CHECK((moved - p).lpNorm<Eigen::Infinity>() < 1.01 * bound + 1e-9);
      }
    }
}

TEST_CASE("A cylinder on the carrier of a rigid planetary set, whose motion follows from two unknowns",
          "[step]") {
  const auto build = [](auto engine) {
    Model m("set");
    for (const char* node : {"sun", "ring", "carrier"}) {
      m.add_node(node);
      m.add<Inertia>(std::string("J_") + node, {node}, {.inertia = 0.05});
      m.set_initial(node, 0.0, 150.0);
    }
    m.add<PlanetarySet>("set", {"sun", "ring", "carrier"}, {.ratio = 2.0});
    m.add<Dashpot>("drag", {"ring"}, {.damping = 0.1});
    m.add("engine", {"carrier"}, engine);
    return m.build();
  };
  EngineCylinders::Params p = engine_of(rough_gas());
  p.firing_angles = {deg(10)};
  const System system = build(std::make_shared<const EngineCylinders>(p)),
               called = build(std::make_shared<const OnlyCalled>(p));
  REQUIRE(system.loaded_rows() == 1);
  REQUIRE(system.knotted_loads().size() == 1);
  State with = State::initial(system), without = with;
  const TransientOptions options{.step = 2e-5, .t_end = 0.05};
  REQUIRE(simulate(system, options, with).ok());
  REQUIRE(simulate(called, options, without).ok());
  CHECK((with.z - without.z).lpNorm<Eigen::Infinity>() < 1e-10 * without.z.lpNorm<Eigen::Infinity>());
  CHECK((with.v - without.v).lpNorm<Eigen::Infinity>() < 1e-8 * without.v.lpNorm<Eigen::Infinity>());
}

TEST_CASE("Cylinders in steps: the motion of the same engine that is called", "[step]") {
  const Motion steady = constant_speed(200.0), rising = run_up(150.0, 220.0, 0.0, 0.1);
  const auto all = engines();
  for (const std::size_t k : {0u, 3u, 5u, 7u})
    for (const Motion* nominal : {&steady, &rising, static_cast<const Motion*>(nullptr)})
      for (const char* method : {"average_acceleration", "generalized_alpha", "dormand_prince"}) {
        const System system = train<EngineCylinders>(all[k], nominal),
                     called = train<OnlyCalled>(all[k], nominal);
        State with = State::initial(system);
        if (nominal == nullptr) with.v.setConstant(170.0);
        State without = with;
        const TransientOptions options{.scheme = step_scheme(method), .step = 1e-5, .t_end = 0.03};
        const RunSummary run = simulate(system, options, with), other = simulate(called, options, without);
        INFO(k << " " << method << ": " << run.load_passes << ", " << other.load_passes);
        REQUIRE(run.ok());
        REQUIRE(other.ok());
        CHECK(run.load_passes <= other.load_passes + other.load_passes / 100);
        CHECK((with.z - without.z).lpNorm<Eigen::Infinity>() < 1e-10 * without.z.lpNorm<Eigen::Infinity>());
        CHECK((with.v - without.v).lpNorm<Eigen::Infinity>() < 1e-8 * without.v.lpNorm<Eigen::Infinity>());
      }
}

TEST_CASE("Knots inside the steps of exact propagation: the motion of the same load that is called",
          "[exact]") {
  const Motion steady = constant_speed(200.0), rising = run_up(150.0, 220.0, 0.0, 0.1);
  int k = 0;
  for (const EngineCylinders::Params& p : engines())
    for (const Motion* nominal : {&steady, &rising, static_cast<const Motion*>(nullptr)}) {
      if (nominal == &rising && k != 5 && k != 0) continue;
      const System system = train<EngineCylinders>(p, nominal), called = train<OnlyCalled>(p, nominal);
      const auto start = [&](const System& s) {
        State state = State::initial(s);
        if (nominal == nullptr) state.v.setConstant(170.0);
        return state;
      };
      State with = start(system), without = start(called);
      const RunSummary run = propagate(system, {.tolerance = 1e-9, .t_end = 0.05}, with);
      const RunSummary other = propagate(called, {.tolerance = 1e-12, .t_end = 0.05}, without);
      REQUIRE(run.ok());
      REQUIRE(other.ok());
      INFO(k << " " << (nominal == nullptr) << ": steps " << run.steps << ", " << other.steps);
      CHECK((with.z - without.z).lpNorm<Eigen::Infinity>() < 1e-8 * without.z.lpNorm<Eigen::Infinity>());
      CHECK((with.v - without.v).lpNorm<Eigen::Infinity>() < 1e-8 * without.v.lpNorm<Eigen::Infinity>());
      CHECK(std::abs(run.energy.relative_error()) < 1e-8);
      if (k == 0) {  // Knots cost a called load many steps.
        State again = start(called);
        CHECK(2 * run.steps < propagate(called, {.tolerance = 1e-9, .t_end = 0.05}, again).steps);
      }
      if (nominal == nullptr) ++k;
    }
}

TEST_CASE("An engine that rocks about rest on its gas pressure: its angle turns back on knots", "[exact]") {
  const EngineCylinders::Params p = engine_of(rough_gas());
  const System system = train<EngineCylinders>(p, nullptr), called = train<OnlyCalled>(p, nullptr);
  State with = State::initial(system), without = with;
  const RunSummary run = propagate(system, {.tolerance = 1e-8, .t_end = 0.06}, with);
  const RunSummary other = propagate(called, {.tolerance = 1e-10, .t_end = 0.06}, without);
  REQUIRE(run.ok());
  REQUIRE(other.ok());
  INFO(run.steps << " " << other.steps << " " << with.v.transpose());
  CHECK((with.z - without.z).lpNorm<Eigen::Infinity>() < 1e-6 * without.z.lpNorm<Eigen::Infinity>());
  CHECK((with.v - without.v).lpNorm<Eigen::Infinity>() < 1e-6 * without.v.lpNorm<Eigen::Infinity>());
  CHECK(std::abs(run.energy.relative_error()) < 1e-7);
}

TEST_CASE("Pressure that follows the actual speed, through the ramps of an engine's gate", "[exact]") {
  Model m("gated");
  m.add_node("crank", NodeKind::rotational);
  m.add<Inertia>("J", {"crank"}, {.inertia = 0.1});
  m.add<AbsoluteDamper>("drag", {"crank"}, {.damping = 0.3});
  EngineCylinders::Params p = engine_of(rough_gas(Interpolation::cubic));
  p.oscillating_mass = 0.0;
  p.firing_angles = {deg(10)};
  p.gas.firing = {.from_speed = 40.0, .to_speed = 110.0, .speed_ramp = 5.0};
  m.add<EngineCylinders>("engine", {"crank"}, p);
  m.set_initial("crank", 0.0, 100.0);
  const System system = m.build();
  State expected = State::initial(system);
  runge_kutta(system, 0.3, 2e-6, expected);
  for (const double tolerance : {1e-6, 1e-8, 1e-10, 1e-12}) {
    State state = State::initial(system);
    const RunSummary run = propagate(system, {.tolerance = tolerance, .t_end = 0.3}, state);
    INFO(tolerance << ": " << run.brief_report());
    CHECK(run.ok());
    CHECK(state.v[0] == Approx(expected.v[0]).epsilon(std::max(10.0 * tolerance, 2e-8)));
    CHECK(state.z[0] == Approx(expected.z[0]).epsilon(std::max(10.0 * tolerance, 2e-8)));
  }
}

TEST_CASE("A gas torque that is zero up to a knot and bends behind it: the motion of Runge-Kutta",
          "[exact]") {
  // At the dead centre the torque behind the knot begins with the square of the angle, on a load that was none until then.
  Model m("blow-down");
  m.add_node("crank");
  m.add_node("disc");
  for (const char* node : {"crank", "disc"})
    m.add<Inertia>(std::string("J_") + node, {node}, {.inertia = 0.1});
  m.add<ShaftSpring>("shaft", {"crank", "disc"}, {.stiffness = 100.0});
  EngineCylinders::Params p = engine_of(
      {.angle = {0.0, deg(90), deg(180), deg(270), deg(330)}, .pressure = {1e5, 1e5, 1e5, 1e5, 5e5}});
  p.oscillating_mass = 0.0;
  p.firing_angles = {0.0};
  p.strokes = 2;
  m.add<EngineCylinders>("engine", {"crank"}, p);
  m.set_initial("crank", 0.18, -44.0);
  m.set_initial("disc", 1.36, -41.0);
  const System system = m.build();
  State expected = State::initial(system);
  runge_kutta(system, 0.1, 1e-6, expected);
  for (const double tolerance : {1e-6, 1e-8, 1e-10, 1e-12}) {
    State state = State::initial(system);
    const RunSummary run = propagate(system, {.tolerance = tolerance, .t_end = 0.1}, state);
    INFO(tolerance << ": " << run.brief_report());
    CHECK(run.ok());
    CHECK((state.v - expected.v).lpNorm<Eigen::Infinity>() < std::max(10.0 * tolerance, 1e-9) * 50.0);
    CHECK((state.z - expected.z).lpNorm<Eigen::Infinity>() < std::max(10.0 * tolerance, 1e-9) * 5.0);
  }
}

TEST_CASE(
    "An engine at the nominal angle on a free disc: its energy balances, however far it turns in a step",
    "[exact]") {
  // Nothing but the knots bends the motion, so that the gas torque bends much between them.
  const Motion steady = constant_speed(20.0 * kPi), rising = run_up(50.0, 80.0, 0.0, 1.0);
  for (const Motion* nominal : {&steady, &rising})
    for (const double oscillating : {0.0, 2.0})
      for (const bool misfires : {false, true}) {
        INFO((nominal == &rising) << " " << oscillating << " kg " << misfires);
        Model m("disc");
        m.add_node("crank");
        m.add<Inertia>("J", {"crank"}, {.inertia = 1.0});
        EngineCylinders::Params p =
            engine_of({.angle = {0.0, deg(120), deg(300)}, .pressure = {10e5, 1e5, 1e5}});
        p.strokes = 2;
        p.firing_angles = {0.0};
        p.oscillating_mass = oscillating;
        p.misfiring_cylinder = misfires ? 1 : 0;
        p.twist_feedback = false;
        m.add<EngineCylinders>("engine", {"crank"}, p);
        m.set_reference("crank", *nominal);
        const RunSummary run = propagate(m.build(), {.t_end = 1.0});
        INFO(run.brief_report());
        CHECK(run.ok());
        CHECK(std::abs(run.energy.relative_error()) < 1e-10);
      }
}

TEST_CASE("A cubic cam whose path goes to and fro beside a knot while a called torque is projected",
          "[exact]") {
  // From pass to pass the angle turns back in the step or does not, so that the knot is taken in and left out by turns.
  Model m("narrow hump");
  for (const char* node : {"a", "b", "c"}) {
    m.add_node(node);
    m.set_initial(node, 0.1, *node == 'a' ? 1.0 : 0.0);
  }
  m.add<Inertia>("J_a", {"a"}, {.inertia = 0.5});
  m.add<Inertia>("J_b", {"b"}, {.inertia = 2.0});
  m.add<Inertia>("J_c", {"c"}, {.inertia = 0.5});
  m.add<ShaftSpring>("stiff", {"a", "b"}, {.stiffness = 1e4, .damping = 10.0});
  m.add<ShaftSpring>("soft", {"b", "c"}, {.stiffness = 100.0, .damping = 10.0});
  m.add<CamTorque>("cam", {"b"},
                   {.angle_table = {{0.0, deg(10), deg(20), deg(350)}, {0.0, 100.0, 0.0, 0.0}},
                    .interpolation = Interpolation::cubic});
  m.add<TorqueCurve>("motor", {"c"}, {.speeds = {0.0, 10.5}, .torques = {10.0, -10.0}});
  m.set_reference("a", constant_speed(10.0));
  const System system = m.build();
  // SciPy's DOP853, relative tolerance 1e-13, steps of at most 1e-4 s.
  const double expected[] = {-6.5090911540757, -6.5097742745402, -6.4765569875996};
  for (const double tolerance : {1e-6, 1e-8, 1e-9, 1e-10, 1e-11}) {
    State state = State::initial(system);
    const RunSummary run = propagate(system, {.tolerance = tolerance, .t_end = 0.5}, state);
    INFO(tolerance << ": " << run.brief_report());
    CHECK(run.ok());
    for (int i = 0; i < 3; ++i) CHECK(std::abs(state.z[i] - expected[i]) < std::max(10.0 * tolerance, 1e-11));
  }
}

TEST_CASE("Pressure that follows the speed: of nodes beside the nominal motion the actual one, humps are met",
          "[exact]") {
  EngineCylinders::Params p{.bore = 0.05, .stroke = 0.05, .rod = 0.05, .firing_angles = {0.0}};
  const auto run = [&](double angle, double speed, double t) {
    Model m("engine");
    for (const char* node : {"a", "b"}) {
      m.add_node(node);
      m.add<Inertia>(std::string("J_") + node, {node}, {.inertia = 1.0});
    }
    m.set_reference("b", constant_speed(10.0));  // of another train
    m.set_initial("a", angle, speed);
    m.add<EngineCylinders>("engine", {"a"}, p);
    const System system = m.build();
    State state = State::initial(system);
    const RunSummary summary = propagate(system, {.t_end = t}, state);
    INFO(summary.brief_report());
    CHECK(summary.ok());
    CHECK(summary.steps < 100);
    return state.v[0];
  };
  p.gas = {.angle = {0.0, 1.0, 3.0, 6.0, 11.0},
           .pressure = {1e6, 2e5, 5e5, 1e5, 5e5},
           .peak_speed = {0.0, 10.0},
           .peak_pressure = {1e6, 2e6}};
  // SciPy's DOP853, relative tolerance 1e-13.
  CHECK(run(0.0, 5.0, 0.5) == Approx(9.899462497898723).epsilon(1e-9));
  // No torque at the start, and for most of the run: sqrt(100 + 2 W/J) by the integral of the pressure over the volume.
  p.gas = {.angle = {0.0, 4.5, 5.0, 5.5},
           .pressure = {0.0, 0.0, 5e5, 0.0},
           .peak_speed = {0.0, 10.0},
           .peak_pressure = {5e5, 5e5}};
  CHECK(run(0.1, 10.0, 1.0) == Approx(8.57352918493832).epsilon(1e-9));
  CHECK(run(0.0, 0.0, 1.0) == 0.0);  // at rest on a knot
}
