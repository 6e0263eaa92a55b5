// First crossing of a polynomial: none missed, none invented, the root at zero not found again.
#include "solvers/contact/roots.hpp"

#include <drev/core/units.hpp>

#include <cmath>
#include <random>
#include <vector>

#include "tests/catch.hpp"

using namespace drev;

namespace {

/// scale * product of (root - s) over the roots given; positive at 0 for positive roots and scale.
std::vector<double> with_roots(const std::vector<double>& roots, double scale = 1.0) {
  std::vector<double> g{scale};
  for (const double root : roots) {
    std::vector<double> next(g.size() + 1, 0.0);
    for (std::size_t k = 0; k < g.size(); ++k) {
      next[k] += root * g[k];
      next[k + 1] -= g[k];
    }
    g = next;
  }
  return g;
}

}  // namespace

TEST_CASE("A polynomial, its slope and its curvature") {
  // 3 - 2 s + 5 s^3 - s^4.
  const std::vector<double> g{3.0, -2.0, 0.0, 5.0, -1.0};
  for (const double s : {0.0, 0.3, 1.0, 1.7}) {
    CHECK(polynomial_value(g, s) == Approx(3.0 - 2.0 * s + 5.0 * s * s * s - s * s * s * s).epsilon(1e-14));
    CHECK(polynomial_slope(g, s) == Approx(-2.0 + 15.0 * s * s - 4.0 * s * s * s).epsilon(1e-14));
    CHECK(polynomial_curvature(g, s) == Approx(30.0 * s - 12.0 * s * s).epsilon(1e-14));
  }
  CHECK(polynomial_curvature(std::vector<double>{3.0, -2.0}, 0.3) == 0.0);
}

TEST_CASE("First crossing: a single root, wherever it is") {
  for (const double root : {1e-12, 1e-3, 0.25, 0.5, 0.7, 0.999, 1.0 - 1e-12}) {
    const auto s = first_crossing(with_roots({root, 3.0, 5.0}), 1.0);
    REQUIRE(s.has_value());
    CHECK(*s == Approx(root).epsilon(1e-13));
  }
  CHECK(!first_crossing(with_roots({1.0 + 1e-9, 3.0}), 1.0));
  CHECK(!first_crossing(with_roots({0.6}), 0.5));
}

TEST_CASE("First crossing: none") {
  CHECK(!first_crossing(std::vector<double>{1.0}, 1.0));
  CHECK(!first_crossing(std::vector<double>{}, 1.0));
  CHECK(!first_crossing(std::vector<double>{0.0, 0.0}, 1.0));
  CHECK(!first_crossing(std::vector<double>{1.0, -1.0, 0.26}, 1.0));        // dips to 0.04
  CHECK(!first_crossing(std::vector<double>{1.0, -4.0, 4.0 + 1e-9}, 1.0));  // dips to 2.5e-10
}

TEST_CASE("First crossing: a double root is a graze, no crossing, a triple root crosses") {
  CHECK(!first_crossing(with_roots({0.5, 0.5}), 1.0));
  CHECK(!first_crossing(with_roots({0.25, 0.25, 2.0}), 1.0));
  const auto s = first_crossing(with_roots({0.25, 0.25, 0.75}), 1.0);
  REQUIRE(s.has_value());
  CHECK(*s == Approx(0.75).epsilon(1e-12));
  const auto triple = first_crossing(with_roots({0.5, 0.5, 0.5}), 1.0);
  REQUIRE(triple.has_value());
  // A triple root is known to the cube root of rounding.
  CHECK(*triple == Approx(0.5).epsilon(1e-4));
}

TEST_CASE("First crossing: from a start as flat as a high power, beside rounding") {
  // s^9 (1 - 1.5 s) with what rounding leaves of its lowest terms: 1e9 intervals under one bound of the second derivative.
  const auto s =
      first_crossing(std::vector<double>{0.0, 1e-20, -1e-20, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, -1.5}, 1.0);
  REQUIRE(s.has_value());
  CHECK(*s == Approx(2.0 / 3.0).epsilon(1e-13));
}

