// LegendreProjection of forces on polynomials: moments of kinks and conversion to powers, by quadrature in
// long double.
#include <cmath>

#include "solvers/exact/kink_moments.hpp"
#include "solvers/series/legendre_projection.hpp"
#include "tests/catch.hpp"
#include "tests/unit/solvers/exact/placed_load.hpp"

using namespace drev;

namespace {

long double legendre(int j, long double s) {
  const long double x = 2 * s - 1;
  long double p = 1, last = 0;
  for (int i = 0; i < j; ++i) {
    const long double next = ((2 * i + 1) * x * p - i * last) / (i + 1);
    last = p;
    p = next;
  }
  return p;
}

double value(const std::vector<double>& c, double s) {
  double sum = 0.0;
  for (std::size_t k = c.size(); k-- > 0;) sum = sum * s + c[k];
  return sum;
}

}  // namespace

TEST_CASE("Gauss rule: exact to degree 2 n - 1") {
  const GaussRule& rule = gauss_rule();
  for (int degree = 0; degree < 2 * GaussRule::kNodes; ++degree) {
    double sum = 0.0;
    for (std::size_t q = 0; q < GaussRule::kNodes; ++q) sum += rule.weight[q] * std::pow(rule.s[q], degree);
    CHECK(sum == Approx(1.0 / (degree + 1)).epsilon(1e-14));
  }
}

TEST_CASE("Kinks: their projection has the moments of what it stands for") {
  // More knots than lanes, a path with an acceleration and an oscillation, rising and falling.
  for (const double sign : {1.0, -1.0}) {
    std::vector<double> theta{8.0, 0.01 * sign};
    for (int k = 2; k < 20; ++k) theta.push_back(1e-3 * sign * std::pow(1.5, k) / std::tgamma(k + 1));
    KinkMoments kinks;
    LegendreProjection projection(whole_lanes(20));
    std::vector<double> places;
    for (int i = 0; i < 20; ++i) {
      places.push_back(i == 0 ? 0.0 : i == 19 ? 1.0 : 0.03 + 0.05 * i);
      const double jump = 500.0 + i;
      kinks.add(load_on(i, theta[0]), value(theta, places.back()), {&jump, 1}, value(theta, 1.0));
    }
    const int stride = whole_lanes(20);
    std::vector<double> columns(theta.size() * static_cast<std::size_t>(stride));
    for (std::size_t k = 1; k < theta.size(); ++k)
      std::fill_n(columns.begin() + static_cast<std::ptrdiff_t>(k) * stride, 20, theta[k]);
    kinks.expand(columns.data(), stride, theta.size(), theta.size(), {});
    kinks.add_to(projection);
    for (int i = 0; i < 20; ++i)
      for (int j = 0; j < kProjectionTerms; ++j) {
        // Gauss on the part behind the knot: a polynomial of degree 27 at most.
        const double from = places[static_cast<std::size_t>(i)], knot = value(theta, from);
        long double sum = 0.0;
        for (int half = 0; half < 2; ++half)
          for (std::size_t q = 0; q < GaussRule::kNodes; ++q) {
            const double width = 0.5 * (1.0 - from);
            const double s = from + width * (half + gauss_rule().s[q]);
            sum += width * gauss_rule().weight[q] * (500.0 + i) * (value(theta, s) - knot) * legendre(j, s);
          }
        INFO("kink " << i << " of 20, moment " << j);
        CHECK(projection.coefficient(j, i) == Approx(double((2 * j + 1) * sum)).margin(2e-12));
      }
  }
}

TEST_CASE("Projection: a polynomial of its degree is itself, by powers too") {
  const std::vector<double> c{1.0, -2.0, 0.5, 3.0, -1.0, 0.25, 0.75};
  LegendreProjection projection(kLanes);
  for (std::size_t q = 0; q < GaussRule::kNodes; ++q)
    for (int j = 0; j < kProjectionTerms; ++j)
      projection.coefficient(j, 3) += (2 * j + 1) * gauss_rule().weight[q] *
                                      gauss_rule().legendre[static_cast<std::size_t>(j)][q] *
                                      value(c, gauss_rule().s[q]);
  std::vector<double> out(static_cast<std::size_t>(kProjectionTerms * kLanes), 7.0);
  projection.add_powers(2, out.data());
  for (std::size_t k = 0; k < c.size(); ++k)
    CHECK(out[k * kLanes + 3] == Approx(c[k] + (k < 2 ? 7.0 : 0.0)).margin(1e-10));
}
