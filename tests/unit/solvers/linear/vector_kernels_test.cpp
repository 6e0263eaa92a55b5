// The loops over all unknowns, short and wide, beside sums in extended precision; products by diagonals and
// by rows beside dense ones.
#include "solvers/linear/vector_kernels.hpp"

#include <drev/elements/catalogue.hpp>

#include <cmath>
#include <limits>
#include <random>

#include "solvers/linear/matrix_product.hpp"
#include "tests/catch.hpp"

using namespace drev;

namespace {

// Lengths below, at and above whole vectors, so that every tail is run.
constexpr int kLongest = 41;

Vector random_vector(int n, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> between(-1.0, 1.0);
  Vector x(n);
  for (double& value : x) value = between(engine);
  return x;
}

/// |a - b| within some roundings of a sum of n terms of size 1.
bool close(double a, long double b, int n) {
  return std::abs(a - static_cast<double>(b)) <= 4.0 * n * std::numeric_limits<double>::epsilon();
}

}  // namespace

TEST_CASE("Vector kernels of every length agree with sums in extended precision") {
  for (int n = 1; n <= kLongest; ++n) {
    CAPTURE(n);
    const Vector x = random_vector(n, 1), y = random_vector(n, 2), a = random_vector(n, 3);
    long double product = 0.0L;
    double largest = 0.0, difference = 0.0;
    for (int i = 0; i < n; ++i) {
      product += static_cast<long double>(x[i]) * y[i];
      largest = std::max(largest, std::abs(x[i]));
      difference = std::max(difference, std::abs(x[i] - y[i]));
    }
    CHECK(close(dot(n, x.data(), y.data()), product, n));
    CHECK(largest_size(n, x.data()) == largest);
    CHECK(largest_difference(n, x.data(), y.data()) == difference);
    CHECK(largest_of_both(n, x.data(), y.data()) == std::max(largest, y.cwiseAbs().maxCoeff()));

    Vector z_0(n), v_0(n), sum(n);
    predict_motion(n, 0.5, 0.25, 0.125, x.data(), y.data(), a.data(), z_0.data(), v_0.data());
    CHECK((z_0 - (x + 0.5 * y + 0.25 * a)).cwiseAbs().maxCoeff() <= 1e-15);
    CHECK((v_0 - (y + 0.125 * a)).cwiseAbs().maxCoeff() <= 1e-15);
    sum_with(n, x.data(), -2.0, y.data(), sum.data());
    CHECK((sum - (x - 2.0 * y)).cwiseAbs().maxCoeff() <= 1e-15);
    add_multiple(n, 2.0, y.data(), sum.data());
    CHECK((sum - x).cwiseAbs().maxCoeff() <= 1e-15);

    Vector z = x, v = y;
    const double change =
        correct_motion(n, 0.25, 0.125, z_0.data(), v_0.data(), a.data(), z.data(), v.data());
    CHECK(change == Approx((z_0 + 0.25 * a - x).cwiseAbs().maxCoeff()).margin(1e-15));
    CHECK((v - (v_0 + 0.125 * a)).cwiseAbs().maxCoeff() <= 1e-15);

    const StepWork work =
        step_work(n, x.data(), y.data(), a.data(), z_0.data(), nullptr, nullptr, v_0.data());
    CHECK(work.input == Approx(0.5 * (y - x).dot(a + z_0)).margin(1e-14));
    CHECK(work.stored == Approx(0.5 * y.dot(v_0)).margin(1e-14));
    CHECK(work.dissipated == 0.0);
  }
}

TEST_CASE("A number that is not finite is seen at every place of a vector") {
  for (int n = 1; n <= kLongest; ++n)
    for (int i = 0; i < n; ++i) {
      CAPTURE(n, i);
      Vector x = random_vector(n, 4);
      x[i] = std::numeric_limits<double>::quiet_NaN();
      CHECK(std::isnan(largest_size(n, x.data())));
      const Vector y = Vector::Zero(n);
      CHECK(std::isnan(largest_difference(n, x.data(), y.data())));
      CHECK(std::isnan(largest_of_both(n, y.data(), x.data())));
    }
}

TEST_CASE("Products by diagonals and by rows agree with dense products") {
  for (const int n : {1, 2, 3, 7, 8, 9, 30, 41})
    for (const bool banded : {true, false}) {
      CAPTURE(n, banded);
      std::mt19937 engine(static_cast<unsigned>(n));
      std::uniform_real_distribution<double> between(-1.0, 1.0);
      Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(n, n);
      for (int i = 0; i < n; ++i)
        for (int j = 0; j <= i; ++j)
          if (banded ? i - j <= 1 : engine() % 3 == 0 || i == j) dense(i, j) = dense(j, i) = between(engine);
      const SparseMatrix pattern = dense.sparseView(1.0, -1.0);
      const Vector values = Eigen::Map<const Vector>(pattern.valuePtr(), pattern.nonZeros());
      const MatrixProduct product(pattern, values);
      const Vector x = random_vector(n, 5), y = random_vector(n, 6);
      Vector out(n);
      product.multiply(2.0, x, out);
      CHECK((out - 2.0 * dense * x).cwiseAbs().maxCoeff() <= 1e-14 * n);
      product.multiply_add(-0.5, x, y, out);
      CHECK((out - (y - 0.5 * dense * x)).cwiseAbs().maxCoeff() <= 1e-14 * n);
      CHECK(product.energy(x) == Approx(x.dot(dense * x)).margin(1e-13 * n));
      CHECK_FALSE(product.zero());
    }
}
