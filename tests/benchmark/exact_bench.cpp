// Exact propagation beside average acceleration at 1e-5 s, with the main job's observers: processor
// time, and the error of each at 0.05 s (of exact propagation at tolerance 1e-14). Fastest of 3
// runs. Then what mesh laws cost it.
//   build/release/bin/bench_exact
#include <drev/core/system.hpp>
#include <drev/elements/gear_mesh.hpp>
#include <drev/models/ready_made.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/run/contact_statistics.hpp>
#include <drev/solvers/run/peaks.hpp>
#include <drev/solvers/stepping/step_scheme.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <memory>

#include "tests/catch.hpp"

using namespace drev;

namespace {

template <class Run>
double fastest_seconds(const Run& run) {
  double best = 1e9;
  for (int i = 0; i < 3; ++i) {
    const std::clock_t start = std::clock();
    run();
    best = std::min(best, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  return best;
}

}  // namespace

TEST_CASE("Exact propagation of the camshaft beside average acceleration") {
  std::printf(
      "| drive, loads | exact [s] | steps | us a step | average acceleration [s] | ratio | "
      "error of exact | of average acceleration |\n");
  for (const auto& [drive, loads] : {std::pair{"held", "source"}, {"held", "actual"}, {"gears", "actual"}}) {
    Parameters s("camshaft", camshaft_entry().parameters);
    s.set("drive", drive);
    s.set("loads", loads);
    const ModelCase model_case = camshaft_entry().build(s);
    const System system = model_case.model.build();
    RunSummary exact;
    const auto observed = [&](const auto& run) {
      Peaks torque(find_channels(system, model_case.torques));
      Peaks deflection(find_channels(system, {model_case.deflection}));
      ContactStatistics contacts(system);
      return run(std::vector<Observer*>{&torque, &deflection, &contacts});
    };
    const double t_exact = fastest_seconds(
        [&] { exact = observed([&](const auto& o) { return propagate(system, {.t_end = 5.0}, o); }); });
    const double t_steps = fastest_seconds(
        [&] { observed([&](const auto& o) { return simulate(system, {.step = 1e-5, .t_end = 5.0}, o); }); });
    CHECK(exact.ok());
    State at_default = State::initial(system), tight = at_default, stepped = at_default;
    propagate(system, {.t_end = 0.05}, at_default);
    propagate(system, {.tolerance = 1e-14, .t_end = 0.05}, tight);
    simulate(system, {.step = 1e-5, .t_end = 0.05}, stepped);
    const double peak = tight.z.lpNorm<Eigen::Infinity>();
    std::printf("| %s, %s | %.2f | %ld | %.2f | %.2f | %.2f | %.0e | %.0e |\n", drive, loads, t_exact,
                exact.steps, 1e6 * t_exact / static_cast<double>(exact.steps), t_steps, t_steps / t_exact,
                (at_default.z - tight.z).lpNorm<Eigen::Infinity>() / peak,
                (stepped.z - tight.z).lpNorm<Eigen::Infinity>() / peak);
  }
}

TEST_CASE("Mesh laws under exact propagation: stiffness by phase and damping, beside constant and none") {
  // The camshaft's gear drive, 0.5 s at a tolerance of 1e-8: later stepped stiffness drives the undamped motion up. Errors of
  // the angles at 2 ms over the largest, beside dormand_prince at 1e-11, which shares no series and takes seconds for that.
  std::printf("| mesh | time [s] | steps | ratio | error |\n|---|---|---|---|---|\n");
  struct Row {
    const char* name;
    void (*change)(GearMesh::Params&);
  };
  const Row rows[] = {
      {"constant stiffness, no damping", [](GearMesh::Params&) {}},
      {"stiffness in steps",
       [](GearMesh::Params& p) {
         p.stiffness = MeshStiffness::step(0.85 * p.stiffness.mean(), 1.15 * p.stiffness.mean(), 1.5);
       }},
      {"stiffness as Fourier series, 5 orders",
       [](GearMesh::Params& p) {
         p.stiffness =
             MeshStiffness::fourier_of_step(0.85 * p.stiffness.mean(), 1.15 * p.stiffness.mean(), 1.5, 5);
       }},
      {"stiffness as table of 8 points",
       [](GearMesh::Params& p) {
         const double k = p.stiffness.mean();
         p.stiffness = MeshStiffness::table(
             {0.0, 0.1, 0.25, 0.45, 0.5, 0.6, 0.75, 0.95},
             {1.1 * k, 1.14 * k, 1.16 * k, 1.12 * k, 0.9 * k, 0.86 * k, 0.84 * k, 0.88 * k});
       }},
      {"proportional damping", [](GearMesh::Params& p) { p.damping = 2e4; }},
      {"limited damping",
       [](GearMesh::Params& p) {
         p.damping = 2e4;
         p.damping_law = MeshDamping::limited;
       }},
      {"proportional damping, stiffness in steps", [](GearMesh::Params& p) {
         p.damping = 2e4;
         p.stiffness = MeshStiffness::step(0.85 * p.stiffness.mean(), 1.15 * p.stiffness.mean(), 1.5);
       }}};
  double constant = 0.0;
  for (const Row& row : rows) {
    Parameters s("camshaft", camshaft_entry().parameters);
    s.set("damping", "undamped");
    const ModelCase model_case = camshaft_entry().build(s);
    Model m("camshaft");
    for (const std::string& node : model_case.model.node_names()) m.add_node(node);
    for (const ElementInstance& p : model_case.model.element_instances()) {
      const auto* mesh = dynamic_cast<const GearMesh*>(p.element.get());
      if (mesh == nullptr) {
        m.add(p.name, p.nodes, p.element);
        continue;
      }
      GearMesh::Params params = mesh->params();
      if (params.teeth_1 == 0) params.teeth_1 = 60, params.teeth_2 = 0;
      params.damping = 0.0;
      row.change(params);
      m.add(p.name, p.nodes, std::make_shared<GearMesh>(params));
    }
    for (const Model::Prescription& p : model_case.model.prescriptions()) m.constant_speed(p.node, *p.omega);
    const System system = m.build();
    RunSummary run;
    const double seconds =
        fastest_seconds([&] { run = propagate(system, {.tolerance = 1e-8, .t_end = 0.5}); });
    CHECK(run.ok());
    if (constant == 0.0) constant = seconds;
    State at_tolerance = State::initial(system), other = at_tolerance;
    propagate(system, {.tolerance = 1e-8, .t_end = 0.002}, at_tolerance);
    simulate(system, {.scheme = step_scheme("dormand_prince"), .tolerance = 1e-11, .t_end = 0.002}, other);
    std::printf("| %s | %.3f | %ld | %.2f | %.1e |\n", row.name, seconds, run.steps, seconds / constant,
                (at_tolerance.z - other.z).lpNorm<Eigen::Infinity>() / other.z.lpNorm<Eigen::Infinity>());
  }
}
