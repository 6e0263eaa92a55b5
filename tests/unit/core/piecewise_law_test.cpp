// A law stated once, by pieces or by a formula: what follows from it.
#include <drev/core/law/piecewise_law.hpp>
#include <drev/core/law_element.hpp>
#include <drev/core/verify.hpp>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/catch.hpp"

using namespace drev;

namespace {

/// y = -1, 0, 2 (x - 3), 4 + 8 (x - 5) over x = ..1..3..5.., and a damper 0.5 from 3 on.
std::vector<LawPiece> staircase() {
  return {{.y_0 = -1.0, .elastic_0 = -1.0, .bounds = {{1.0, -1.0, 0.0, 1}}},
          {.bounds = {{-1.0, 1.0, 0.0, 0}, {3.0, -1.0, 0.0, 2}}},
          {-6.0, 2.0, 0.5, -6.0, 2.0, {{-3.0, 1.0, 0.0, 1}, {5.0, -1.0, 0.0, 3}}},
          {-36.0, 8.0, 0.5, -36.0, 8.0, {{-5.0, 1.0, 0.0, 2}}}};
}

struct Stated {
  std::vector<LawPiece> all;
  const std::vector<LawPiece>& pieces() const { return all; }
};

/// y = k x^3 + c x^2 x', in one formula.
struct Cubic {
  double k = 5.0, c = 2.0;
  template <class T>
  T force(const T& x, const T& x_dot) const {
    return k * x * x * x + c * x * x * x_dot;
  }
};

/// The same with its energy.
struct CubicWithEnergy : Cubic {
  double stored_energy(double x) const { return 0.25 * k * x * x * x * x; }
};

/// y = k (x - edge) beyond the edge only.
struct Stop {
  double edge;
  template <class T>
  T force(const T& x, const T&) const {
    return x > edge ? 7.0 * (x - edge) : T(0.0);
  }
  std::span<const double> kinks() const { return {&edge, 1}; }
  double closed_stiffness() const { return 7.0; }
};

/// y = k a tanh(x/a): it bends within a small part of what a run turns it.
struct Saturating {
  double k, a;
  template <class T>
  T force(const T& x, const T&) const {
    using std::tanh;
    return k * a * tanh(x / a);
  }
  double energy(double x) const {  // log(cosh(u)) without cancellation and overflow
    const double u = std::abs(x / a), sinh = std::sinh(std::min(u, 1.0));
    const double of_u =
        u < 1.0 ? 0.5 * std::log1p(sinh * sinh) : u - std::log(2.0) + std::log1p(std::exp(-2.0 * u));
    return k * a * a * of_u;
  }
};

/// A friction that gives way at 1, whose jump is not stated.
struct Jump {
  template <class T>
  T force(const T& x, const T&) const {
    return x < 0.3 ? 2.0 * x : T(-1.0);
  }
};

}  // namespace

TEST_CASE("Piecewise law: force, energy, kinks, gap and closed slopes follow from the pieces") {
  const PiecewiseLaw law(staircase());
  CHECK(law.evaluate(-2.0, 4.0).y == -1.0);
  CHECK(law.evaluate(2.0, 4.0).y == 0.0);
  CHECK(law.evaluate(4.0, 4.0).y == 4.0);
  CHECK(law.evaluate(7.0, 0.0).y == 20.0);
  CHECK(law.evaluate(7.0, 0.0).dy_dx == 8.0);
  CHECK(law.evaluate(7.0, 4.0).dissipated_power == 8.0);
  CHECK(law.evaluate(0.0, 0.0).stored_energy == 1.0);
  CHECK(law.evaluate(2.0, 0.0).stored_energy == 0.0);
  CHECK(law.evaluate(5.0, 0.0).stored_energy == 4.0);
  CHECK(law.evaluate(7.0, 0.0).stored_energy == 4.0 + 8.0 + 16.0);
  REQUIRE(law.kinks().size() == 3);
  CHECK(law.kinks()[1] == 3.0);
  REQUIRE(law.gap());
  CHECK(law.gap()->low == 1.0);
  CHECK(law.gap()->high == 3.0);
  CHECK(law.closed_stiffness() == 8.0);
  CHECK(law.closed_damping() == 0.5);
  CHECK_FALSE(PiecewiseLaw(std::vector<LawPiece>{{.k = 3.0, .c = 1.0, .elastic_k = 3.0}}).gap());
  CHECK_FALSE(PiecewiseLaw(std::vector<LawPiece>{{.c = 1.0}}).gap());
  CHECK(check_element(LawElement<Stated>({staircase()}), 2).text() == "");
}

TEST_CASE("Piecewise law: small deflections from the zero of the force keep their digits") {
  const double b = 0.1, tiny = 1e-14;
  const PiecewiseLaw law(
      {{.bounds = {{b, -1.0, 0.0, 1}}}, {-3.0 * b, 3.0, 0.0, -3.0 * b, 3.0, {{-b, 1.0, 0.0, 0}}}});
  const double x = b + tiny;  // rounded
  CHECK(law.evaluate(x, 0.0).y == Approx(3.0 * (x - b)).epsilon(0.01));
  CHECK(law.evaluate(x, 0.0).stored_energy >= 0.0);
}

