/// Torsional vibration calculations whose numbers were found by separate programs (numpy and scipy; Holzer state
/// vectors in C++), and published ones that these reproduce:
///
/// - six-cylinder diesel: tests/problems/engine_chain.hpp;
/// - marine shafting, five-cylinder two-stroke engine: natural frequencies printed by a public program for it;
/// - steam turbine with double reduction: E. J. Gunter, W. J. Chen, Dynamics of Rotors and Foundations (DyRoBeS),
///   2001, example 8.1, after openTorsion's example (commit 88ab789, MIT).
#include <drev/core/element.hpp>
#include <drev/core/load.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/models/modal_damping.hpp>
#include <drev/solvers/modes/damped_modes.hpp>
#include <drev/solvers/modes/modes.hpp>
#include <drev/solvers/periodic/linear_sweep.hpp>

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "tests/catch.hpp"
#include "tests/problems/engine_chain.hpp"
#include "tests/problems/sampled_cylinder.hpp"
#include "tests/problems/square_law.hpp"
#include "tests/published/read_csv.hpp"

using namespace drev;

namespace {

using Complex = std::complex<double>;

struct OrderRow {
  double order;
  Complex cylinder, flywheel_shaft;
};

std::vector<OrderRow> order_rows(double speed_rpm) {
  std::vector<OrderRow> rows;
  for (const std::vector<std::string>& row : read_csv("six_cylinder_orders.csv")) {
    const auto number = [&](std::size_t i) { return std::stod(row[i]); };
    if (number(0) != speed_rpm) continue;
    rows.push_back({number(1), {number(2) + number(4), number(3) + number(5)}, {number(6), number(7)}});
  }
  return rows;
}

const SweepSection& section_of(const LinearSweep& sweep, const std::string& name) {
  for (const SweepSection& section : sweep.sections)
    if (section.name == name) return section;
  throw std::runtime_error("no section " + name);
}

test::EngineChain engine_at(double speed_rpm) {
  test::EngineChain engine;
  for (const OrderRow& row : order_rows(speed_rpm)) {
    engine.orders.push_back(row.order);
    engine.torque.push_back(row.cylinder);
  }
  return engine;
}

}  // namespace

TEST_CASE("Six cylinders: natural frequencies", "[torsional_vibration]") {
  const ModeSet modes = solve_modes(engine_at(2000).model().build(), {.count = 8});
  const std::vector<double> expected{216.583605,  592.740480,  984.922964,  1171.017408,
                                     1415.995017, 1660.043912, 1794.387580, 2993.473563};
  for (std::size_t i = 0; i < 8; ++i) CHECK(modes.frequency_Hz[i] == Approx(expected[i]).epsilon(2e-9));
}

TEST_CASE("Six cylinders as openTorsion's example samples them: its sums of amplitudes",
          "[torsional_vibration]") {
  // Expected: the example itself (openTorsion 0.3.2), whose torque is the stiffness times the twist.
  const test::SampledCylinder::Curves curves = test::sampled_curves(test::measured_pressure());
  LinearSweepOptions options{.sections = {"shaft_1.torque_Nm", "shaft_8.torque_Nm"}, .refine = false};
  for (const double speed : {1000.0, 1500.0, 2000.0, 2175.0, 2500.0})
    options.speeds.push_back(test::SampledCylinder::kSlower * rpm(speed));
  const LinearSweep sweep = sweep_linear(test::sampled_engine(curves).build(), options);
  const auto sum = [&](std::size_t section, Eigen::Index speed) {
    return test::EngineChain::kStiffnesses[section == 0 ? 0 : 7] *
           sweep.sections[section].twist.col(speed).cwiseAbs().sum();
  };
  CHECK(sum(1, 0) == Approx(2825.9136087512034).epsilon(1e-10));
  CHECK(sum(1, 1) == Approx(4401.031632531314).epsilon(1e-10));
  CHECK(sum(1, 2) == Approx(5959.822052802842).epsilon(1e-10));
  CHECK(sum(1, 3) == Approx(9612.108595295269).epsilon(1e-10));
  CHECK(sum(1, 4) == Approx(2458.647349935446).epsilon(1e-10));
  CHECK(sum(0, 3) == Approx(872.4323352652184).epsilon(1e-10));
}

TEST_CASE("Six cylinders with a loss factor: every order of the flywheel shaft at five speeds",
          "[torsional_vibration]") {
  // A loss factor eta of a shaft is at one frequency w a damper c = eta k / w: one order a model.
  for (const double speed_rpm : {1000.0, 1500.0, 2000.0, 2175.0, 2500.0}) {
    const std::vector<OrderRow> rows = order_rows(speed_rpm);
    REQUIRE(rows.size() == 24);
    double largest = 0.0;
    for (const OrderRow& row : rows) largest = std::max(largest, std::abs(row.flywheel_shaft));
    for (const OrderRow& row : rows) {
      test::EngineChain engine;
      engine.orders = {row.order};
      engine.torque = {row.cylinder};
      engine.damping_over_stiffness = 0.035 / (row.order * rpm(speed_rpm));
      const LinearSweep sweep = sweep_linear(engine.model().build(), {.speeds = {rpm(speed_rpm)},
                                                                      .orders = {row.order},
                                                                      .sections = {"shaft_8.torque_Nm"},
                                                                      .refine = false});
      CHECK(std::abs(sweep.sections[0].amplitude(0, 0) - row.flywheel_shaft) < 1e-8 * largest);
    }
  }
}

