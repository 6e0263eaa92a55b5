// Small full matrices beside closed forms: what Eigen's and LAPACK's routines give through core/dense.
// Covers factorization.hpp, eigenvalues.hpp, fourier.hpp and lapack.hpp of core/dense.
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

#include "core/dense/eigenvalues.hpp"
#include "core/dense/factorization.hpp"
#include "core/dense/fourier.hpp"
#include "tests/catch.hpp"

using namespace drev;

namespace {

/// 1/(i + j + 1), i, j = 0...: its inverse has whole numbers (Choi 1983, DOI 10.2307/2975779).
Eigen::MatrixXd hilbert(int n) {
  Eigen::MatrixXd a(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) a(i, j) = 1.0 / (i + j + 1);
  return a;
}

}  // namespace

TEST_CASE("Equations of Hilbert's matrix: the columns of its inverse, by every factorisation") {
  const Eigen::MatrixXd a = hilbert(3);
  Eigen::MatrixXd inverse(3, 3);
  inverse << 9, -36, 30, -36, 192, -180, 30, -180, 180;
  const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(3, 3);
  const Vector e = unit.col(1);
  const auto near = [&](const Eigen::MatrixXd& x) { return (x - inverse).cwiseAbs().maxCoeff() < 1e-10; };
  const auto near_column = [&](const Vector& x) {
    return (x - inverse.col(1)).cwiseAbs().maxCoeff() < 1e-10;
  };
  CHECK(near(lu_solve(a, unit)));
  CHECK(near_column(lu_solve(a, e)));
  CHECK(near(ldlt_solve(a, unit)));
  CHECK(near_column(ldlt_solve(a, e)));
  CHECK(near_column(least_squares(a, e)));
  const CholeskyFactor factor(a);
  REQUIRE(factor.positive_definite());
  CHECK(near(factor.inverse()));
  CHECK(near_column(factor.solve(e)));
  CHECK(near(factor.solve_lower_transposed(factor.solve_lower(unit))));
  CHECK((factor.lower() * factor.lower().transpose() - a).cwiseAbs().maxCoeff() < 1e-15);
  CHECK_FALSE(CholeskyFactor(-a).positive_definite());
}

TEST_CASE("Complex equations by elimination with pivoting") {
  Eigen::MatrixXcd a(2, 2);  // i y = 2, x + y = 0
  a << 0.0, std::complex<double>(0.0, 1.0), 1.0, 1.0;
  const Eigen::VectorXcd x = lu_solve(a, Eigen::VectorXcd{{2.0, 0.0}});
  CHECK(std::abs(x[0] - std::complex<double>(0.0, 2.0)) < 1e-15);
  CHECK(std::abs(x[1] - std::complex<double>(0.0, -2.0)) < 1e-15);
  a.row(1).setZero();
  CHECK_FALSE(lu_solve(a, x).allFinite());
}

TEST_CASE("Least squares: a line through points, and the shortest of many solutions") {
  Eigen::MatrixXd line(3, 2);  // through (0, 0), (1, 1), (2, 3): -1/6 + 3/2 t
  line << 1, 0, 1, 1, 1, 2;
  const Vector fit = least_squares(line, Vector{{0.0, 1.0, 3.0}});
  CHECK(fit[0] == Approx(-1.0 / 6.0).epsilon(1e-13));
  CHECK(fit[1] == Approx(1.5).epsilon(1e-13));
  Eigen::MatrixXd twice(2, 3);  // x + 2 y + 2 z = 9, said twice: nearest to the origin at (1, 2, 2)
  twice << 1, 2, 2, 2, 4, 4;
  const Vector x = least_squares(twice, Vector{{9.0, 18.0}});
  CHECK((x - Vector{{1.0, 2.0, 2.0}}).norm() < 1e-13);
}

TEST_CASE("Null spaces: none, a plane, everything") {
  CHECK(null_space(hilbert(3)).cols() == 0);
  Eigen::MatrixXd twice(2, 3);
  twice << 1, 2, 2, 2, 4, 4;
  const Eigen::MatrixXd plane = null_space(twice);
  REQUIRE(plane.cols() == 2);
  CHECK((twice * plane).cwiseAbs().maxCoeff() < 1e-14);
  CHECK((plane.transpose() * plane - Eigen::MatrixXd::Identity(2, 2)).cwiseAbs().maxCoeff() < 1e-14);
  CHECK(null_space(Eigen::MatrixXd::Zero(2, 3)).cols() == 3);
  const Eigen::MatrixXd basis = pivoted_basis(twice.leftCols(2));
  CHECK((basis.transpose() * basis - Eigen::MatrixXd::Identity(2, 2)).cwiseAbs().maxCoeff() < 1e-14);
  CHECK(std::abs(basis.col(1).dot(twice.col(0))) < 1e-14);
}

