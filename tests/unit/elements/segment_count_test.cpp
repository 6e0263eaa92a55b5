// Segments of a distributed shaft: the continuum of published case 5 and of a shaft without ends' inertias.
#include <drev/core/system.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/modes/modes.hpp>

#include <cmath>

#include "tests/catch.hpp"
#include "tests/problems/findings.hpp"

using namespace drev;

namespace {

const DistributedShaft::Params kPipe{.shear_modulus = 75e9,
                                     .density = 8000.0,
                                     .outer_diameter = 0.78,
                                     .inner_diameter = 0.65,
                                     .length = 800.0};

std::vector<double> frequencies(int segments, SegmentMass mass, double table, double bit, int count) {
  Model m("pipe");
  m.add_node("table");
  m.add_node("bit");
  if (table > 0.0) m.add<Inertia>("J_table", {"table"}, {.inertia = table});
  if (bit > 0.0) m.add<Inertia>("J_bit", {"bit"}, {.inertia = bit});
  DistributedShaft::Params p = kPipe;
  p.segments = segments;
  p.mass = mass;
  m.add<DistributedShaft>("pipe", {"table", "bit"}, p);
  return solve_modes(m.build(), {.count = count}).frequency_Hz;
}

}  // namespace

TEST_CASE("Frequency error of segments: a free shaft's own") {
  // f_j = j c/(2 L), theta = j pi/n.
  const double c = torsional_wave_speed(kPipe.shear_modulus, kPipe.density);
  for (const SegmentMass mass : {SegmentMass::lumped, SegmentMass::consistent, SegmentMass::averaged}) {
    const std::vector<double> found = frequencies(12, mass, 0.0, 0.0, 9);
    for (int j = 1; j <= 9; ++j)
      CHECK(found[static_cast<std::size_t>(j - 1)] / (j * c / (2 * kPipe.length)) - 1.0 ==
            Approx(segment_frequency_error(mass, j * kPi / 12)).epsilon(1e-8).margin(1e-12));
  }
  // Leading terms.
  CHECK(segment_frequency_error(SegmentMass::lumped, 0.1) == Approx(-0.01 / 24).epsilon(1e-3));
  CHECK(segment_frequency_error(SegmentMass::consistent, 0.1) == Approx(0.01 / 24).epsilon(1e-3));
  CHECK(segment_frequency_error(SegmentMass::averaged, 0.1) == Approx(-1e-4 / 480).epsilon(1e-2));
}

TEST_CASE("Frequency error of segments: inertias at the ends") {
  // Ends of mu_0, mu_1 of the shaft's inertia J: (mu_0 + mu_1) x cos x + (1 - mu_0 mu_1 x^2) sin x = 0, x =
  // omega L/c, with the shape cos(x s) - mu_0 x sin(x s).
  const double mu_0 = 0.4, mu_1 = 0.1, c = torsional_wave_speed(kPipe.shear_modulus, kPipe.density);
  const double shaft = DistributedShaft(kPipe).segment_inertia();
  const auto residual = [&](double x) {
    return (mu_0 + mu_1) * x * std::cos(x) + (1 - mu_0 * mu_1 * x * x) * std::sin(x);
  };
  const int n = 60;
  double low = 0.5;
  for (int j = 0; j < 4; ++j) {
    while (residual(low) * residual(low + 0.01) > 0.0) low += 0.01;
    double a = low, b = low += 0.01;
    for (int i = 0; i < 60; ++i) (residual(a) * residual(0.5 * (a + b)) > 0.0 ? a : b) = 0.5 * (a + b);
    const auto square = [&](double s) { return std::pow(std::cos(a * s) - mu_0 * a * std::sin(a * s), 2); };
    double along = 0.0;
    for (int i = 0; i < 1000; ++i) along += square((i + 0.5) / 1000) / 1000;
    const double ends = mu_0 * square(0.0) + mu_1 * square(1.0), p = ends / (ends + along);
    for (const SegmentMass mass : {SegmentMass::lumped, SegmentMass::consistent, SegmentMass::averaged}) {
      const auto place = static_cast<std::size_t>(j);
      const double found = frequencies(n, mass, mu_0 * shaft, mu_1 * shaft, 4)[place];
      const double exact = to_hz(a * c / kPipe.length), theta = a / n;
      INFO("mode " << j << ", p = " << p);
      CHECK(found / exact - 1.0 ==
            Approx(segment_frequency_error(mass, theta, p)).margin(0.01 * theta * theta / 24));
    }
  }
}

TEST_CASE("segments_for: known counts of a shaft held at one end") {
  // Mode j of a fixed-free shaft of L = 1 m, c = 1 m/s: (2j - 1)/4 Hz; n >= (2j - 1) pi/(2 sqrt(24 accuracy))
  // with lumped and consistent mass, at 1 %, 0.1 % and 1e-4.
  struct Known {
    int mode, lumped[3], averaged[3];
  };
  for (const Known& known : {Known{1, {4, 11, 33}, {2, 2, 4}}, Known{2, {10, 31, 97}, {4, 6, 11}},
                             Known{3, {17, 51, 161}, {6, 10, 17}}, Known{5, {29, 92, 289}, {10, 18, 31}}})
    for (int a = 0; a < 3; ++a) {
      const double accuracy = std::pow(10.0, -2 - a), up_to = (2 * known.mode - 1) / 4.0;
      INFO("mode " << known.mode << ", " << accuracy);
      // The leading term alone gives one more or less at 1 %.
      CHECK(std::abs(segments_for(1, 1, accuracy, up_to, SegmentMass::lumped) - known.lumped[a]) <= 1);
      CHECK(std::abs(segments_for(1, 1, accuracy, up_to) - known.lumped[a]) <= 1);
      CHECK(std::abs(segments_for(1, 1, accuracy, up_to, SegmentMass::averaged) - known.averaged[a]) <= 1);
    }
  CHECK(segments_for(1, 1000, 1e-3, 1.0) == 1);
  CHECK_THROWS_AS(segments_for(1, 1, 1e-10, 100.0), ModelError);
  CHECK_THROWS_AS(segments_for(1, 1, 0.5, 1.0), ModelError);
  CHECK_THROWS_AS(segments_for(-1, 1, 0.01, 1.0), ModelError);
}

TEST_CASE("segments_for: drill string of published case 5 (Friswell 9.9)") {
  const double exact[] = {1.91033, 3.82066, 5.73100, 7.64133};  // continuum, with both end inertias
  // Where an end moves by q, the shaft moves by q^2/2 in the mean: p = 210/(J/2), J = rho I_p L.
  const double ends = 210.0 / (0.5 * 8000.0 * 800.0 * kPi / 32 * (std::pow(0.78, 4) - std::pow(0.65, 4)));
  const double c = torsional_wave_speed(kPipe.shear_modulus, kPipe.density);
  for (const SegmentMass mass : {SegmentMass::lumped, SegmentMass::consistent, SegmentMass::averaged})
    for (const double accuracy : {0.02, 1e-3, 1e-4}) {
      const int n = segments_for(kPipe.length, c, accuracy, exact[3], mass, ends);
      INFO("n = " << n << ", " << accuracy);
      const std::vector<double> found = frequencies(n, mass, 200.0, 10.0, 4);
      for (std::size_t j = 0; j < 4; ++j)
        CHECK(std::abs(found[j] / exact[j] - 1.0) <= accuracy + 2e-6);  // digits of the published roots
      // And no more than needed.
      const double fewer = frequencies(n - 1, mass, 200.0, 10.0, 4)[3];
      CHECK(std::abs(fewer / exact[3] - 1.0) > 0.95 * accuracy);
    }
}
