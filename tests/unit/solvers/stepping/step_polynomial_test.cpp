// The motion inside a step: polynomials of degree 3, 4 and 5 are reproduced.
#include "solvers/stepping/step_polynomial.hpp"

#include <array>
#include <cmath>

#include "tests/catch.hpp"

using namespace drev;

namespace {

constexpr std::array<double, 6> kMotion{0.3, -1.2, 0.7, 2.0, -3.0, 1.5};  // coefficients of z(t)

/// z, v and a at t of the first `terms` coefficients.
State state_at(double t, int terms) {
  State state;
  state.t = t;
  state.z = state.v = state.a = Vector::Zero(1);
  for (int k = 0; k < terms; ++k) {
    const double c = kMotion[static_cast<std::size_t>(k)];
    state.z[0] += c * std::pow(t, k);
    if (k > 0) state.v[0] += c * k * std::pow(t, k - 1);
    if (k > 1) state.a[0] += c * k * (k - 1) * std::pow(t, k - 2);
  }
  return state;
}

}  // namespace

TEST_CASE("The motion inside a step reproduces polynomials of its own degree") {
  const double t_0 = 0.4, h = 0.5;
  for (const int degree : {3, 4, 5}) {
    const int terms = degree + 1;
    const State from = state_at(t_0, terms), to = state_at(t_0 + h, terms);
    const StepPolynomial polynomial(from, to, h, degree);
    for (const double s : {0.0, 0.2, 0.5, 0.9, 1.0}) {
      CAPTURE(degree, s);
      State inside = from;
      polynomial.at(s, inside);
      const State expected = state_at(t_0 + s * h, terms);
      CHECK(inside.z[0] == Approx(expected.z[0]).epsilon(1e-13));
      CHECK(inside.v[0] == Approx(expected.v[0]).epsilon(1e-13));
      if (degree == 5) CHECK(inside.a[0] == Approx(expected.a[0]).epsilon(1e-12));
    }
  }
}
