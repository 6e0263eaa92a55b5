// Shafts by their contour in model files: read, written, refused; the camshaft of models/camshaft_drawing.
#include <drev/app/model_file/model_file.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/models/shafts/contour_shaft.hpp>
#include <drev/solvers/modes/modes.hpp>
#include <drev/solvers/strength/section_strength.hpp>

#include <cmath>
#include <numbers>

#include "app/model_file/writing/export.hpp"
#include "tests/catch.hpp"

using namespace drev;

namespace {

ModelCase shaft_case(const std::string& text) {
  const app::ModelFile file("format = 1\n" + text, "shaft.toml", "");
  return file.entry().build(Parameters(file.entry().name, file.entry().parameters));
}

const char* const kStepped =
    "[nodes]\na = { nominal_speed_rpm = 60 }\nb = {}\n[elements.shaft]\ntype = \"contour_shaft\"\nnodes = "
    "[\"a\", \"b\"]\n"
    "shear_modulus_GPa = 80\ndensity_kg_per_m3 = 7850\nstations = [\n"
    "  { name = \"seat\", length_mm = 200, outer_diameter_mm = 100, fillet_end_mm = 10 },\n"
    "  { length_mm = 100, outer_diameter_mm = 150, groove = { position_mm = 50, depth_mm = 10, radius_mm = "
    "10 } },\n"
    "  { length_mm = 80, outer_diameter_mm = 120, keyway = { width_mm = 33.6, depth_mm = 12, "
    "corner_radius_mm = 2.4 } }\n"
    "]\n";

const ContourShaft& shaft_of(const ModelCase& model_case) {
  for (const ElementInstance& placement : model_case.model.element_instances())
    if (const auto* shaft = dynamic_cast<const ContourShaft*>(placement.element.get())) return *shaft;
  throw std::runtime_error("no shaft");
}

}  // namespace

TEST_CASE("A contour shaft is read, and written as it was read") {
  const ModelCase read = shaft_case(kStepped);
  const ShaftContour& contour = shaft_of(read).params();
  REQUIRE(contour.stations.size() == 3);
  CHECK(contour.stations[0].name == "seat");
  CHECK(contour.stations[1].groove->depth == Approx(0.01));
  CHECK(contour.stations[2].keyway->corner_radius == Approx(0.0024));
  const app::ModelFile file(std::string("format = 1\n") + kStepped, "shaft.toml", "");
  const std::string text =
      app::export_model(file.entry(), Parameters(file.entry().name, file.entry().parameters), read);
  const app::ModelFile again(text, "again.toml", "");
  const ModelCase back = again.entry().build(Parameters(again.entry().name, again.entry().parameters));
  CHECK(shaft_of(back).sections()->flexibility.value == shaft_of(read).sections()->flexibility.value);
}

TEST_CASE("What is wrong with a contour is said with its station and dimension") {
  std::string text = kStepped;
  text.replace(text.find("fillet_end_mm = 10"), 18, "fillet_end_mm = 300, colour = 1");
  try {
    shaft_case(text).model.build();
    FAIL("not refused");
  } catch (const ModelError& error) {
    CHECK_THAT(error.what(), Catch::Contains("stations[1].colour"));
  }
  text = kStepped;
  text.replace(text.find("depth_mm = 10"), 13, "depth_mm = 90");
  text.replace(text.find("width_mm = 33.6"), 15, "width_mm = 110.0");
  try {
    shaft_case(text).model.build();
    FAIL("not refused");
  } catch (const ModelError& error) {
    CHECK_THAT(error.what(), Catch::Contains("stations[2].groove.depth"));
    CHECK_THAT(error.what(), Catch::Contains("stations[3].keyway.width"));
  }
}

TEST_CASE("Sections that are judged take diameter and stress concentration from the contour") {
  std::string text = kStepped;
  const ModelCase judged = shaft_case(
      text + "[class]\nrated_speed_rpm = 60\n[class.sections]\nshaft_2 = { permissible_stress_MPa = 50 }\n");
  REQUIRE(judged.strength);
  const SectionStrength& groove = judged.strength->sections.at(0);
  const ShaftSection& station = shaft_of(judged).sections()->sections[1];
  CHECK(groove.diameter == Approx(0.13));
  CHECK(groove.stress_concentration == Approx(station.stress_factor.value));
  CHECK_THROWS_WITH(shaft_case(text + "[class.sections]\nshaft_3 = {}\n"),
                    Catch::Contains("sharp shoulder") && Catch::Contains("or the shoulder a fillet"));
  text.insert(text.rfind("]"), ", { length_mm = 50, outer_diameter_mm = 120, end_diameter_mm = 150 }\n");
  CHECK_THROWS_WITH(shaft_case(text + "[class.sections]\nshaft_4 = {}\n"),
                    Catch::Contains("station 4 has a sharp corner") && !Catch::Contains("fillet"));
}

TEST_CASE(
    "The camshaft by its drawing has the modes of the discs and springs that a hand puts in its place") {
  const app::ModelFile file(DREV_SOURCE_DIR "/models/camshaft_drawing/camshaft_drawing.toml", "");
  const ModelCase drawn = file.entry().build(Parameters(file.entry().name, file.entry().parameters));
  const std::vector<double> f = solve_modes(drawn.model.build(), {.count = 4}).frequency_Hz;
  // By hand: discs at the middles of gear seat, journals and cams; springs of necks, longer by 0.0725 d at each step (D/d
  // 1.5, r/d 0.05), and half of each disc's length with its own J.
  constexpr double kG = 8e10, kRho = 7850.0, kNeck = 0.16;
  const auto polar = [](double d) { return std::numbers::pi / 32.0 * std::pow(d, 4); };
  const ShaftSections& s = *shaft_of(drawn).sections();
  Model m("by hand");
  std::string before;
  double flexibility = 0.0;
  for (const ShaftSection& section : s.sections) {
    if (section.name.starts_with("neck")) {
      flexibility += (section.length + 2.0 * 0.0725 * kNeck) / polar(kNeck);
      continue;
    }
    m.add_node(section.name);
    double inertia = section.length * kRho * polar(section.diameter) + 0.06 * kRho * polar(kNeck);
    if (section.name.find(' ') != std::string::npos && section.stress_place == "cam")
      inertia = section.inertia + 0.06 * kRho * polar(kNeck);
    if (before.empty()) inertia += 6.5;
    m.add<Inertia>("J " + section.name, {section.name}, {.inertia = inertia});
    const double half = 0.5 * section.length / section.torsion_constant;
    if (!before.empty())
      m.add<ShaftSpring>("k " + section.name, {before, section.name},
                         {.stiffness = kG / (flexibility + half)});
    flexibility = half;
    before = section.name;
  }
  const std::vector<double> by_hand = solve_modes(m.build(), {.count = 4}).frequency_Hz;
  for (std::size_t i = 0; i < 4; ++i) {
    INFO("mode " << i + 1 << ": " << f[i] << " Hz, by hand " << by_hand[i]);
    CHECK(by_hand[i] == Approx(f[i]).epsilon(0.02));
  }
  CHECK(s.naive_excess() > 0.2);
}
