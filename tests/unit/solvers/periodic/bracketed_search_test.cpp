// Covers: bracketed_search.hpp (the root and brackets of tops; the maximum is in linear_sweep_test.cpp). Roots in closed form, of
// either sign of the slope, from brackets of which one end would stay.
#include "solvers/periodic/bracketed_search.hpp"

#include <cmath>

#include "tests/catch.hpp"

using drev::IllinoisBracket;

TEST_CASE("The Illinois rule closes in from both ends, faster than bisection", "[illinois]") {
  for (const double sign : {1.0, -1.0}) {
    const auto f = [sign](double x) { return sign * (std::pow(x, 9) - 2.0); };
    IllinoisBracket b{0.0, f(0.0), 3.0, f(3.0)};
    double root = 0.0;
    int steps = 0;
    for (; steps < 60 && std::abs(root - std::pow(2.0, 1.0 / 9.0)) > 1e-14; ++steps) {
      root = b.next();
      CHECK(root >= b.low);
      CHECK(root <= b.high);
      b.take(root, f(root));
    }
    CHECK(steps < 45);
  }
  // Where the end at 0 stays, its value is halved.
  IllinoisBracket b{0.0, -1.0, 2.0, 3.0};
  CHECK(b.next() == 0.5);
  b.take(0.5, 2.0);
  CHECK(b.f_low == -1.0);
  b.take(0.4, 1.0);
  CHECK(b.f_low == -0.5);
  CHECK(b.high == 0.4);
}

TEST_CASE("Tops among points: beside ends and values that are not numbers the bracket has one side",
          "[brackets]") {
  const double none = std::nan("");
  const auto tops = drev::tops_of({1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0},
                                  {5.0, 4.0, 6.0, 6.0, 2.0, 3.0, none, 1.0, 2.0});
  REQUIRE(tops.size() == 4);
  const std::size_t points[] = {0, 3, 5, 8};
  const double low[] = {1.0, 3.0, 5.0, 8.0}, high[] = {2.0, 5.0, 6.0, 9.0};
  for (std::size_t i = 0; i < tops.size(); ++i) {
    CHECK(tops[i].point == points[i]);
    CHECK(tops[i].low == low[i]);
    CHECK(tops[i].high == high[i]);
    CHECK(tops[i].at_end == (i != 1));
    CHECK((tops[i].start > low[i] && tops[i].start < high[i]));
  }
}