TEST_CASE("Eigenvalues in closed form: a spiral, a pair of matrices, and none of what is not finite") {
  Eigen::MatrixXd spiral(3, 3);  // -1 +- 2i and 4
  spiral << -1, 2, 0, -2, -1, 0, 0, 0, 4;
  const GeneralEigen found = general_eigen(spiral);
  REQUIRE(found.converged);
  for (int j = 0; j < 3; ++j) {
    const std::complex<double> value = found.values[j];
    CHECK(std::abs((value - 4.0) * (value * value + 2.0 * value + 5.0)) < 1e-12);
    const Eigen::VectorXcd v = found.vectors.col(j);
    CHECK(v.norm() == Approx(1.0).epsilon(1e-14));
    CHECK((spiral.cast<std::complex<double>>() * v - value * v).norm() < 1e-13);
  }
  CHECK(spectral_radius(spiral) == Approx(4.0).epsilon(1e-14));
  spiral(0, 0) = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(general_eigen(spiral).converged);
  CHECK(std::isnan(spectral_radius(spiral)));

  Eigen::MatrixXd k(2, 2), m(2, 2);  // two equal inertias on three equal springs, k/m = 1/2 and 3/2
  k << 2, -1, -1, 2;
  m << 2, 0, 0, 2;
  const SymmetricEigen pair = symmetric_eigen(k, m);
  REQUIRE(pair.converged);
  CHECK(pair.values[0] == Approx(0.5).epsilon(1e-14));
  CHECK(pair.values[1] == Approx(1.5).epsilon(1e-14));
  CHECK((pair.vectors.transpose() * m * pair.vectors - Eigen::MatrixXd::Identity(2, 2)).norm() < 1e-14);
  CHECK_FALSE(symmetric_eigen(k, -m).converged);
  k(1, 0) = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(symmetric_eigen(k).converged);
}

TEST_CASE("The exponential of turns, of every degree of the approximant, and of a nilpotent matrix") {
  for (const double angle : {0.01, 0.2, 0.9, 2.0, 5.0, 40.0}) {
    const Eigen::MatrixXd turned = exponential(Eigen::MatrixXd{{0.0, -angle}, {angle, 0.0}});
    CAPTURE(angle);
    CHECK(std::abs(turned(0, 0) - std::cos(angle)) < 4e-15 * std::max(1.0, angle));
    CHECK(std::abs(turned(1, 0) - std::sin(angle)) < 4e-15 * std::max(1.0, angle));
  }
  CHECK((exponential(Eigen::MatrixXd{{0.0, 7.0}, {0.0, 0.0}}) - Eigen::MatrixXd{{1.0, 7.0}, {0.0, 1.0}})
            .norm() < 1e-14);
  CHECK(exponential(Eigen::MatrixXd::Constant(2, 2, INFINITY)).array().isNaN().all());
  CHECK(exponential(Eigen::MatrixXd(0, 0)).size() == 0);
}

TEST_CASE("Fourier transforms of even and odd counts: the sums that define them, forward and back") {
  FourierTransform transform;
  // Multiples of four, other even counts and odd ones are transformed in different ways.
  for (const int count : {2880, 12, 9, 10, 2}) {
    CAPTURE(count);
    std::vector<double> x;
    for (int j = 0; j < count; ++j) x.push_back(std::sin(3.0 * j + 0.1 * j * j) + 0.2);
    std::vector<std::complex<double>> lines;
    transform.forward(lines, x);
    REQUIRE(lines.size() == static_cast<std::size_t>(count / 2 + 1));
    double worst = 0.0;
    for (std::size_t k = 0; k < lines.size(); ++k) {
      std::complex<double> sum = 0.0;
      for (std::size_t j = 0; j < x.size(); ++j)
        sum +=
            x[j] * std::polar(1.0, -2.0 * std::numbers::pi * static_cast<double>(j * k % x.size()) / count);
      worst = std::max(worst, std::abs(lines[k] - sum));
    }
    CHECK(worst < 1e-13 * count);
    std::vector<double> back;
    transform.inverse(back, lines, count);
    REQUIRE(back.size() == x.size());
    for (std::size_t j = 0; j < x.size(); ++j) worst = std::max(worst, std::abs(back[j] - x[j]));
    CHECK(worst < 1e-13 * count);
  }
}
