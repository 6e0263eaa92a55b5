// Random drawings: a result with an error, or a refusal that names the dimension. All 10,000:
//   build/release/bin/unit_models "Ten thousand*"
#include <drev/core/error.hpp>
#include <drev/models/shafts/shaft_contour.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <map>
#include <random>

#include "tests/catch.hpp"

namespace {

using namespace drev;

struct FuzzOutcome {
  int results = 0, refusals = 0, solver = 0, wrong = 0;
  double longest = 0.0;  // processor time of a drawing [s]
  std::map<std::string, int> reasons;
};

class RandomContour {
 public:
  explicit RandomContour(unsigned seed) : random_(seed) {}
  ShaftContour operator()() {
    ShaftContour contour{.shear_modulus = 8e10, .density = 7850.0, .accuracy = 0.02};
    const int count = 1 + pick(6);
    for (int i = 0; i < count; ++i) contour.stations.push_back(station());
    // Most drawings have fillets where they belong.
    for (std::size_t k = 0; k < contour.stations.size(); ++k) {
      ShaftStation& s = contour.stations[k];
      const auto thicker = [&](std::size_t other) {
        return other < contour.stations.size() && contour.stations[other].outer_diameter > s.outer_diameter;
      };
      if (!thicker(k - 1) && pick(50) != 0) s.fillet_start = 0.0;
      if (!thicker(k + 1) && pick(50) != 0) s.fillet_end = 0.0;
    }
    if (pick(50) == 0) contour.shear_modulus = number(-1.0, 1.0);
    return contour;
  }

 private:
  int pick(int below) { return std::uniform_int_distribution<int>(0, below - 1)(random_); }
  double number(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  double spread(double low, double high) { return low * std::pow(high / low, number(0.0, 1.0)); }
  ShaftStation station() {
    ShaftStation s{.length = spread(0.005, 1.0), .outer_diameter = spread(0.03, 0.3)};
    if (pick(6) == 0) s.inner_diameter = number(0.0, pick(4) == 0 ? 1.05 : 0.6) * s.outer_diameter;
    if (pick(2) == 0) s.fillet_start = spread(1e-4, 0.02);
    if (pick(2) == 0) s.fillet_end = spread(1e-4, 0.02);
    switch (pick(40)) {
      case 0:
        s.end_diameter = spread(0.03, 0.3), s.fillet_start = s.fillet_end = 0.0;
        break;
      case 1:
        s.hub_diameter = s.outer_diameter * number(0.9, 2.0);
        break;
      case 2:
        s.groove = ShaftGroove{number(0.0, 1.0) * s.length, spread(1e-4, 0.05), spread(1e-4, 0.03)};
        break;
      case 3:
        s.keyway = ShaftKeyway{number(0.05, 0.6) * s.outer_diameter, number(0.02, 0.4) * s.outer_diameter,
                               spread(1e-4, 0.01)};
        break;
      case 4:
        s.spline = ShaftSpline{2 + pick(40), number(0.6, 1.05) * s.outer_diameter,
                               number(0.01, 0.4) * s.outer_diameter, spread(1e-4, 3e-3)};
        break;
      case 5: {
        std::vector<double> angles, lifts;
        const double height = number(-0.1, 1.0) * s.outer_diameter;
        for (int i = 0; i < 36; ++i)
          angles.push_back(i * 0.17453292519943295),
              lifts.push_back(height * std::pow(std::sin(0.08726646 * i), 4));
        s.cam = ShaftCam{PeriodicTable(angles, lifts)};
        break;
      }
      case 6:
        (pick(2) == 0 ? s.length : s.outer_diameter) = pick(2) == 0 ? 0.0 : NAN;
        break;
      default:
        break;
    }
    return s;
  }
  std::mt19937 random_;
};

/// G theta/T of the contour, fillets with it, if its sections turned as a whole.
double slices(const ShaftSections& s) {
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < s.outline_z.size(); ++i)
    sum += 0.5 * (s.outline_z[i + 1] - s.outline_z[i]) *
           (s.outline_stress[i] / s.outline_r[i] + s.outline_stress[i + 1] / s.outline_r[i + 1]);
  return sum;
}

FuzzOutcome draw(int count, unsigned seed) {
  RandomContour contour(seed);
  FuzzOutcome outcome;
  for (int i = 0; i < count; ++i) {
    const ShaftContour drawn = contour();
    const std::clock_t start = std::clock();
    try {
      const ShaftSections s = shaft_sections(drawn);
      ++outcome.results;
      bool right = std::isfinite(s.flexibility.value) && s.flexibility.value > 0.0 &&
                   s.flexibility.error >= 0.0 && s.flexibility.error < 0.1 * s.flexibility.value &&
                   s.inertia() > 0.0 &&
                   // Sections that turn as a whole are the stiffest of all.
                   s.flexibility.value > 0.99 * slices(s) - s.flexibility.error;
      for (const double f : s.segment_flexibility) right = right && f > 0.0;
      if (!right) {
        ++outcome.wrong;
        std::printf("drawing %d of seed %u: flexibility %g +- %g, naive %g\n", i, seed, s.flexibility.value,
                    s.flexibility.error, s.naive_flexibility);
      }
    } catch (const ModelError& error) {
      ++outcome.refusals;
      if (error.findings().empty()) ++outcome.wrong;
      for (const Finding& f : error.findings()) {
        if (f.range.find("meshed") != f.range.npos) ++outcome.solver;
        if (f.parameter.empty() || f.range.empty()) ++outcome.wrong;
        const std::size_t dot = f.parameter.find(']');
        ++outcome.reasons[dot == f.parameter.npos ? f.parameter : f.parameter.substr(dot + 1)];
      }
    }
    outcome.longest = std::max(outcome.longest, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  return outcome;
}

TEST_CASE("Random drawings give a result with an error or a named refusal", "[shafts]") {
  const FuzzOutcome outcome = draw(12, 7);
  CHECK(outcome.results > 2);
  CHECK(outcome.refusals > 1);
  CHECK(outcome.longest < 20.0);
  CHECK(outcome.solver == 0);
  CHECK(outcome.wrong == 0);
}

TEST_CASE("Ten thousand random drawings", "[.][once]") {
  const FuzzOutcome outcome =
      draw(std::getenv("DREV_DRAWINGS") ? std::atoi(std::getenv("DREV_DRAWINGS")) : 10000, 1);
  std::printf("%d results, %d refusals, %d of them not meshed, %d wrong, longest %.2f s\n", outcome.results,
              outcome.refusals, outcome.solver, outcome.wrong, outcome.longest);
  for (const auto& [reason, count] : outcome.reasons) std::printf("%6d %s\n", count, reason.c_str());
  CHECK(outcome.wrong == 0);
}

}  // namespace
