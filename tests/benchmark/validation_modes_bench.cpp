// The tables of docs/validation.md on modes, and the cases without integration in time.
//   build/release/bin/bench_validation_modes
#include <drev/core/system.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/models/ready_made.hpp>
#include <drev/solvers/modes/damped_modes.hpp>
#include <drev/solvers/modes/modes.hpp>

#include <cmath>
#include <cstdio>
#include <map>

#include "tests/catch.hpp"

using namespace drev;

namespace {

using Numbers = std::vector<double>;

ModeSet camshaft_modes(int cylinders, const char* drive, int count) {
  Parameters s("camshaft", camshaft_entry().parameters);
  s.set("cylinders", std::to_string(cylinders));
  s.set("drive", drive);
  return solve_modes(camshaft_entry().build(s).model.build(), {.count = count});
}

std::string numbered(const char* prefix, std::size_t i) { return prefix + std::to_string(i); }

Model chain(const Numbers& inertias, const Numbers& stiffnesses) {
  Model m("chain");
  for (std::size_t i = 0; i < inertias.size(); ++i) {
    m.add_node(numbered("n", i));
    m.add<Inertia>(numbered("J", i), {numbered("n", i)}, {.inertia = inertias[i]});
    if (i > 0 && i <= stiffnesses.size() && stiffnesses[i - 1] > 0.0)
      m.add<ShaftSpring>(numbered("k", i), {numbered("n", i - 1), numbered("n", i)},
                         {.stiffness = stiffnesses[i - 1]});
  }
  return m;
}

void print_row(const std::string& name, const Numbers& expected, const Numbers& found, int digits) {
  std::printf("| %s |", name.c_str());
  for (const double x : expected) std::printf(" %.*f", digits, x);
  std::printf(" |");
  for (std::size_t i = 0; i < expected.size(); ++i) std::printf(" %.*f", digits + 2, found[i]);
  double worst = 0.0;
  for (std::size_t i = 0; i < expected.size(); ++i) worst = std::max(worst, std::abs(found[i] - expected[i]));
  std::printf(" | %.1e |\n", worst);
}

double polar(double diameter) { return kPi / 32.0 * std::pow(diameter, 4); }

}  // namespace

TEST_CASE("Free camshaft against the reconstruction's values and the thesis") {
  const std::map<int, Numbers> target = {{6, {166.73, 409.78, 657.55, 889.17, 1085.45}},
                                         {7, {149.96, 363.66, 584.89, 798.01, 992.34}},
                                         {8, {138.56, 332.52, 535.25, 733.76, 920.90}},
                                         {9, {122.27, 288.06, 462.59, 635.15, 801.02}},
                                         {10, {111.61, 259.43, 415.83, 571.50, 722.78}}};
  // Tables 5.1 to 5.4; mode 5 of 9 cylinders in the right order (printed the other way round).
  const std::map<int, Numbers> mbs = {{6, {167.10, 412.70, 659.60, 886.00, 1075.30}},
                                      {7, {149.71, 361.48, 584.16, 800.53, 996.76}},
                                      {8, {138.20, 331.56, 535.70, 737.20, 927.68}},
                                      {9, {122.66, 287.15, 461.77, 635.45, 802.28}}};
  const std::map<int, Numbers> fem = {{6, {166.57, 410.23, 658.61, 890.43, 1085.60}},
                                      {7, {147.30, 356.95, 573.81, 782.14, 971.07}},
                                      {8, {136.86, 329.13, 530.64, 730.20, 918.00}},
                                      {9, {120.58, 284.06, 456.11, 626.09, 788.97}}};
  std::printf(
      "| cylinders | mode | drev [Hz] | target [Hz] | thesis MBS [Hz] | drev to MBS | "
      "thesis FEM [Hz] | drev to FEM |\n|---|---|---|---|---|---|---|---|\n");
  double worst = 0.0, squares = 0.0, largest = 0.0;
  for (const auto& [n, expected] : target) {
    const ModeSet modes = camshaft_modes(n, "free", 5);
    CHECK(modes.rigid_modes == 1);
    for (std::size_t j = 0; j < 5; ++j) {
      const double f = modes.frequency_Hz[j];
      worst = std::max(worst, std::abs(f - expected[j]));
      std::printf("| %d | %zu | %.4f | %.2f |", n, j + 1, f, expected[j]);
      if (mbs.contains(n)) {
        const double to_mbs = f / mbs.at(n)[j] - 1.0, to_fem = f / fem.at(n)[j] - 1.0;
        squares += to_mbs * to_mbs / 20.0;
        largest = std::max(largest, std::abs(to_mbs));
        std::printf(" %.2f | %+.2f %% | %.2f | %+.2f %% |\n", mbs.at(n)[j], 100 * to_mbs, fem.at(n)[j],
                    100 * to_fem);
      } else {
        std::printf(" - | - | - | - |\n");
      }
    }
  }
  std::printf("largest difference from the target %.4f Hz; from MBS rms %.3f %%, largest %.3f %%\n", worst,
              100 * std::sqrt(squares), 100 * largest);
  CHECK(worst <= 0.00501);
}

