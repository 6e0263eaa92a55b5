// The force of a mesh over phase and load as a product, beside the mesh cycle's own forces and independent finite elements.
#include <drev/core/error.hpp>
#include <drev/models/gears/gear_drawing.hpp>

#include <cmath>

#include "models/gears/gear_element.hpp"
#include "tests/catch.hpp"
#include "tests/unit/models/gears/gear_pairs.hpp"

using namespace drev;

namespace {

GearDrawing drawing_of(const GearGeometry& geometry, bool corner_contact) {
  GearDrawing drawing;
  drawing.geometry = geometry;
  drawing.cycle.load = 100e3;
  drawing.cycle.points = 50;
  drawing.cycle.corner_contact = corner_contact;
  drawing.loads = {30e3, 100e3, 300e3, 1000e3};
  return drawing;
}

}  // namespace

TEST_CASE("The force over the approach is the mesh cycle's at its own load", "[gears]") {
  for (const GearGeometry& geometry : {gear_pairs::t2(), gear_pairs::helical()}) {
    const MeshCycle cycle(GearPair(geometry), {.points = 20});
    for (const MeshPoint& p : cycle.points())
      CHECK(std::abs(cycle.force(p.phase, p.loaded_error - p.unloaded_error) / 100e3 - 1.0) < 1e-8);
    CHECK(cycle.force(0.3, 0.0) == 0.0);
    CHECK(cycle.force(0.3, -1e-6) == 0.0);
  }
}

TEST_CASE("Stiffness by phase and load as a product is near the mesh cycle's", "[gears]") {
  for (const GearGeometry& geometry : {gear_pairs::t1n(), gear_pairs::t2(), gear_pairs::r62()}) {
    const GearMeshData data = gear_mesh_data(drawing_of(geometry, false));
    REQUIRE(data.load_law);
    const GearLoadLaw& law = *data.load_law;
    INFO(law.error.rms << " " << law.error.most << ", constant " << law.constant.rms << " "
                       << law.constant.most);
    CHECK(law.error.most < 0.025);
    CHECK(law.constant.most > 0.07);
    CHECK(law.error.rms < 0.2 * law.constant.rms);
    for (std::size_t i = 1; i < law.slopes.size(); ++i) CHECK(law.slopes[i] > law.slopes[i - 1]);
  }
}

TEST_CASE("The element's force under other loads than its own is that of independent finite elements",
          "[gears]") {
  // Stiffness per width at w = 300 N/mm of a drawing for 100 N/mm: mean 18.517, double zone 19.922, single zone 13.802.
  GearDrawing drawing = drawing_of(gear_pairs::t2(), false);
  const GearMesh mesh(gear_mesh_params(drawing));
  const double width = 0.13, load = 300e3 * width;
  double sums[2] = {}, counts[2] = {};
  for (int i = 0; i < 100; ++i) {
    const double phase = (i + 0.5) / 100;
    double low = 0.0, high = 1e-4;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      (mesh.evaluate({.x = middle, .angle = phase * 2.0 * 3.141592653589793 / 34}).y < load ? low : high) =
          middle;
    }
    const int zone = phase < 0.77 ? 0 : 1;
    sums[zone] += load / high / width / 1e9, counts[zone] += 1.0;
  }
  CHECK(std::abs(sums[0] / counts[0] / 19.922 - 1.0) < 0.02);
  CHECK(std::abs(sums[1] / counts[1] / 13.802 - 1.0) < 0.02);
  CHECK(std::abs((sums[0] + sums[1]) / 100 / 18.517 - 1.0) < 0.02);
  // The slope of the mean load is the stiffness that modes take: 18.463.
  CHECK(std::abs(mesh.closed_stiffness() / width / 18.463e9 - 1.0) < 0.02);
}

TEST_CASE("Pairs that touch under load alone make the product worse, and it says so", "[gears]") {
  GearDrawing drawing = drawing_of(gear_pairs::t2(), true);
  const GearMeshData plain = gear_mesh_data(drawing);
  for (TipRelief& relief : drawing.cycle.tip_relief) relief = {.depth = 6e-6, .length = 10e-3};
  const GearMeshData relieved = gear_mesh_data(drawing);
  CHECK(plain.load_law->error.most > 0.02);
  CHECK(relieved.load_law->error.rms > plain.load_law->error.rms);
  CHECK(relieved.load_law->error.rms < relieved.load_law->constant.rms);
}

TEST_CASE("Loads that are none are refused", "[gears]") {
  const auto refusal = [](std::vector<double> loads, bool tangent = false) {
    GearDrawing drawing = drawing_of(gear_pairs::t2(), false);
    drawing.loads = std::move(loads);
    drawing.tangent = tangent;
    try {
      gear_mesh_data(drawing);
    } catch (const ModelError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(refusal({-1.0, 2e5}).find("loads[0]") != std::string::npos);
  CHECK(refusal({2e5, 1e5}).find("loads[1]") != std::string::npos);
  CHECK(refusal({1e5}, true).find("tangent") != std::string::npos);
}
