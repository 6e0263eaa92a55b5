// Makes the pictures of the documentation: bin/pictures FOLDER writes
//   main_job.svg, main_job_deflection.svg   the main job over one turn of the camshaft
//   camshaft_modes.svg   the first three modes of the camshaft with its gear drive
//   work_precision.svg   error over steps, two masses with backlash, every implicit method
//   mesh_damping.svg     force of one impact under the four damping laws of a mesh
#include <drev/core/system.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/models/ready_made.hpp>
#include <drev/solvers/modes/modes.hpp>
#include <drev/solvers/run/recorder.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <cmath>
#include <cstdio>
#include <fstream>

#include "app/chart/svg_chart.hpp"

using namespace drev;
using app::ChartSeries;

namespace {

std::string folder;

void write(const std::string& name, const std::string& svg) {
  std::ofstream out(folder + "/" + name);
  out << svg;
  if (!out.flush()) throw std::runtime_error("cannot write " + folder + "/" + name);
  std::printf("%s/%s\n", folder.c_str(), name.c_str());
}

std::vector<double> scaled(const std::vector<double>& x, double factor) {
  std::vector<double> y;
  for (const double value : x) y.push_back(factor * value);
  return y;
}

void main_job(const ModelCase& model_case, const System& system) {
  Recorder r(system, {"mesh_1.force_N", "mesh_2.force_N", model_case.deflection}, 2e-5);
  const double cycle = 60.0 / 375;  // one turn of the camshaft at 750 rpm
  simulate(system, {.step = model_case.default_step, .t_end = 2 * cycle}, {&r});
  // The second of two.
  const auto n = r.times().size() / 2;
  const auto last = [n](const std::vector<double>& all) {
    return std::vector<double>(all.begin() + static_cast<std::ptrdiff_t>(n), all.end());
  };
  const std::vector<double> t = last(r.times());
  write("main_job.svg",
        app::svg_chart(
            {.title = "Gear drive of the camshaft: forces in the meshes",
             .x_label = "time [s]",
             .y_label = "force along the line of action [kN]",
             .height = 320},
            {{.name = "mesh_1, crank gear and idler", .x = t, .y = scaled(last(r.samples(0)), 1e-3)},
             {.name = "mesh_2, idler and camshaft gear", .x = t, .y = scaled(last(r.samples(1)), 1e-3)}}));
  write("main_job_deflection.svg",
        app::svg_chart({.title = "Camshaft: twist from the first to the last cam",
                        .x_label = "time [s]",
                        .y_label = "twist [deg]",
                        .height = 260},
                       {{.name = "inlet_9 - fuel_1", .x = t, .y = scaled(last(r.samples(2)), to_deg(1.0))}}));
}

void camshaft_modes(const System& system) {
  const ModeSet modes = solve_modes(system, {.count = 3});
  // Along the drive: crank gear, idler, then the shaft from its gear to its end.
  std::vector<int> nodes{system.node("crank_gear"), system.node("idler")};
  for (int i = 0; i < system.node_count(); ++i)
    if (i != nodes[0] && i != nodes[1]) nodes.push_back(i);
  std::vector<ChartSeries> series;
  for (int j = 0; j < modes.count(); ++j) {
    char name[64];
    std::snprintf(name, sizeof name, "%.1f Hz", modes.frequency_Hz[static_cast<std::size_t>(j)]);
    ChartSeries s{.name = name, .markers = true};
    const double largest = modes.shapes.col(j).cwiseAbs().maxCoeff();
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      s.x.push_back(static_cast<double>(k));
      s.y.push_back(modes.shapes(nodes[k], j) / largest);
    }
    series.push_back(std::move(s));
  }
  write("camshaft_modes.svg",
        app::svg_chart({.title = "Camshaft with gear drive: the first three modes, meshes closed",
                        .x_label = "station: crank gear, idler, camshaft gear, ... free end",
                        .y_label = "angle, largest = 1",
                        .vertical_lines = {{2.0, "camshaft gear"}},
                        .height = 340},
                       series));
}

