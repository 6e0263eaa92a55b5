// Orders that a sweep solves side by side, in sets of lanes, against the same orders one by one, which are solved by
// the elimination with pivoting. Covers solvers/periodic/linear_response.hpp, lane_sections.hpp and
// solvers/linear/lane_elimination.hpp through sweep_linear(); loads that only some of the speeds have (order_content.hpp), and
// narrow ones (load_probes.hpp); and
// loads about the nominal speed in a sweep with contacts (law_balance.hpp).
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/nonlinear_sweep.hpp>
#include <drev/solvers/periodic/linear_sweep.hpp>

#include <cmath>
#include <complex>

#include "solvers/periodic/order_content.hpp"
#include "solvers/periodic/trigonometric_sum.hpp"
#include "tests/catch.hpp"

using namespace drev;

namespace {

/// Chain of four discs from a clock, with a rubber element; a torque of every order but each seventh one at disc 3, of
/// every third one at disc 2.
System chain(const ViscoelasticStiffness::Params& material, double speed, const std::vector<double>& orders) {
  Model m("chain");
  m.add_node("n0");
  m.constant_speed("n0", speed);
  for (int i = 1; i <= 4; ++i) {
    const std::string node = "n" + std::to_string(i), before = "n" + std::to_string(i - 1);
    m.add_node(node);
    m.add<Inertia>("J" + node, {node}, {.inertia = 0.02 + 0.01 * i});
    if (i == 2)
      m.add<ElasticCoupling>("rubber", {before, node}, {.material = material});
    else
      m.add<ShaftSpring>("k" + std::to_string(i), {before, node},
                         {.stiffness = 3e5 * i, .damping = i == 3 ? 4.0 : 0.0});
  }
  std::vector<Harmonic> at_3, at_2;
  for (std::size_t k = 0; k < orders.size(); ++k) {
    if (k % 7 != 3) at_3.push_back({orders[k], 50.0 / (1.0 + static_cast<double>(k)), 0.4 * orders[k]});
    if (k % 3 == 0 && k % 7 != 3) at_2.push_back({orders[k], 20.0, -0.3 * orders[k]});
  }
  m.add<EngineOrderTorque>("gas_3", {"n3"}, {.harmonics = at_3, .twist_feedback = false});
  m.add<EngineOrderTorque>("gas_2", {"n2"}, {.harmonics = at_2, .twist_feedback = false});
  return m.build();
}

}  // namespace

TEST_CASE("Orders that are solved side by side are those that are solved one by one", "[linear_sweep]") {
  std::vector<double> orders;
  for (int k = 1; k <= 45; ++k) orders.push_back(0.5 * k);  // more than are solved at once
  const ViscoelasticStiffness::Params constant{
      .stiffness = 2e5, .loss_factor = 0.1, .lowest_frequency = 50, .highest_frequency = 200};
  ViscoelasticStiffness::Params follows = constant;
  follows.stiffness = kNotGiven, follows.loss_factor = 0.0, follows.permitted_error = 1.0;
  follows.frequencies = {20.0, 100.0, 400.0};
  follows.stiffnesses = {1.5e5, 2e5, 2.6e5};
  follows.loss_factors = {0.15, 0.1, 0.05};
  for (const auto& material : {constant, follows})
    for (const double direction : {1.0, -1.0}) {
      CAPTURE(material.frequencies.size(), direction);
      const System system = chain(material, direction * 100.0, orders);
      LinearSweepOptions options{.speeds = {60.0, 90.0, 140.0}, .orders = orders, .refine = false};
      const LinearSweep together = sweep_linear(system, options);
      Vector input = Vector::Zero(3), dissipated = input;
      std::vector<Vector> heat(together.sections.size(), input);
      for (std::size_t k = 0; k < orders.size(); ++k) {
        options.orders = {orders[k]};
        const LinearSweep alone = sweep_linear(system, options);
        input += alone.input_power, dissipated += alone.dissipated_power;
        const auto row = static_cast<Eigen::Index>(k);
        for (std::size_t c = 0; c < together.sections.size(); ++c) {
          const SweepSection &section = together.sections[c], &expected = alone.sections[c];
          heat[c] += expected.heat;
          CHECK((section.amplitude.row(row) - expected.amplitude.row(0)).norm() <=
                1e-11 * expected.amplitude.norm());
          CHECK(expected.amplitude.isZero(0.0) == (k % 7 == 3));
          if (section.twist.size() > 0)
            CHECK((section.twist.row(row) - expected.twist.row(0)).norm() <= 1e-11 * expected.twist.norm());
        }
      }
      for (std::size_t c = 0; c < together.sections.size(); ++c)
        CHECK((together.sections[c].heat - heat[c]).norm() <= 1e-11 * heat[c].norm());
      CHECK((together.input_power - input).norm() < 1e-11 * input.norm());
      CHECK((together.dissipated_power - dissipated).norm() < 1e-11 * dissipated.norm());
      CHECK((input - dissipated).norm() < 1e-11 * input.norm());
    }
}

