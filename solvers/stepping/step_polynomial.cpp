#include "solvers/stepping/step_polynomial.hpp"

namespace drev {

void StepPolynomial::at(double s, State& inside) const {
  // Weights of z_0, v_0, a_0, z_1, v_1, a_1 from the unit polynomials.
  Coefficients unit[6];
  for (int i = 0; i < 6; ++i) unit[i] = through(i == 0, i == 1, i == 2, i == 3, i == 4, i == 5);
  std::array<double, kTerms> power{1.0};
  for (std::size_t k = 1; k < kTerms; ++k) power[k] = power[k - 1] * s;
  double w[3][6] = {};
  for (int i = 0; i < 6; ++i)
    for (std::size_t k = 0; k < kTerms; ++k) {
      const double c = unit[i][k], n = static_cast<double>(k);
      w[0][i] += c * power[k];
      if (k >= 1) w[1][i] += n * c * power[k - 1];
      if (k >= 2) w[2][i] += n * (n - 1.0) * c * power[k - 2];
    }
  // The weights of z_0 and z_1 add to 1 (value) or 0: in terms of their difference rounding stays small.
  const auto sum = [&](const double* c, double scale, Vector& out) {
    out = scale * (c[3] * (to_.z - from_.z) + c[1] * from_.v + c[4] * to_.v);
    if (degree_ == 5) out += (scale * c[2]) * from_.a;
    if (degree_ > 3) out += (scale * c[5]) * to_.a;
  };
  inside.t = from_.t + s * h_;
  sum(w[0], 1.0, inside.z);
  inside.z += from_.z;
  sum(w[1], 1.0 / h_, inside.v);
  if (degree_ == 5)
    sum(w[2], 1.0 / (h_ * h_), inside.a);
  else
    inside.a = (1.0 - s) * from_.a + s * to_.a;
  inside.history = from_.history;
}

StepPolynomial::Coefficients StepPolynomial::through(double x_0, double v_0, double a_0, double x_1,
                                                     double v_1, double a_1) const {
  const double d_0 = h_ * v_0, d_1 = h_ * v_1, rise = x_1 - x_0;
  if (degree_ == 3) return {x_0, d_0, 3 * rise - 2 * d_0 - d_1, d_0 + d_1 - 2 * rise, 0.0, 0.0};
  const double c_0 = 0.5 * h_ * h_ * a_0, c_1 = 0.5 * h_ * h_ * a_1;
  if (degree_ == 4)
    return {x_0,
            d_0,
            6 * rise - 3 * d_0 - 3 * d_1 + c_1,
            -8 * rise + 3 * d_0 + 5 * d_1 - 2 * c_1,
            3 * rise - d_0 - 2 * d_1 + c_1,
            0.0};
  return {x_0,
          d_0,
          c_0,
          10 * rise - 6 * d_0 - 4 * d_1 - 3 * c_0 + c_1,
          -15 * rise + 8 * d_0 + 7 * d_1 + 3 * c_0 - 2 * c_1,
          6 * rise - 3 * d_0 - 3 * d_1 - c_0 + c_1};
}

StepPolynomial::Coefficients StepPolynomial::of(const std::vector<Entry>& entries) const {
  double x[6] = {};
  for (const Entry& e : entries) {
    x[0] += e.coeff * from_.z[e.index];
    x[1] += e.coeff * from_.v[e.index];
    x[3] += e.coeff * to_.z[e.index];
    x[4] += e.coeff * to_.v[e.index];
    if (degree_ > 3) x[2] += e.coeff * from_.a[e.index], x[5] += e.coeff * to_.a[e.index];
  }
  return through(x[0], x[1], x[2], x[3], x[4], x[5]);
}

}  // namespace drev