TEST_CASE("Six cylinders with viscous shafts: half range of the sum of 24 orders", "[torsional_vibration]") {
  // Expected: complex amplitudes by one program, an exact-step solution in time by another.
  const double damping = 0.035 / (kTwoPi * 216.58360524);
  for (const auto& [speed_rpm, half_range] :
       {std::pair{2000.0, 4374.517421}, std::pair{2175.0, 7986.109137}}) {
    test::EngineChain engine = engine_at(speed_rpm);
    engine.damping_over_stiffness = damping;
    const LinearSweep sweep =
        sweep_linear(engine.model().build(), {.speeds = {rpm(speed_rpm)}, .refine = false});
    const SweepSection& shaft = section_of(sweep, "shaft_8.torque_Nm");
    CHECK(shaft.half_range()[0] == Approx(half_range).epsilon(2e-9));
    if (speed_rpm == 2175.0) CHECK(std::abs(shaft.amplitude(11, 0)) == Approx(6171.412427).epsilon(2e-9));
    CHECK(sweep.input_power[0] == Approx(sweep.dissipated_power[0]).epsilon(1e-11));
    double heat = 0.0;  // all dampers of the model are elements
    for (const SweepSection& section : sweep.sections) heat += section.heat[0];
    CHECK(heat == Approx(sweep.dissipated_power[0]).epsilon(1e-11));
  }
}

TEST_CASE("Marine shafting: damped modes at 66 rpm with the propeller's law", "[torsional_vibration]") {
  const std::vector<double> inertias{8730, 578, 4920, 4920,   4920,   4920,
                                     4920, 735, 8136, 82.095, 194.14, 21497};
  const std::vector<double> stiffnesses{18e6,   1.508e9, 1.344e9, 1.344e9,  1.344e9, 1.344e9,
                                        .892e9, .509e9,  .02e9,   62.058e9, 19.377e9};
  const double full_speed = rpm(99.0), factor = 6350e3 / std::pow(full_speed, 3);
  Model m("marine shafting");
  for (std::size_t i = 0; i < inertias.size(); ++i) {
    const std::string node = "n" + std::to_string(i), before = "n" + std::to_string(i - 1);
    m.add_node(node);
    m.add<Inertia>("J" + std::to_string(i), {node}, {.inertia = inertias[i]});
    if (i > 0)
      m.add<ShaftSpring>("k" + std::to_string(i), {before, node},
                         {.stiffness = stiffnesses[i - 1], .damping = i == 1 ? 2e5 : 0.0});
    if (i >= 2 && i <= 6) m.add<Dashpot>("c" + std::to_string(i), {node}, {.damping = 540.0});
  }
  m.add<SquareLaw>("propeller", {"n11"}, {.factor = factor});
  m.set_reference("n11", constant_speed(rpm(66.0)));
  const System system = m.build();
  // Printed: 330.08, 502.10, 1872.20 cycles/min.
  const ModeSet modes = solve_modes(system, {.count = 5});
  const std::vector<double> cycles{330.079056, 502.104797, 1872.169395, 3486.585601, 5887.846935};
  for (std::size_t i = 0; i < 5; ++i) CHECK(60.0 * modes.frequency_Hz[i] == Approx(cycles[i]).epsilon(2e-9));

  const Vector damping = load_damping(system, rpm(66.0));
  CHECK(damping.sum() == Approx(78774.3515).epsilon(1e-9));
  const DampedModeSet damped = solve_damped_modes(system, {.damping = damping});
  const std::vector<Complex> expected{
      {-1.93311178, 34.86885142}, {-12.93576269, 50.66091318}, {-3.44630774, 195.69446473}};
  for (std::size_t i = 0; i < 3; ++i) CHECK(std::abs(damped.modes[i].lambda - expected[i]) < 1e-7);
  CHECK(damped.rigid_modes == 1);
  REQUIRE(damped.real_lambda.size() == 1);
  CHECK(damped.real_lambda[0] == Approx(-1.26500830).epsilon(1e-7));
}

namespace {

constexpr double kPoundInch = 0.11298;

/// 5 a revolution, growing with the square of the speed.
class BladeTorque final : public Element, public Load {
 public:
  struct Params {
    double at_full_speed = 0.0, full_speed = 0.0;  // N m, rad/s
  };
  explicit BladeTorque(Params params) : params_(params) {}
  std::string_view type() const override { return "blade torque"; }
  int min_nodes() const override { return 1; }
  void check(ParameterCheck& check) const override {
    check.positive("full_speed", params_.full_speed, "rad/s");
  }
  void describe(int /*nodes*/, Terms& terms) const override { terms.loads.push_back({0, this}); }
  bool depends_on_motion() const override { return true; }
  LoadResponse evaluate(const LoadInput& in) const override {
    const double part = in.speed / params_.full_speed;
    return {.torque = params_.at_full_speed * part * part * std::cos(5.0 * in.nominal_angle)};
  }

