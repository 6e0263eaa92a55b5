/// Modes that other programs' tests, textbooks and a thesis print. Frequencies in Hz unless said.
///
/// Sources: openTorsion (tests and notebooks); M. I. Friswell, J. E. T. Penny, S. D. Garvey, A. W.
/// Lees, Dynamics of Rotating Machines, Cambridge University Press, 2010; Exudyn (tests); ROSS
/// (validation page); S. L. Sunde, Mechanical analysis of camshaft system on a marine engine, NTNU,
/// 2015.
#include <drev/core/system.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/distributed_shaft.hpp>
#include <drev/elements/ground_spring.hpp>
#include <drev/elements/ideal_gear.hpp>
#include <drev/elements/inertia.hpp>
#include <drev/elements/shaft_spring.hpp>
#include <drev/solvers/modes/damped_modes.hpp>
#include <drev/solvers/modes/modes.hpp>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "tests/catch.hpp"

using namespace drev;

namespace {

std::string name(const char* prefix, std::size_t i) { return prefix + std::to_string(i); }

/// Inertias in a row, joined by springs.
Model chain(const std::vector<double>& inertias, const std::vector<double>& stiffnesses) {
  Model model("chain");
  for (std::size_t i = 0; i < inertias.size(); ++i) {
    model.add_node(name("n", i));
    model.add<Inertia>(name("J", i), {name("n", i)}, {.inertia = inertias[i]});
    if (i > 0)
      model.add<ShaftSpring>(name("k", i), {name("n", i - 1), name("n", i)},
                             {.stiffness = stiffnesses[i - 1]});
  }
  return model;
}

/// The lowest elastic modes against printed values; half a unit of the last digit given.
void check_free(const ModeSet& modes, const std::vector<double>& expected, double tolerance) {
  CHECK(modes.rigid_modes == 1);
  REQUIRE(modes.frequency_Hz.size() >= expected.size());
  for (std::size_t j = 0; j < expected.size(); ++j)
    CHECK(std::abs(modes.frequency_Hz[j] - expected[j]) <= tolerance);
}

/// Polar second moment of area of a round shaft [m^4].
double polar(double outer, double inner = 0.0) {
  return kPi / 32.0 * (std::pow(outer, 4) - std::pow(inner, 4));
}

}  // namespace

TEST_CASE("Two discs (openTorsion)", "[published][modes]") {
  check_free(solve_modes(chain({211.4, 8.3}, {9.775e6}).build()), {176.0767}, 0.5e-4);
}

TEST_CASE("Geared pair of ratio 1 (Friswell, in openTorsion's tests)", "[published][modes]") {
  Model model("geared");
  for (std::size_t i = 0; i < 5; ++i) model.add_node(name("n", i));
  const double inertia[] = {400e-6, 25e-6, 25e-6, 700e-6, 700e-6};
  for (std::size_t i = 0; i < 5; ++i)
    model.add<Inertia>(name("J", i), {name("n", i)}, {.inertia = inertia[i]});
  model.add<ShaftSpring>("k01", {"n0", "n1"}, {.stiffness = 1e4});
  model.add<ShaftSpring>("k23", {"n2", "n3"}, {.stiffness = 5e3});
  model.add<ShaftSpring>("k14", {"n1", "n4"}, {.stiffness = 5e3});
  model.add<IdealGear>("gear", {"n1", "n2"}, {.ratio = -1.0});
  check_free(solve_modes(model.build()), {425.3595, 634.0728, 3247.1924}, 0.5e-4);
}

TEST_CASE("Five discs (Friswell 9.7.1)", "[published][modes]") {
  check_free(solve_modes(chain({3.5e-3, 3.5e-3, 3.5e-3, 0.15, 0.05}, {12e3, 12e3, 14e3, 10e3}).build()),
             {81.2076, 141.2141, 378.9530, 536.3633}, 0.5e-4);
}