void work_precision() {
  Parameters parameters("two_mass_backlash", two_mass_backlash_entry().parameters);
  const System system = two_mass_backlash_entry().build(parameters).model.build();
  std::vector<ChartSeries> series;
  // Case B at 2 s; reference: average acceleration with a step 125 times smaller than the smallest.
  const auto position = [&](const StepScheme& scheme, double h) {
    Recorder r(system, {"mass_1.position_m", "mass_2.position_m"}, 2.0);
    simulate(system, {.scheme = scheme, .step = h, .t_end = 2.0}, {&r});
    return std::pair{r.samples(0).back(), r.samples(1).back()};
  };
  const auto reference = position(average_acceleration(), 1e-6);
  for (const char* method :
       {"average_acceleration", "hht:0.05", "hht:0.3", "generalized_alpha:0.8", "generalized_alpha:0"}) {
    ChartSeries s{.name = method, .markers = true};
    for (const double h : {8e-3, 4e-3, 2e-3, 1e-3, 5e-4, 2.5e-4, 1.25e-4}) {
      const auto [x_1, x_2] = position(step_scheme(method), h);
      s.x.push_back(2.0 / h);
      s.y.push_back(std::max(std::abs(x_1 - reference.first), std::abs(x_2 - reference.second)));
    }
    series.push_back(std::move(s));
  }
  write("work_precision.svg", app::svg_chart({.title = "Two masses with backlash, case B: error at 2 s",
                                              .x_label = "steps",
                                              .y_label = "error of the positions [m]",
                                              .log_x = true,
                                              .log_y = true,
                                              .height = 340},
                                             series));
}

/// A gear of 6.5 kg m^2 on a radius of 0.25 m runs into the flank at 20 mm/s; xi = 0.1.
void mesh_damping() {
  const double radius = 0.25, inertia = 6.5, stiffness = 8e8, backlash = 80e-6;
  std::vector<ChartSeries> series;
  for (const auto& [name, law] : {std::pair{"proportional", MeshDamping::proportional},
                                  {"limited", MeshDamping::limited},
                                  {"contact_only", MeshDamping::contact_only},
                                  {"always", MeshDamping::always}}) {
    Model m("impact");
    m.add_node("held");
    m.add_node("gear");
    m.add<Inertia>("J_held", {"held"}, {.inertia = 1.0});
    m.add<Inertia>("J_gear", {"gear"}, {.inertia = inertia});
    m.add<GearMesh>("mesh", {"gear", "held"},
                    {.base_radius_1 = radius,
                     .base_radius_2 = radius,
                     .stiffness = stiffness,
                     .normal_backlash = backlash,
                     .damping = 0.2 * std::sqrt(stiffness * inertia) / radius,
                     .damping_law = law});
    m.hold("held");
    m.set_initial("gear", 0.25 * backlash / radius, 0.02 / radius);
    const System system = m.build();
    Recorder r(system, {"mesh.force_N"}, 2e-6);
    simulate(system, {.step = 1e-6, .t_end = 2.5e-3}, {&r});
    series.push_back({.name = name, .x = scaled(r.times(), 1e3), .y = scaled(r.samples(0), 1e-3)});
  }
  write("mesh_damping.svg", app::svg_chart({.title = "One impact under the four damping laws of a mesh",
                                            .x_label = "time [ms]",
                                            .y_label = "force [kN]",
                                            .height = 340},
                                           series));
}

}  // namespace

int main(int argc, char** argv) {
  folder = argc > 1 ? argv[1] : ".";
  try {
    const ModelCase model_case = camshaft_entry().build(Parameters("camshaft", camshaft_entry().parameters));
    const System system = model_case.model.build();
    main_job(model_case, system);
    camshaft_modes(system);
    work_precision();
    mesh_damping();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