TEST_CASE("Sums of orders have the same extremes alone and beside others", "[linear_sweep]") {
  // 7 orders of which few are whole multiples of others; 21 sums: a full pair of sets of lanes, and a part of one.
  for (const std::vector<double>& orders :
       {std::vector<double>{1.0, 1.5, 2.0, 3.0, 4.5, 6.0, 7.5}, std::vector<double>{0.5, 3.0, 11.5, 40.0}}) {
    const auto count = static_cast<Eigen::Index>(orders.size());
    TrigonometricSum sum(orders, "test");
    Eigen::MatrixXcd a(count, 21);
    for (Eigen::Index s = 0; s < a.cols(); ++s)
      for (Eigen::Index k = 0; k < count; ++k)
        a(k, s) = s == 4 ? 0.0
                         : std::polar(1.0 / (1.0 + static_cast<double>(k)),
                                      1.7 * static_cast<double>(s * s + 3 * k));
    a(1, 18) = std::numeric_limits<double>::infinity();
    std::vector<SumExtremes> together, alone;
    sum.extremes(a, together);
    for (Eigen::Index s = 0; s < a.cols(); ++s) {
      CAPTURE(orders.size(), s);
      const Eigen::MatrixXcd one = a.col(s);
      sum.extremes(one, alone);
      const SumExtremes &e = together[static_cast<std::size_t>(s)], &expected = alone[0];
      CHECK(e.max == expected.max);
      CHECK(e.min == expected.min);
      CHECK(e.max_angle == expected.max_angle);
      CHECK(std::isfinite(e.max) == (s != 18));
      if (s == 18) continue;
      double most = 0.0, least = 0.0, at_max = 0.0;
      for (int p = 0; p < 4000; ++p) {
        double y = 0.0;
        for (Eigen::Index k = 0; k < count; ++k)
          y += (a(k, s) * std::polar(1.0, orders[static_cast<std::size_t>(k)] * sum.cycle() * p / 4000))
                   .real();
        most = std::max(most, y), least = std::min(least, y);
      }
      for (Eigen::Index k = 0; k < count; ++k)
        at_max += (a(k, s) * std::polar(1.0, orders[static_cast<std::size_t>(k)] * e.max_angle)).real();
      CHECK(std::abs(e.max - at_max) <= 1e-12);
      CHECK((e.max >= most - 1e-13 && e.max <= most + 1e-2));
      CHECK((e.min <= least + 1e-13 && e.min >= least - 1e-2));
    }
  }
}

namespace {

/// J = 1 kg m^2 on a shaft of 1000 N m/rad and 0.1 N m s/rad behind a clock, with a torque between these speeds of its disc.
System gated(double nominal_rpm, std::function<Dual(const TorqueVariables&)> torque, double from_rpm) {
  Model m("gated");
  m.add_node("clock");
  m.add_node("disc");
  m.constant_speed("clock", rpm(nominal_rpm));
  m.add<Inertia>("J", {"disc"}, {.inertia = 1.0});
  m.add<ShaftSpring>("shaft", {"clock", "disc"}, {.stiffness = 1000.0, .damping = 0.1});
  m.add<TorqueFunction>(
      "load", {"disc"},
      {.torque = std::move(torque),
       .gate = {.from_speed = rpm(from_rpm), .to_speed = rpm(5000.0), .speed_ramp = rpm(100.0)}});
  return m.build();
}

}  // namespace

