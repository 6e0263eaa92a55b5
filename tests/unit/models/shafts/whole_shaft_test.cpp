#include "models/shafts/whole_shaft.hpp"

#include <drev/elements/catalogue.hpp>
#include <drev/models/shafts/contour_shaft.hpp>
#include <drev/solvers/modes/modes.hpp>

#include <cmath>

#include "tests/catch.hpp"

namespace {

using namespace drev;

std::vector<double> segment_modes(ShaftContour contour, double up_to, SegmentMass mass) {
  contour.up_to_frequency = up_to;
  contour.mass = mass;
  Model m("shaft");
  m.add_node("a");
  m.add_node("b");
  m.add<ContourShaft>("shaft", {"a", "b"}, contour);
  return solve_modes(m.build(), {.count = 4}).frequency_Hz;
}

TEST_CASE("A whole uniform shaft has the frequencies of the continuum", "[shafts]") {
  const WholeShaft shaft = whole_shaft(
      {.shear_modulus = 8e10, .density = 7850.0, .stations = {{.length = 1.0, .outer_diameter = 0.1}}}, 2);
  const WholeShaftModes modes = whole_shaft_modes(shaft, 3);
  for (std::size_t i = 0; i < 3; ++i)
    CHECK(modes.frequency_Hz[i] == Approx(0.5 * double(i + 1) * std::sqrt(8e10 / 7850.0)).epsilon(1e-5));
}

TEST_CASE("Segments of a contour against the whole shaft as one sparse system", "[shafts]") {
  const ShaftContour contour{
      .shear_modulus = 8e10,
      .density = 7850.0,
      .stations = {{.length = 0.4, .outer_diameter = 0.1, .fillet_end = 0.008},
                   {.length = 0.08, .outer_diameter = 0.2},
                   {.length = 0.5, .outer_diameter = 0.1, .fillet_start = 0.008, .fillet_end = 0.008},
                   {.length = 0.06, .outer_diameter = 0.24}}};
  const WholeShaftModes whole = whole_shaft_modes(whole_shaft(contour, 1), 4);
  const std::vector<double> fine = segment_modes(contour, 8000.0, SegmentMass::averaged);
  const std::vector<double> coarse = segment_modes(contour, kNotGiven, SegmentMass::lumped);
  for (std::size_t i = 0; i < 4; ++i) {
    INFO(i << ": " << whole.frequency_Hz[i] << " Hz, " << fine[i] << ", " << coarse[i]);
    CHECK(fine[i] == Approx(whole.frequency_Hz[i]).epsilon(0.006));
  }
  CHECK(coarse[0] == Approx(whole.frequency_Hz[0]).epsilon(0.03));
  CHECK(std::abs(coarse[3] / whole.frequency_Hz[3] - 1.0) > 0.01);
}

}  // namespace
