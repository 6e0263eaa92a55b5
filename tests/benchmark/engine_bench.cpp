// A six-cylinder engine by its cylinders beside the same train with tables of torque over the crank angle: processor time
// of exact propagation at equal error and of a constant step, one program, by turns, fastest of 5.
//   build/release/bin/bench_engine
//
// The tables hold each cylinder's gas and mass torque at the nominal speed; they are linear between their points. The
// error is that of the angles at the end over the largest one, against the same model at a tolerance of 1e-13; "off" is
// how far the twists against the flywheel are from those of the cylinders (linear pressure), both at that tolerance: what
// a table leaves out by its few points, and by not following the actual speed.
#include <drev/core/system.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <algorithm>
#include <cstdio>
#include <ctime>

#include "tests/catch.hpp"
#include "tests/problems/engine_chain.hpp"
#include "tests/published/read_csv.hpp"

using namespace drev;

namespace {

using Chain = test::EngineChain;

EngineCylinders::Params diesel(Interpolation interpolation) {
  EngineCylinders::Params engine{.bore = 0.105,
                                 .stroke = 0.137,
                                 .rod = 0.207,
                                 .oscillating_mass = 2.521,
                                 .firing_angles = EngineCylinders::even_firing("1-4-2-6-3-5", 4, deg(360)),
                                 .gas = {.firing_tdc = deg(360), .interpolation = interpolation}};
  for (const auto& row : read_csv("../../../models/six_cylinder/pressure.csv")) {
    engine.gas.angle.push_back(deg(std::stod(row[0])));
    engine.gas.pressure.push_back(1e6 * std::stod(row[1]));
  }
  if (interpolation == Interpolation::cubic) engine.gas.angle.pop_back(), engine.gas.pressure.pop_back();
  return engine;
}

/// points: of the tables in place of the cylinders; 0: the cylinders themselves.
System train(const EngineCylinders::Params& engine, double speed, int points) {
  Model m("six cylinders");
  std::vector<NodeRef> throws;
  for (std::size_t i = 0; i < Chain::kInertias.size(); ++i) {
    const std::string node = "n" + std::to_string(i), before = "n" + std::to_string(i - 1);
    m.add_node(node);
    m.add<Inertia>("J_" + node, {node}, {.inertia = Chain::kInertias[i]});
    if (i > 0)
      m.add<ShaftSpring>(
          Chain::shaft(i - 1), {before, node},
          {.stiffness = Chain::kStiffnesses[i - 1], .damping = 2.5e-5 * Chain::kStiffnesses[i - 1]});
    if (i < 2 || i > 7) continue;
    m.add<AbsoluteDamper>("drag_" + node, {node}, {.damping = 2.0});
    throws.emplace_back(node);
  }
  const EngineCylinders alone(engine);
  double mean = 0.0;
  for (int k = 0; k < 6; ++k) mean += alone.mean_torque(k, speed);
  m.add<EngineOrderTorque>("brake", {"n8"}, {.mean = -mean});
  m.add<AbsoluteDamper>("grid", {"n8"}, {.damping = 500.0});
  if (points == 0)
    m.add("engine", throws, std::make_shared<const EngineCylinders>(engine));
  else
    for (int k = 0; k < 6; ++k) {
      std::vector<double> angles, torques;
      for (int i = 0; i < points; ++i) {
        angles.push_back(2.0 * kTwoPi * i / points);
        torques.push_back(alone.torque(k, angles.back(), speed));
      }
      m.add<CamTorque>("gas_" + std::to_string(k), {throws[std::size_t(k)]},
                       {.angle_table = PeriodicTable(angles, torques, 2.0 * kTwoPi)});
    }
  m.set_reference("n8", constant_speed(speed));
  return m.build();
}

}  // namespace

TEST_CASE("Six cylinders beside tables of their torque") {
  const double speed = rpm(2000.0), duration = 20.0 * 2.0 * kTwoPi / speed;
  struct Row {
    const char* name;
    System system;
    double seconds = 1e9, error = 0.0, off = 0.0;
    RunSummary run = {};
  };
  const auto timed = [](double& least, const auto& task) {
    const std::clock_t start = std::clock();
    task();
    least = std::min(least, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  };
  constexpr int kTurns = 5;
  std::vector<Row> rows;
  rows.push_back({"cylinders, linear", train(diesel(Interpolation::linear), speed, 0)});
  rows.push_back({"cylinders, cubic", train(diesel(Interpolation::cubic), speed, 0)});
  for (const auto& [name, points] : {std::pair{"tables of 75 points", 75},
                                     {"tables of 360 points", 360},
                                     {"tables of 720 points", 720},
                                     {"tables of 1440 points", 1440}})
    rows.push_back({name, train(diesel(Interpolation::linear), speed, points)});
  Vector cylinders;
  for (const double tolerance : {1e-7, 1e-9}) {
    for (Row& row : rows) {
      row.seconds = 1e9;
      State at_tolerance = State::initial(row.system), tight = at_tolerance;
      propagate(row.system, {.tolerance = tolerance, .t_end = duration}, at_tolerance);
      propagate(row.system, {.tolerance = 1e-13, .t_end = duration}, tight);
      row.error = (at_tolerance.z - tight.z).lpNorm<Eigen::Infinity>() / tight.z.lpNorm<Eigen::Infinity>();
      // Against the flywheel: a table's mean is not the engine's, so that the train as a whole drifts.
      const Vector twist = tight.z.array() - tight.z[tight.z.size() - 1];
      if (cylinders.size() == 0) cylinders = twist;
      row.off = (twist - cylinders).lpNorm<Eigen::Infinity>() / cylinders.lpNorm<Eigen::Infinity>();
    }
    for (int turn = 0; turn < kTurns; ++turn)
      for (Row& row : rows) {
        State state = State::initial(row.system);
        timed(row.seconds,
              [&] { row.run = propagate(row.system, {.tolerance = tolerance, .t_end = duration}, state); });
        CHECK(row.run.ok());
      }
    std::printf(
        "tolerance %.0e, 20 cycles at 2000 rpm\n| train | time [ms] | steps | us a step | error | off |\n",
        tolerance);
    for (const Row& row : rows)
      std::printf("| %s | %.1f | %ld | %.2f | %.1e | %.1e |\n", row.name, 1e3 * row.seconds, row.run.steps,
                  1e6 * row.seconds / static_cast<double>(row.run.steps), row.error, row.off);
  }
  constexpr double kStep = 1e-5;
  for (Row& row : rows) row.seconds = 1e9;
  for (int turn = 0; turn < kTurns; ++turn)
    for (Row& row : rows) {
      State state = State::initial(row.system);
      timed(row.seconds, [&] { row.run = simulate(row.system, {.step = kStep, .t_end = duration}, state); });
    }
  std::printf("constant step of %.0e s\n| train | time [ms] | steps | us a step | looks at loads a step |\n",
              kStep);
  for (const Row& row : rows)
    std::printf("| %s | %.1f | %ld | %.2f | %.2f |\n", row.name, 1e3 * row.seconds, row.run.steps,
                1e6 * row.seconds / static_cast<double>(row.run.steps),
                static_cast<double>(row.run.load_passes) / static_cast<double>(row.run.steps));
}