TEST_CASE("What a load depends on is found at the speeds of the sweep, whatever the nominal speed is",
          "[linear_sweep]") {
  const std::vector<double> speeds{rpm(300.0), rpm(1400.0), rpm(2500.0)};
  for (const double nominal : {600.0, 1200.0}) {
    CAPTURE(nominal);
    const auto swept = [&](std::function<Dual(const TorqueVariables&)> torque, double from_rpm) {
      return sweep_linear(gated(nominal, std::move(torque), from_rpm),
                          {.speeds = speeds, .orders = {2.0}, .refine = false});
    };
    const LinearSweep wave =
        swept([](const TorqueVariables& x) { return 100.0 * cos(2.0 * x.angle); }, 900.0);
    CHECK(wave.sections[0].half_range()[0] == 0.0);
    CHECK(wave.sections[0].mean.isZero(0.0));
    for (const Eigen::Index i : {1, 2}) {
      const double w = 2.0 * speeds[static_cast<std::size_t>(i)];
      const std::complex<double> shaft(1000.0, 0.1 * w);
      CHECK(wave.sections[0].half_range()[i] ==
            Approx(100.0 * std::abs(shaft / (shaft - w * w))).epsilon(1e-9));
    }
    const LinearSweep constant = swept([](const TorqueVariables&) { return Dual(-100.0); }, 2000.0);
    CHECK(constant.sections[0].mean[0] == 0.0);
    CHECK(constant.sections[0].mean[1] == 0.0);
    CHECK(std::abs(constant.sections[0].mean[2]) == Approx(100.0).epsilon(1e-12));
    CHECK_THROWS_AS(swept([](const TorqueVariables& x) { return Dual(std::sin(50.0 * x.t)); }, 900.0),
                    ModelError);
  }
  // So is the cycle of a sweep with contacts.
  const System half = gated(
      600.0, [](const TorqueVariables& x) { return 100.0 * cos(0.5 * x.angle); }, 900.0);
  CHECK(cycle_turns(half, speeds) == 2.0);
}

TEST_CASE("A propeller's damping factor counts in a sweep with contacts as in one with closed teeth",
          "[nonlinear_sweep]") {
  Model m("driven mesh");
  for (const char* node : {"a", "b", "g"}) m.add_node(node);
  m.constant_speed("a", rpm(650));
  m.add<Inertia>("J_b", {"b"}, {.inertia = 1.0});
  m.add<Inertia>("J_g", {"g"}, {.inertia = 1.0});
  m.add<ShaftSpring>("s", {"a", "b"}, {.stiffness = 1e4, .damping = 1.0});
  m.add<GearMesh>("mesh", {"b", "g"},
                  {.base_radius_1 = 0.1,
                   .base_radius_2 = 0.1,
                   .stiffness = 1e7,
                   .normal_backlash = 1e-4,
                   .damping = 100.0,
                   .damping_law = MeshDamping::limited});
  m.add<EngineOrderTorque>(
      "e", {"b"}, {.harmonics = {{.order = 1.0, .amplitude = 1.0}}, .mean = 1000.0, .twist_feedback = false});
  m.add<EngineOrderTorque>("l", {"g"}, {.mean = 1000.0, .twist_feedback = false});
  m.add<Propeller>("p", {"b"}, {.rated_torque = 200.0, .rated_speed = rpm(1000), .damping_factor = 20.0});
  const System system = m.build();
  const std::vector<double> speeds{rpm(650), rpm(680)};
  const LinearSweep closed = sweep_linear(
      system, {.speeds = speeds, .orders = {1.0}, .sections = {"s.torque_Nm"}, .close_contacts = true});
  const NonlinearSweep sweep = sweep_nonlinear(
      system, {.speeds = speeds, .orders = {1.0}, .sections = {"s.torque_Nm"}, .runs = false});
  REQUIRE(sweep.branches.size() == 1);
  Eigen::Index seen = 0;
  for (const SweptMotion& motion : sweep.branches[0].motions)
    if (motion.asked)
      CHECK(motion.half_range()[0] == Approx(closed.sections[0].half_range()[seen++]).epsilon(1e-6));
  CHECK(seen == 2);
}