 private:
  Params params_;
};

constexpr std::array<double, 6> kTurbineInertias{2.454e6, .826e6,  2.723e4,
                                                 2.612e2, 1.283e4, 1.509e4};  // lb in s^2

Model turbine() {
  const double lb = kPoundInch;
  Model m("steam turbine");
  const auto disc = [&](const char* name, double inertia) {
    m.add_node(name);
    m.add<Inertia>(std::string("J_") + name, {name}, {.inertia = lb * inertia});
  };
  disc("propeller", kTurbineInertias[0]);
  disc("bull", kTurbineInertias[1]);
  disc("hp_gear", kTurbineInertias[2]);
  disc("hp_turbine", kTurbineInertias[3]);
  disc("lp_gear", kTurbineInertias[4]);
  disc("lp_turbine", kTurbineInertias[5]);
  // The shafts between the gears of the two reductions, on each side.
  for (const char* name : {"hp_pinion", "hp_high", "lp_pinion", "lp_high"}) m.add_node(name);
  m.add<ShaftSpring>("propeller_shaft", {"propeller", "bull"}, {.stiffness = lb * 826e6});
  m.add<IdealGear>("hp_second", {"bull", "hp_pinion"}, {.ratio = 9.4094});
  m.add<ShaftSpring>("hp_intermediate", {"hp_pinion", "hp_gear"}, {.stiffness = lb * 24.17e6});
  m.add<IdealGear>("hp_first", {"hp_gear", "hp_high"}, {.ratio = 78.2365 / 9.4094});
  m.add<ShaftSpring>("hp_shaft", {"hp_high", "hp_turbine"}, {.stiffness = lb * 14.26e6});
  m.add<IdealGear>("lp_second", {"bull", "lp_pinion"}, {.ratio = 9.4094});
  m.add<ShaftSpring>("lp_intermediate", {"lp_pinion", "lp_gear"}, {.stiffness = lb * 203.94e6});
  m.add<IdealGear>("lp_first", {"lp_gear", "lp_high"}, {.ratio = 40.0424 / 9.4094});
  m.add<ShaftSpring>("lp_shaft", {"lp_high", "lp_turbine"}, {.stiffness = lb * 30.51e6});
  m.set_reference("propeller", constant_speed(rpm(85.0)));
  return m;
}

}  // namespace

TEST_CASE("Steam turbine with double reduction: frequencies and forced vibration", "[torsional_vibration]") {
  Model m = turbine();
  const ModeSet modes = solve_modes(m.build(), {.count = 5});
  // Printed: 177.7, 220.2, 1282.6 cycles/min.
  const std::vector<double> cycles{177.711152, 220.176283, 1282.584557, 2496.867189, 2883.382381};
  for (std::size_t i = 0; i < 5; ++i) CHECK(60.0 * modes.frequency_Hz[i] == Approx(cycles[i]).epsilon(5e-9));

  add_modal_damping(m, "modal", {.ratio = 0.00398});
  m.add<Dashpot>("drag_propeller", {"propeller"}, {.damping = kPoundInch * 3.86e6});
  m.add<Dashpot>("drag_hp", {"hp_turbine"}, {.damping = kPoundInch * 42.738});
  m.add<Dashpot>("drag_lp", {"lp_turbine"}, {.damping = kPoundInch * 108.77});
  m.add<BladeTorque>("blades", {"propeller"},
                     {.at_full_speed = kPoundInch * 0.1 * 22.24e6, .full_speed = rpm(85.0)});
  LinearSweepOptions options{
      .speeds = {rpm(20), rpm(30), rpm(50), rpm(80)},
      .orders = {5.0},
      .sections = {"propeller_shaft.torque_Nm", "lp_intermediate.torque_Nm", "hp_intermediate.torque_Nm"}};
  const LinearSweep sweep = sweep_linear(m.build(), options);
  const Vector propeller = sweep.sections[0].half_range();
  const std::vector<double> expected{18784.540, 97677.189, 81305.367, 50287.752};
  for (int i = 0; i < 4; ++i) CHECK(propeller[i] == Approx(expected[std::size_t(i)]).epsilon(1e-7));
  CHECK(sweep.sections[1].half_range()[1] == Approx(8827.1481).epsilon(1e-7));
  CHECK(sweep.sections[2].half_range()[1] == Approx(1399.2269).epsilon(1e-7));
  // Between the four speeds; the book's curve has 471,680 (4.1489e6 lb in) at 35.46.
  CHECK(to_rpm(sweep.peaks[0].speed) == Approx(35.599523).epsilon(1e-7));
  CHECK(sweep.peaks[0].half_range == Approx(471688.780).epsilon(1e-8));
}