TEST_CASE("Branched and geared (Friswell 9.6.3)", "[published][modes]") {
  Model model("branched");
  for (std::size_t i = 0; i < 7; ++i) model.add_node(name("n", i));
  const double inertia[] = {3200, 200, 200, 800, 800, 450, 450};
  for (std::size_t i = 0; i < 7; ++i)
    model.add<Inertia>(name("J", i), {name("n", i)}, {.inertia = inertia[i]});
  const auto shaft = [](double length, double diameter) {
    return ShaftSpring::Params{.stiffness = 68e9 * polar(diameter) / length};
  };
  model.add<ShaftSpring>("s01", {"n0", "n1"}, shaft(2.5, 0.20));
  model.add<ShaftSpring>("s35", {"n3", "n5"}, shaft(3.5, 0.25));
  model.add<ShaftSpring>("s46", {"n4", "n6"}, shaft(3.5, 0.25));
  model.add<IdealGear>("g12", {"n1", "n2"}, {.ratio = -0.5 / 0.5});
  model.add<IdealGear>("g13", {"n1", "n3"}, {.ratio = -0.5 / 0.8});
  model.add<IdealGear>("g24", {"n2", "n4"}, {.ratio = -0.5 / 0.8});
  check_free(solve_modes(model.build()), {10.30419, 20.47926, 24.42292}, 0.5e-5);
}

TEST_CASE("Drill string with distributed inertia (Friswell 9.9)", "[published][modes]") {
  const auto solve = [](int segments) {
    Model model("drill string");
    model.add_node("table");
    model.add_node("bit");
    model.add<Inertia>("J_table", {"table"}, {.inertia = 200.0});
    model.add<Inertia>("J_bit", {"bit"}, {.inertia = 10.0});
    model.add<DistributedShaft>("pipe", {"table", "bit"},
                                {.shear_modulus = 75e9,
                                 .density = 8000.0,
                                 .outer_diameter = 0.78,
                                 .inner_diameter = 0.65,
                                 .length = 800.0,
                                 .segments = segments});
    return solve_modes(model.build(), {.count = 4});
  };
  check_free(solve(5), {1.9417, 4.0719, 6.5437, 9.1547}, 0.5e-4);
  check_free(solve(8), {1.9225, 3.9187, 6.0625, 8.4185}, 0.5e-4);
  check_free(solve(50), {1.9106, 3.8232, 5.7394, 7.6613}, 0.5e-4);

  // Continuum, roots given to 6 digits. The error falls as 1/n^2.
  const double exact[] = {1.91033, 3.82066, 5.73100, 7.64133};
  const ModeSet coarse = solve(100), fine = solve(200), finest = solve(2000);
  for (std::size_t j = 0; j < 4; ++j) {
    CHECK(std::abs(finest.frequency_Hz[j] - exact[j]) < 2e-5);  // 1e-5 of rounding, 1e-5 of 2000 segments
    const double order = std::log2((coarse.frequency_Hz[j] - finest.frequency_Hz[j]) /
                                   (fine.frequency_Hz[j] - finest.frequency_Hz[j]));
    CHECK(order == Approx(2.0).margin(0.02));
  }
}

TEST_CASE("Windmill (openTorsion's notebook), rad/s", "[published][modes]") {
  const ModeSet modes = solve_modes(chain({1e7, 5770, 97030}, {3.67e8, 5.496e9}).build());
  REQUIRE(modes.count() == 2);
  CHECK(std::abs(modes.omega(0) - 58.3402) <= 0.5e-4);
  CHECK(std::abs(modes.omega(1) - 1034.1147) <= 0.5e-4);
}

TEST_CASE("Damped oscillator (Exudyn)", "[published][damped_modes]") {
  Model model("oscillator");
  model.add_node("mass", NodeKind::translational);
  model.add<Inertia>("m", {"mass"}, {.inertia = 1.6});
  model.add<GroundSpring>("k", {"mass"}, {.stiffness = 4000.0, .damping = 8.0});
  const DampedModeSet set = solve_damped_modes(model.build());
  REQUIRE(set.modes.size() == 1);
  CHECK(std::abs(set.modes[0].lambda - std::complex<double>(-2.5, 49.93746089)) < 0.5e-8);
}

// The discs' inertia is given to 6 digits: 5e-7 of 0.329564 moves the frequency by 9e-5 Hz.
TEST_CASE("Two-disc rotor (ROSS)", "[published][modes]") {
  Model model("rotor");
  for (std::size_t i = 0; i < 7; ++i) {
    model.add_node(name("n", i));
    if (i > 0)
      model.add<DistributedShaft>(
          name("s", i), {name("n", i - 1), name("n", i)},
          {.shear_modulus = 81.2e9, .density = 7810.0, .outer_diameter = 0.05, .length = 0.25});
  }
  model.add<Inertia>("disc 2", {"n2"}, {.inertia = 0.329564});
  model.add<Inertia>("disc 4", {"n4"}, {.inertia = 0.329564});
  check_free(solve_modes(model.build(), {.count = 1}), {123.24158}, 1e-4);
}