TEST_CASE("Held camshaft against the reconstruction's values") {
  const std::map<int, Numbers> target = {{6, {132.884, 395.842, 649.513}},
                                         {7, {117.147, 349.699, 576.630}},
                                         {8, {106.576, 318.569, 526.864}},
                                         {9, {91.681, 274.211, 454.138}}};
  std::printf("| cylinders | drev [Hz] | target [Hz] |\n|---|---|---|\n");
  double worst = 0.0;
  for (const auto& [n, expected] : target) {
    const ModeSet modes = camshaft_modes(n, "held", 3);
    std::printf("| %d | %.4f %.4f %.4f | %.3f %.3f %.3f |\n", n, modes.frequency_Hz[0], modes.frequency_Hz[1],
                modes.frequency_Hz[2], expected[0], expected[1], expected[2]);
    for (std::size_t j = 0; j < 3; ++j)
      worst = std::max(worst, std::abs(modes.frequency_Hz[j] - expected[j]));
  }
  std::printf("largest difference %.5f Hz\n", worst);
  CHECK(worst <= 0.000501);
  // What a history with steps of 1 ms shows of the 8-cylinder shaft's first mode: tan(w' h/2) = w h/2.
  const double w = camshaft_modes(8, "held", 1).omega(0), h = 1e-3;
  std::printf("8 cylinders at h = 1 ms, average acceleration: %.2f Hz\n",
              to_hz(2.0 / h * std::atan(0.5 * w * h)));
}