namespace {

/// A shaft between a clock and a disc with this load.
template <class Element>
System loaded(typename Element::Params load) {
  Model m("loaded");
  m.add_node("clock");
  m.add_node("disc");
  m.constant_speed("clock", 60.0);
  m.add<Inertia>("J", {"disc"}, {.inertia = 1.0});
  m.add<ShaftSpring>("shaft", {"clock", "disc"}, {.stiffness = 1000.0});
  m.add<Element>("load", {"disc"}, std::move(load));
  return m.build();
}

/// 1e5 w/60 max(0, cos(theta/2 - phase) - 0.999): 100 N m at 60 rad/s, 10 degrees wide.
TorqueFunction::Params short_pulse(double phase) {
  using Op = Formula::Op;
  return {.formula = Formula({{.op = Op::variable, .a = 0},
                              {.op = Op::constant, .value = 0.5},
                              {.op = Op::multiply, .a = 0, .b = 1},
                              {.op = Op::constant, .value = phase},
                              {.op = Op::subtract, .a = 2, .b = 3},
                              {.op = Op::cos, .a = 4},
                              {.op = Op::constant, .value = 0.999},
                              {.op = Op::subtract, .a = 5, .b = 6},
                              {.op = Op::constant},
                              {.op = Op::larger, .a = 7, .b = 8},
                              {.op = Op::variable, .a = 1},
                              {.op = Op::multiply, .a = 9, .b = 10},
                              {.op = Op::constant, .value = 1e5 / 60.0},
                              {.op = Op::multiply, .a = 11, .b = 12}})};
}

EngineCylinders::Params cylinder(std::vector<double> degrees, std::vector<double> bar) {
  EngineCylinders::Params p{.bore = 0.1, .stroke = 0.1, .rod = 0.2, .firing_angles = {0.0}};
  for (const double angle : degrees) p.gas.angle.push_back(deg(angle));
  for (const double pressure : bar) p.gas.pressure.push_back(1e5 * pressure);
  return p;
}

}  // namespace

TEST_CASE("Orders of narrow loads, wherever they stand in two turns, are their integrals", "[linear_sweep]") {
  const std::vector<double> orders{0.5, 1.0, 1.5, 2.0};
  const PeriodicTable table({0.0, deg(90), deg(92), deg(94)}, {0.0, 0.0, 100.0, 0.0}, 2.0 * kTwoPi);
  std::vector<System> systems;
  for (const double phase : {0.0, 0.8, 1.7, 3.0})
    systems.push_back(loaded<TorqueFunction>(short_pulse(phase)));
  for (const double width : {2.0, 10.0})
    systems.push_back(loaded<EngineCylinders>(
        cylinder({0.0, 90.0, 90.0 + 0.5 * width, 90.0 + width, 180.0}, {0.0, 0.0, 100.0, 0.0, 0.0})));
  for (const auto interpolation : {Interpolation::linear, Interpolation::cubic})
    systems.push_back(loaded<CamTorque>({.angle_table = table, .interpolation = interpolation}));
  for (const System& system : systems) {
    std::vector<Finding> findings;
    OrderContent content(system, orders, findings);
    REQUIRE(findings.empty());
    for (const double speed : {60.0, 90.0}) {
      const OrderContent::Content& found = content.at(speed)[0];
      constexpr int kPoints = 40000;
      double mean = 0.0;
      std::vector<std::complex<double>> sums(orders.size());
      for (int i = 0; i < kPoints; ++i) {
        const double angle = 2.0 * kTwoPi * (i + 0.5) / kPoints;
        const double torque =
            system.loads()[0]
                .load->evaluate({.nominal_angle = angle, .speed = speed, .nominal_speed = speed})
                .torque;
        mean += torque / kPoints;
        for (std::size_t k = 0; k < orders.size(); ++k)
          sums[k] += (2.0 * torque / kPoints) * std::polar(1.0, -orders[k] * angle);
      }
      INFO(&system - systems.data() << ", " << speed);
      CHECK(found.mean == Approx(mean).epsilon(1e-4));
      for (std::size_t k = 0; k < orders.size(); ++k)
        CHECK(std::abs(found.amplitudes[k] - sums[k]) <= 1e-4 * std::abs(sums[0]));
    }
  }
}

TEST_CASE("Orders of an engine do not depend on the speed that is asked for first", "[linear_sweep]") {
  // A spike that the speed 100 rad/s has, through a gate that opens at 70 rad/s.
  EngineCylinders::Params p =
      cylinder({0, 180, 0, 180, 91, 92, 93, 400}, {0.0, 10.0, 0.0, 20.0, 0.0, 100.0, 0.0, 0.0});
  p.gas.speed = {0.0, 0.0, 50.0, 50.0, 100.0, 100.0, 100.0, 100.0};
  p.gas.firing = {.from_speed = 70.0, .speed_ramp = 5.0};
  const System system = loaded<EngineCylinders>(p);
  std::vector<Finding> findings;
  OrderContent alone(system, {0.5, 1.0, 1.5}, findings), after(system, {0.5, 1.0, 1.5}, findings);
  REQUIRE(findings.empty());
  after.at(20.0);
  CHECK(alone.at(100.0)[0].amplitudes == after.at(100.0)[0].amplitudes);
  CHECK(std::abs(alone.at(100.0)[0].amplitudes[0]) > 1.0);
}
