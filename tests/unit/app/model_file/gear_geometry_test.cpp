// A gear mesh by its geometry in a model file: what the element gets, what is refused, the camshaft's example.
#include <drev/app/model_file/model_file.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/gear_mesh.hpp>
#include <drev/models/gears/gear_drawing.hpp>

#include <cmath>

#include "models/gears/gear_element.hpp"
#include "tests/catch.hpp"

using namespace drev;

namespace {

const std::string kHead =
    "format = 1\nnote = \"gear pair\"\n[nodes]\na = { nominal_speed_rpm = 100, hold = true }\nb = "
    "{}\n[elements]\n"
    "J = { type = \"inertia\", node = \"b\", inertia_kg_m2 = 1 }\n[elements.z]\ntype = \"gear_mesh\"\nnodes "
    "= [\"a\", \"b\"]\n";
const std::string kDrawing =
    "[elements.z.geometry]\nmodule_mm = 9\nload_N_per_mm = 100\npoints = 10\n"
    "gear_1 = { teeth = 34, profile_shift = -0.082, width_mm = 130, bore_diameter_mm = 141, "
    "upper_allowance_um = -75 }\n"
    "gear_2 = { teeth = 59, profile_shift = -0.082, width_mm = 130, bore_diameter_mm = 253.5, "
    "upper_allowance_um = -75";

GearMesh::Params mesh_of(const ModelCase& model_case, const std::string& name) {
  for (const ElementInstance& one : model_case.model.element_instances())
    if (one.name == name) return dynamic_cast<const GearMesh&>(*one.element).params();
  throw std::runtime_error("no such mesh");
}

ModelCase case_of(const std::string& text) {
  const app::ModelFile file(text, "gears.toml", "");
  return file.entry().build(Parameters(file.entry().name, file.entry().parameters));
}

std::string message_of(const std::string& text) {
  try {
    case_of(text);
  } catch (const ModelError& error) {
    std::string all;
    for (const Finding& finding : error.findings()) all += finding.text() + "\n";
    return all;
  }
  return "";
}

bool has(const std::string& text, const std::string& part) {
  INFO(text);
  CHECK(text.find(part) != std::string::npos);
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("A gear mesh by its geometry is the one that C++ makes of the drawing", "[model_file]") {
  const GearMesh::Params mesh =
      mesh_of(case_of(kHead + "mesh_phase_periods = 0.25\ndamping_Ns_per_m = 10\n" + kDrawing + " }\n"), "z");
  GearDrawing drawing;
  drawing.geometry.module = 0.009;
  drawing.cycle.load = 100e3;
  drawing.cycle.points = 10;
  drawing.geometry.gear_1 = {.teeth = 34, .profile_shift = -0.082, .width = 0.13, .bore_diameter = 0.141};
  drawing.geometry.gear_2 = {.teeth = 59, .profile_shift = -0.082, .width = 0.13, .bore_diameter = 0.2535};
  drawing.tolerances.thickness = {{{-75e-6, 0.0}, {-75e-6, 0.0}}};
  const GearMesh::Params made = gear_mesh_params(drawing);
  CHECK(std::abs(mesh.base_radius_1 / (0.153 * std::cos(20.0 * kPi / 180.0)) - 1.0) < 1e-14);
  CHECK(std::abs(mesh.base_radius_2 / made.base_radius_2 - 1.0) < 1e-14);
  CHECK(mesh.teeth_1 == 34);
  CHECK(mesh.teeth_2 == 59);
  CHECK(mesh.damping == 10.0);
  CHECK(mesh.mesh_phase == 0.25);
  CHECK(std::abs(mesh.normal_backlash / (150e-6 * std::cos(20.0 * kPi / 180.0)) - 1.0) < 1e-6);
  for (const double phase : {0.05, 0.4, 0.85})
    CHECK(std::abs(mesh.stiffness.at(phase).value / made.stiffness.at(phase).value - 1.0) < 1e-12);
  // 130 mm times the single and double stiffness of the independent finite elements, bore .5: 13.25 and 19.57.
  CHECK(std::abs(mesh.stiffness.at(0.85).value / (13.25e9 * 0.13) - 1.0) < 0.02);
  CHECK(std::abs(mesh.stiffness.at(0.35).value / (19.57e9 * 0.13) - 1.0) < 0.02);
  CHECK(!mesh.transmission_error.varies());
  // Loads between which the stiffness follows them: at the mean load as without, where it is stiffer behind.
  const GearMesh::Params loaded =
      mesh_of(case_of(kHead + kDrawing + " }\nloads = { load_N_per_mm = [30, 100, 300] }\n"), "z");
  REQUIRE(loaded.stiffening.slopes.size() == 4);
  CHECK(loaded.stiffening.penetrations[0] == 0.0);
  CHECK(loaded.stiffening.slopes[0] < 1.0);
  CHECK(loaded.stiffening.slopes[3] > 1.0);
  has(message_of(kHead + "stiffening = { penetration_um = [0, 5], slope = [0.9, 1.1] }\n" + kDrawing +
                 " }\nloads = { load_N_per_mm = [30, 100, 300] }\n"),
      "has stiffening beside the loads of its geometry");
  // Tip relief brings an unloaded error along; a backlash given is taken.
  const GearMesh::Params relieved = mesh_of(case_of(kHead + "normal_backlash_mm = 0.2\n" + kDrawing +
                                                    ", tip_relief_um = 20, tip_relief_length_mm = 25 }\n"),
                                            "z");
  CHECK(relieved.normal_backlash == Approx(0.2e-3));
  CHECK(relieved.transmission_error.varies());
}

TEST_CASE("Faults of a geometry name the dimension", "[model_file]") {
  has(message_of(kHead + kDrawing + ", tip_diameter_mm = 580 }\n"),
      "gear_2.tip_diameter = 0.58 m, runs into the root");
  has(message_of(kHead + kDrawing + ", bore_diameter_m = 0.1 }\n"), "bore_diameter");
  has(message_of(kHead + "module_mm = 9\nteeth_1 = 34\n" + kDrawing + " }\n"),
      "has geometry beside base radii");
  has(message_of(kHead + "stiffness_N_per_m = 1e9\n" + kDrawing + " }\n"),
      "needs exactly one of stiffness_N_per_m");
  has(message_of(kHead + "[elements.z.geometry]\nmodule_mm = 9\ngear_1 = { teeth = 20 }\n"), "needs gear_2");
  std::string without_load = kHead + kDrawing + " }\n";
  without_load.erase(without_load.find("load_N_per_mm = 100\n"), 20);
  has(message_of(without_load), "load, or torque_1 must be given");
  has(message_of(kHead + kDrawing + ", colour = 3 }\n"), "colour");
  has(message_of(kHead + kDrawing + " }\npitch_deviations = { deviation_um = [0, 5] }\n"),
      "pitch_deviations");
}

TEST_CASE("The camshaft's gear drive runs from geometry alone", "[model_file]") {
  const app::ModelFile file(DREV_SOURCE_DIR "/models/camshaft_gears/camshaft_gears.toml", "");
  const ModelCase camshaft = file.entry().build(Parameters(file.entry().name, file.entry().parameters));
  const GearMesh::Params first = mesh_of(camshaft, "mesh_1"), second = mesh_of(camshaft, "mesh_2");
  // Independent finite elements, bores of .3 of the root circle, w 44.5 and 30.8 N/mm: one pair and two.
  CHECK(std::abs(first.stiffness.at(0.85).value / 9.15e8 - 1.0) < 0.02);
  CHECK(std::abs(first.stiffness.at(0.35).value / 1.256e9 - 1.0) < 0.02);
  CHECK(std::abs(second.stiffness.at(0.9).value / 1.357e9 - 1.0) < 0.02);
  CHECK(std::abs(second.stiffness.at(0.38).value / 1.860e9 - 1.0) < 0.02);
  CHECK(first.normal_backlash > 0.144e-3);
  CHECK(first.normal_backlash < 0.43e-3);
  CHECK(camshaft.model.build().size() > 30);
}