TEST_CASE("First crossing: two roots close together are not missed though both ends are positive") {
  for (const double apart : {1e-1, 1e-3, 1e-5, 1e-7}) {
    const auto s = first_crossing(with_roots({0.4, 0.4 + apart, 2.0}), 1.0);
    REQUIRE(s.has_value());
    CHECK(std::abs(*s - 0.4) < 1e-15 / apart + 1e-14);  // condition of the root
  }
}

TEST_CASE("First crossing: a contact that grazes inside a step, in closed form") {
  // A vibration cos(w (s - p)) passes a flank at 1 - depth for a moment about p, w = 5.5 at the most as exact propagation takes
  // it: the teeth touch where w (s - p) = -acos(1 - depth), and at both ends of the step they do not.
  for (const double w : {0.5, 1.5, 3.0, 5.5})
    for (const double p : {0.3, 0.45, 0.5, 0.7})
      for (const double depth : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10}) {
        std::vector<double> g(41);
        double power = 1.0, largest = 1.0;  // w^k/k!
        for (std::size_t k = 0; k < g.size(); power *= w / static_cast<double>(++k)) {
          largest = std::max(largest, power);
          const double phase = -p * w + 0.5 * kPi * static_cast<double>(k);  // of the k-th derivative
          g[k] = -power * std::cos(phase);
        }
        g[0] += 1.0 - depth;
        REQUIRE(g[0] > 0.0);
        REQUIRE(polynomial_value(g, 1.0) > 0.0);
        const auto s = first_crossing(g, 1.0);
        INFO("w = " << w << ", p = " << p << ", depth " << depth);
        REQUIRE(s.has_value());
        const double touch = p - std::acos(1.0 - depth) / w;
        CHECK(std::abs(*s - touch) <
              5e-16 * largest / std::sqrt(depth) / w + 5e-15);  // rounding of g over its slope there
      }
}

TEST_CASE("First crossing: the root at zero is divided out") {
  // s (0.6 - s) ...: leaves zero upwards, returns at 0.6.
  auto g = with_roots({0.6, 1.5});
  g.insert(g.begin(), 0.0);
  const auto s = first_crossing(g, 1.0);
  REQUIRE(s.has_value());
  CHECK(*s == Approx(0.6).epsilon(1e-13));
  // s^2 (1e-6 - s): returns at once, to full relative accuracy.
  auto near = with_roots({1e-6});
  near.insert(near.begin(), 2, 0.0);
  REQUIRE(first_crossing(near, 1.0).has_value());
  CHECK(*first_crossing(near, 1.0) == Approx(1e-6).epsilon(1e-13));
}

TEST_CASE("First crossing: random polynomials against a dense scan") {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int crossings = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    std::vector<double> g{std::abs(uniform(random)) * std::pow(10.0, -3.0 * trial / 20000.0)};
    double factor = 1.0;
    for (int k = 1; k < 20; ++k, factor *= 4.0 / k) g.push_back(factor * uniform(random));
    const auto s = first_crossing(g, 1.0);
    const double end = s.value_or(1.0);
    if (s) {
      ++crossings;
      CHECK(std::abs(polynomial_value(g, *s)) < 1e-13);
      CHECK(polynomial_value(g, std::min(1.0, *s + 1e-9)) < 1e-13);
    }
    bool below = false;
    for (int i = 0; i < 400; ++i) below |= polynomial_value(g, end * i / 400.0) < -1e-13;
    CHECK(!below);
  }
  CHECK(crossings > 2000);
}

TEST_CASE("First crossing: signs at points alone miss crossings that the bound of the curvature finds") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> anywhere(0.05, 0.9);
  std::uniform_real_distribution<double> decades(-6.0, -1.0);
  int missed_by_signs = 0;
  for (int i = 0; i < 500; ++i) {
    const double first = anywhere(random), apart = std::pow(10.0, decades(random));
    const auto g = with_roots({first, first + apart, 1.5, 2.5});
    bool seen = false;  // the certificate removed: a fall below zero at one of 64 points
    for (int k = 1; k <= 64; ++k) seen |= polynomial_value(g, k / 64.0) < 0.0;
    missed_by_signs += !seen;
    const auto s = first_crossing(g, 1.0);
    REQUIRE(s.has_value());
    CHECK(std::abs(*s - first) < 1e-14 / apart + 1e-12);
  }
  CHECK(missed_by_signs > 200);
}