namespace {

/// The thesis' camshaft of N cylinders, gear to free end, with parameters reconstructed from its
/// printed frequencies (not the builder's data).
Model camshaft(int cylinders) {
  const std::map<int, double> end = {{6, 0.4382}, {7, 0.3015}, {8, 0.04305}, {9, 0.2854}, {10, 0.3417}};
  std::vector<double> inertias = {6.461}, stiffnesses = {8.75e7};  // gear
  for (int i = 0; i < cylinders; ++i) {
    inertias.insert(inertias.end(), {0.5204, 0.1546, 0.1009, 0.1098});  // journal, fuel, exhaust, inlet
    stiffnesses.insert(stiffnesses.end(), {5.90e7, 3.553e7, 3.193e7, 4.050e7});
  }
  inertias.push_back(end.at(cylinders));
  return chain(inertias, stiffnesses);
}

}  // namespace

TEST_CASE("Camshaft, free and with its gear held: an independent solver's frequencies",
          "[published][modes]") {
  // Dense symmetric eigensolver of another program, two decimals free and three held.
  const std::map<int, std::vector<double>> free = {{6, {166.73, 409.78, 657.55, 889.17, 1085.45}},
                                                   {7, {149.96, 363.66, 584.89, 798.01, 992.34}},
                                                   {8, {138.56, 332.52, 535.25, 733.76, 920.90}},
                                                   {9, {122.27, 288.06, 462.59, 635.15, 801.02}},
                                                   {10, {111.61, 259.43, 415.83, 571.50, 722.78}}};
  for (const auto& [cylinders, expected] : free) {
    const System system = camshaft(cylinders).build();
    REQUIRE(system.size() == 4 * cylinders + 2);
    for (const int limit : {0, 1000})
      check_free(solve_modes(system, {.count = 5, .dense_limit = limit}), expected, 0.00501);
  }
  const std::map<int, std::vector<double>> held = {{6, {132.884, 395.842, 649.513}},
                                                   {7, {117.147, 349.699, 576.630}},
                                                   {8, {106.576, 318.569, 526.864}},
                                                   {9, {91.681, 274.211, 454.138}}};
  for (const auto& [cylinders, expected] : held) {
    Model model = camshaft(cylinders);
    model.hold("n0");
    const ModeSet modes = solve_modes(model.build(), {.count = 3});
    CHECK(modes.rigid_modes == 0);
    CHECK(modes.summary.sturm_count == 3);
    for (std::size_t j = 0; j < 3; ++j) CHECK(std::abs(modes.frequency_Hz[j] - expected[j]) <= 0.000501);
  }
}

TEST_CASE("Camshaft against the thesis' tables 5.1 to 5.4", "[published][modes]") {
  // Multibody values as printed, except mode 5 of 9 cylinders: 788.97 and 802.28 are swapped there
  // (the printed difference of +1.66 % says so). The reconstruction is a fit to these twenty
  // values: rms 0.42 %, largest 0.95 %.
  const std::map<int, std::vector<double>> printed = {{6, {167.10, 412.70, 659.60, 886.00, 1075.30}},
                                                      {7, {149.71, 361.48, 584.16, 800.53, 996.76}},
                                                      {8, {138.20, 331.56, 535.70, 737.20, 927.68}},
                                                      {9, {122.66, 287.15, 461.77, 635.45, 802.28}}};
  double squares = 0.0, largest = 0.0;
  for (const auto& [cylinders, expected] : printed) {
    const ModeSet modes = solve_modes(camshaft(cylinders).build(), {.count = 5});
    for (std::size_t j = 0; j < 5; ++j) {
      const double error = modes.frequency_Hz[j] / expected[j] - 1.0;
      squares += error * error / 20.0;
      largest = std::max(largest, std::abs(error));
    }
  }
  INFO("camshaft against the printed tables: rms " << 100.0 * std::sqrt(squares) << " %, largest "
                                                   << 100.0 * largest << " %");
  CHECK(100.0 * std::sqrt(squares) < 0.425);
  CHECK(100.0 * largest < 0.955);
}
