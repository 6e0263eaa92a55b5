// Covers solvers/strength/iacs_m68.hpp, section_strength.hpp: permissible stresses by IACS UR M68.5.
#include "solvers/strength/iacs_m68.hpp"

#include <drev/solvers/strength/section_strength.hpp>

#include <cmath>

#include "tests/catch.hpp"

using namespace drev;

namespace {
constexpr double kM68Digits = 1e-8;  // of the printed values
constexpr double kM68Mega = 1e6;
}  // namespace

// Numbers computed by a separate program from the formulas of the rule (case K1).
TEST_CASE("Permissible stresses of IACS UR M68 are those of a separate computation", "[strength]") {
  using namespace iacs_m68;
  CHECK(size_factor(0.4) == Approx(0.63058920).epsilon(1e-8));
  CHECK(size_factor(0.5) == Approx(0.61834218).epsilon(1e-8));
  struct Case {
    double tensile, shape, diameter, ratio, continuous, transient;
  };
  for (const Case& c :
       {Case{600, 1.0, 0.4, 0.5, 66.5621933, 113.155729}, Case{600, 1.0, 0.4, 0.8, 45.7947890, 77.8511413},
        Case{600, 1.0, 0.4, 0.9, 36.7423307, 62.4619622}, Case{600, 0.55, 0.5, 0.6, 32.7391574, 75.0473005},
        // intermediate and tail shaft of a five-cylinder two-stroke engine at its 5th order's critical
        Case{800, 1.0, 0.34, 0.66682638, 72.0288763, 122.449090},
        Case{600, 0.55, 0.45, 0.66682638, 30.5880151, 70.1162809}}) {
    const Permissible stress = permissible_stress(c.tensile * kM68Mega, c.shape, c.diameter, c.ratio);
    CHECK(stress.continuous / kM68Mega == Approx(c.continuous).epsilon(kM68Digits));
    CHECK(stress.transient / kM68Mega == Approx(c.transient).epsilon(kM68Digits));
  }
  // The two branches meet at 0.9; above 1.05 the rule has no value.
  CHECK(speed_factor(0.9) == 1.38);
  CHECK(speed_factor(std::nextafter(0.9, 0.0)) == Approx(1.38).epsilon(1e-14));
  CHECK(speed_factor(1.05) == 1.38);
  CHECK(std::isnan(speed_factor(1.0500001)));
}

TEST_CASE("Barred range of IACS UR M68", "[strength]") {
  const iacs_m68::BarredRange range = iacs_m68::barred_range(60.0, 0.6);
  CHECK(range.from == Approx(55.1724138).epsilon(kM68Digits));
  CHECK(range.to == Approx(65.25).epsilon(1e-14));
  const iacs_m68::BarredRange marine = iacs_m68::barred_range(66.015811, 0.66682638);
  CHECK(marine.from == Approx(60.938233).epsilon(1e-8));
  CHECK(marine.to == Approx(71.516470).epsilon(1e-8));
}

TEST_CASE("Polar section modulus", "[strength]") {
  CHECK(polar_section_modulus(0.1) == Approx(3.14159265358979 * 1e-3 / 16.0).epsilon(1e-14));
  // A thin tube: 2 pi r^2 t.
  const double r = 0.05, t = 1e-6;
  CHECK(polar_section_modulus(2.0 * r + t, 2.0 * r - t) ==
        Approx(2.0 * 3.14159265358979 * r * r * t).epsilon(1e-4));
}