TEST_CASE("Published cases 1 to 6 and 10 to 12") {
  std::printf("| case | published | drev | largest difference |\n|---|---|---|---|\n");
  print_row("1", {176.0767}, solve_modes(chain({211.4, 8.3}, {9.775e6}).build()).frequency_Hz, 4);

  Model geared = chain({400e-6, 25e-6, 25e-6, 700e-6, 700e-6}, {1e4, 0, 5e3});
  geared.add<ShaftSpring>("k14", {"n1", "n4"}, {.stiffness = 5e3});
  geared.add<IdealGear>("gear", {"n1", "n2"}, {.ratio = -1.0});
  print_row("2", {425.3595, 634.0728, 3247.1924}, solve_modes(geared.build()).frequency_Hz, 4);

  print_row(
      "3", {81.2076, 141.2141, 378.9530, 536.3633},
      solve_modes(chain({3.5e-3, 3.5e-3, 3.5e-3, 0.15, 0.05}, {12e3, 12e3, 14e3, 10e3}).build()).frequency_Hz,
      4);

  Model branched = chain({3200, 200, 200, 800, 800, 450, 450}, {68e9 * polar(0.20) / 2.5});
  const double k = 68e9 * polar(0.25) / 3.5;
  branched.add<ShaftSpring>("s35", {"n3", "n5"}, {.stiffness = k});
  branched.add<ShaftSpring>("s46", {"n4", "n6"}, {.stiffness = k});
  branched.add<IdealGear>("g12", {"n1", "n2"}, {.ratio = -1.0});
  branched.add<IdealGear>("g13", {"n1", "n3"}, {.ratio = -0.5 / 0.8});
  branched.add<IdealGear>("g24", {"n2", "n4"}, {.ratio = -0.5 / 0.8});
  print_row("4", {10.30419, 20.47926, 24.42292}, solve_modes(branched.build()).frequency_Hz, 5);

  const std::map<int, Numbers> drill = {{5, {1.9417, 4.0719, 6.5437, 9.1547}},
                                        {8, {1.9225, 3.9187, 6.0625, 8.4185}},
                                        {50, {1.9106, 3.8232, 5.7394, 7.6613}},
                                        {2000, {1.91033, 3.82066, 5.73100, 7.64133}}};
  for (const auto& [segments, expected] : drill) {
    Model m = chain({200, 10}, {});
    m.add<DistributedShaft>("pipe", {"n0", "n1"},
                            {.shear_modulus = 75e9,
                             .density = 8000.0,
                             .outer_diameter = 0.78,
                             .inner_diameter = 0.65,
                             .length = 800.0,
                             .segments = segments});
    const bool continuum = segments == 2000;
    print_row("5, " + (continuum ? "continuum, by 2000" : std::to_string(segments)) + " segments", expected,
              solve_modes(m.build(), {.count = 4}).frequency_Hz, continuum ? 5 : 4);
  }

  const ModeSet windmill = solve_modes(chain({1e7, 5770, 97030}, {3.67e8, 5.496e9}).build());
  print_row("6 (rad/s)", {58.3402, 1034.1147}, {windmill.omega(0), windmill.omega(1)}, 4);

  Model damped("oscillator");
  damped.add_node("mass", NodeKind::translational);
  damped.add<Inertia>("m", {"mass"}, {.inertia = 1.6});
  damped.add<GroundSpring>("k", {"mass"}, {.stiffness = 4000.0, .damping = 8.0});
  const auto lambda = solve_damped_modes(damped.build()).modes[0].lambda;
  print_row("10 (1/s)", {-2.5, 49.93746089}, {lambda.real(), lambda.imag()}, 8);

  const double ratio = involute_contact_ratio(2e-3, 62, 62, deg(20));
  print_row("11, 62/62 teeth", {1.7897798668}, {ratio}, 10);
  const double rb_1 = 0.5086, rb_2 = 0.03567, c = std::cos(deg(22.5));
  print_row("11, 328/23 teeth", {1.6377334309511222},
            {involute_contact_ratio({.base_radius_1 = rb_1,
                                     .tip_radius_1 = rb_1 / c * (1 + 2.0 / 328),
                                     .base_radius_2 = rb_2,
                                     .tip_radius_2 = rb_2 / c * (1 + 2.0 / 23),
                                     .centre_distance = (rb_1 + rb_2) / c,
                                     .teeth_1 = 328})},
            14);

  Model rotor("rotor");
  for (std::size_t i = 0; i < 7; ++i) {
    rotor.add_node(numbered("n", i));
    if (i > 0)
      rotor.add<DistributedShaft>(
          numbered("s", i), {numbered("n", i - 1), numbered("n", i)},
          {.shear_modulus = 81.2e9, .density = 7810.0, .outer_diameter = 0.05, .length = 0.25});
  }
  rotor.add<Inertia>("disc 2", {"n2"}, {.inertia = 0.329564});
  rotor.add<Inertia>("disc 4", {"n4"}, {.inertia = 0.329564});
  print_row("12", {123.24158}, solve_modes(rotor.build(), {.count = 1}).frequency_Hz, 5);
}