TEST_CASE("Piecewise law: many pieces, on and off their bounds, are found as piece_at finds them") {
  std::vector<LawPiece> pieces;
  for (int i = 0; i < 40; ++i) {
    const double k = 1.0 + 0.1 * i;  // continuous: y(i + 1) from the left and from the right
    const double y_0 = i == 0 ? 0.0 : pieces.back().y_0 + (pieces.back().k - k) * i;
    pieces.push_back({.y_0 = y_0, .k = k, .elastic_0 = y_0, .elastic_k = k});
    if (i > 0) pieces.back().bounds.push_back({-double(i), 1.0, 0.0, i - 1});
    if (i < 39) pieces.back().bounds.push_back({i + 1.0, -1.0, 0.0, i + 1});
  }
  const PiecewiseLaw law(pieces);
  std::mt19937 random(1);
  for (int i = 0; i < 1000; ++i) {
    double x = 45.0 * static_cast<double>(random()) / 4294967296.0 - 2.0;
    if (i % 2) x = std::round(x);
    const LawPiece& p = pieces[static_cast<std::size_t>(piece_at(pieces, x, 0.0))];
    CHECK(law.evaluate(x, 0.0).dy_dx == p.k);
    CHECK(law.evaluate(x, 0.0).y == Approx(p.force(x, 0.0)).margin(1e-12));
  }
}

TEST_CASE("Piecewise law: at another stiffness it is the pieces scaled") {
  const PiecewiseLaw law({{.k = 1.0, .c = 0.0, .elastic_k = 1.0, .bounds = {{0.0, 1.0, 0.3, 1}}},
                          {.elastic_k = 1.0, .bounds = {{0.0, -1.0, -0.3, 0}}}});
  const PiecewiseLaw scaled(law.scaled(50.0));
  for (const double x : {-0.4, 0.1, 0.3})
    for (const double x_dot : {-20.0, -1.0, 30.0}) {
      const ScalarResponse a = law.evaluate(x, x_dot, 50.0, 2.0), b = scaled.evaluate(x, x_dot);
      CHECK(a.y == Approx(b.y));
      CHECK(a.dy_dx == b.dy_dx);
      CHECK(a.dy_dangle == Approx(2.0 * a.y / 50.0));
      CHECK(a.stored_energy == Approx(b.stored_energy));
      CHECK(a.dissipated_power == Approx(b.dissipated_power));
    }
}

TEST_CASE("A law as one formula over any scalar: slopes, energy and power follow") {
  const LawForce<Cubic> law({});
  const LawForce<CubicWithEnergy> with_energy({});
  for (const double x : {-0.7, 0.0, 0.4}) {
    const ScalarResponse r = law.evaluate({.x = x, .x_dot = 3.0});
    CHECK(r.y == Approx(5 * x * x * x + 6 * x * x));
    CHECK(r.dy_dx == Approx(15 * x * x + 12 * x));
    CHECK(r.dy_dx_dot == Approx(2 * x * x));
    CHECK(r.stored_energy == Approx(1.25 * x * x * x * x));
    CHECK(with_energy.evaluate({.x = x}).stored_energy == Approx(r.stored_energy));
    CHECK(r.dissipated_power == Approx(18 * x * x));
  }
  for (const int nodes : {1, 2}) CHECK(check_element(LawElement<Cubic>({}), nodes).text() == "");
  CHECK(check_element(LawElement<CubicWithEnergy>({}), 2).text() == "");
  // Beyond a kink the energy is that of the force beyond it.
  CHECK(check_element(LawElement<Stop>({0.02}), 2).text() == "");
  CHECK(LawForce<Stop>({0.02}).evaluate({.x = 0.52}).stored_energy == Approx(0.5 * 7.0 * 0.25));
}

TEST_CASE("The energy of a law that states its force alone is its integral to rounding") {
  for (const double a : {1.0, 0.02, 0.002, 1e-4, 1e-6})
    for (const double x : {-0.5, -1e-3, 0.5, 0.01}) {
      const Saturating law{1e3, a};
      CHECK(LawForce<Saturating>(law).evaluate({.x = x}).stored_energy ==
            Approx(law.energy(x)).epsilon(1e-12));
    }
  const double beyond = LawForce<Jump>({}).evaluate({.x = 0.5}).stored_energy;
  CHECK(beyond == Approx(0.09 - 0.2).epsilon(1e-12));
  int calls = 0;
  const auto counted = [&calls](double x) {
    ++calls;
    return x * x * x * (7.0 - x * x);
  };
  CHECK(energy_of(counted, 2.0, {}) == Approx(7.0 * 4.0 - 64.0 / 6.0).epsilon(1e-14));
  CHECK(calls == 16);
  // What is rough everywhere ends, too, and so does what is no number.
  const auto rough = [&calls](double x) { return ++calls, std::sin(1e9 * x); };
  CHECK(std::abs(energy_of(rough, 1.0, {})) <= 1.0);
  CHECK(calls < 100000);
  CHECK(std::isnan(energy_of([](double) { return std::nan(""); }, 1.0, {})));
}

TEST_CASE("Dual numbers: each function's slope is that of differences") {
  const auto check = [](auto f, double x) {
    const double h = 1e-5;
    const Dual at = f(Dual(x, 1.0, 2.0));
    CHECK(at.by_x == Approx((f(Dual(x + h)).value - f(Dual(x - h)).value) / (2 * h)).epsilon(1e-7));
    CHECK(at.by_x_dot == Approx(2.0 * at.by_x));
  };
  for (const double x : {0.3, 1.7}) {
    check([](const Dual& a) { return sqrt(a) + exp(a) * log(a); }, x);
    check([](const Dual& a) { return sin(a) / (2.0 + cos(a)); }, x);
    check([](const Dual& a) { return tanh(a) - atan(-a) + pow(a, 1.5); }, x);
    check([](const Dual& a) { return abs(1.0 - 3.0 * a) * a; }, x);
    check(
        [](Dual a) {
          a *= a;
          a += 2.0, a -= 0.5 * a, a /= 3.0;
          return a;
        },
        x);
  }
  CHECK(Dual(1.0, 5.0, 0.0) < Dual(2.0));
  CHECK(Dual(2.0, 1.0, 1.0) == Dual(2.0));
}
