#include "solvers/stepping/butcher_tableau.hpp"

#include <cmath>
#include <vector>

namespace drev {

namespace {

Vector vector(std::initializer_list<double> values) {
  Vector v(static_cast<Eigen::Index>(values.size()));
  Eigen::Index i = 0;
  for (const double value : values) v[i++] = value;
  return v;
}

/// Rows of the lower triangle; c_i are their sums.
ButcherTableau tableau(std::string name, int order, std::initializer_list<std::initializer_list<double>> rows,
                       Vector b, Vector e) {
  const auto s = static_cast<Eigen::Index>(rows.size());
  ButcherTableau t{std::move(name), order,           Eigen::MatrixXd::Zero(s, s),
                   std::move(b),    Vector::Zero(s), std::move(e)};
  Eigen::Index i = 0;
  for (const auto& row : rows) {
    Eigen::Index j = 0;
    for (const double value : row) t.a(i, j++) = value;
    t.c[i] = t.a.row(i).sum();
    // What rounding left of times at the step's end.
    if (std::abs(t.c[i] - 1.0) < 1e-12) t.c[i] = 1.0;
    ++i;
  }
  return t;
}

}  // namespace

ButcherTableau bathe_tableau(std::string name, double rho_inf) {
  const double gamma = 2.0 / (2.0 + std::sqrt(2.0 + 2.0 * rho_inf)), g = 0.5 * gamma;
  const double q_1 = (rho_inf + 1.0) / (2.0 * gamma * (rho_inf - 1.0) + 4.0);
  const double q_0 = 0.5 - (1.0 - gamma) * q_1;
  const double third_1 = 1.0 / (6.0 * gamma * (1.0 - gamma)), third_2 = 0.5 - gamma * third_1;
  const double third_0 = 1.0 - third_1 - third_2;
  return tableau(std::move(name), 2, {{0.0}, {g, g}, {q_0, q_1, g}}, vector({q_0, q_1, g}),
                 vector({q_0 - third_0, q_1 - third_1, g - third_2}));
}

ButcherTableau sdirk4_tableau() {
  const Vector b = vector({25.0 / 24, -49.0 / 48, 125.0 / 16, -85.0 / 12, 0.25});
  const Vector third = vector({59.0 / 48, -17.0 / 96, 225.0 / 32, -85.0 / 12, 0.0});
  ButcherTableau sdirk4 = tableau("sdirk4", 4,
                                  {{0.25},
                                   {0.5, 0.25},
                                   {17.0 / 50, -1.0 / 25, 0.25},
                                   {371.0 / 1360, -137.0 / 2720, 15.0 / 544, 0.25},
                                   {25.0 / 24, -49.0 / 48, 125.0 / 16, -85.0 / 12, 0.25}},
                                  b, b - third);
  // A cubic through the stages at 1/4, 3/4, 1/2 and 1.
  sdirk4.to_start = vector({4.0, 4.0, 0.0, -6.0, -1.0});
  return sdirk4;
}

ButcherTableau rk4_tableau() {
  return tableau("rk4", 4, {{0.0}, {0.5, 0.0}, {0.0, 0.5, 0.0}, {0.0, 0.0, 1.0, 0.0}},
                 vector({1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6}), {});
}

ButcherTableau dormand_prince_tableau() {
  return tableau(
      "dormand_prince", 5,
      {{0.0},
       {1.0 / 5, 0.0},
       {3.0 / 40, 9.0 / 40, 0.0},
       {44.0 / 45, -56.0 / 15, 32.0 / 9, 0.0},
       {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729, 0.0},
       {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656, 0.0}},
      vector({35.0 / 384, 0.0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}),
      vector({71.0 / 57600, 0.0, -71.0 / 16695, 71.0 / 1920, -17253.0 / 339200, 22.0 / 525, -1.0 / 40}));
}

}  // namespace drev
