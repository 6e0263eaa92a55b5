#include "solvers/modes/damped_pairs.hpp"

#include <cmath>
#include <complex>
#include <vector>

#include "core/dense/factorization.hpp"

namespace drev {

namespace {

using Complex = std::complex<double>;

constexpr int kMostSteps = 25;
constexpr double kPairSettled = 1e-12;  // last change of lambda relative to lambda [-]
constexpr double kSameShape = 1e-6;     // part of N that is rounding where modes coincide [-]

/// The product A x, with A given by its values on the pattern.
Eigen::VectorXcd pair_product(const SparseMatrix& pattern, const Vector& values, const Eigen::VectorXcd& x) {
  Eigen::VectorXcd y = Eigen::VectorXcd::Zero(x.size());
  const int *outer = pattern.outerIndexPtr(), *inner = pattern.innerIndexPtr();
  for (int j = 0; j < pattern.cols(); ++j)
    for (int e = outer[j]; e < outer[j + 1]; ++e) y[inner[e]] += values[e] * x[j];
  return y;
}

}  // namespace

Eigen::VectorXcd lambda_of(const DampedModeSet& set) {
  Eigen::VectorXcd lambda(static_cast<Eigen::Index>(set.modes.size()));
  for (Eigen::Index m = 0; m < lambda.size(); ++m) lambda[m] = set.modes[static_cast<std::size_t>(m)].lambda;
  return lambda;
}

DampedPairs::DampedPairs(const System& system, const std::vector<bool>& held)
    : pattern_(system.pattern()), mass_(system.mass_values()), elimination_(system.pattern(), held) {}

bool DampedPairs::refine(const std::function<ModeMatrices(double)>& matrices, Complex& lambda,
                         Eigen::VectorXcd& shape) {
  Complex at = lambda;  // value of s at which S is factored, moved off an exact eigenvalue
  for (int step = 0; step < kMostSteps; ++step) {
    if (!(lambda.imag() > 0.0)) return false;
    const auto& [damping, stiffness, loss] = matrices(lambda.imag());
    const bool lossy = loss.size() > 0;
    if (lossy) {
      // Real K - L Re s/Im s and C + L/Im s are K + i L + s C at this s.
      damping_ = damping + loss / at.imag();
      stiffness_ = stiffness - (at.real() / at.imag()) * loss;
    }
    if (!elimination_.factorize(mass_, lossy ? damping_ : damping, lossy ? stiffness_ : stiffness, at)) {
      if (at != lambda) return false;
      at = lambda * (1.0 + 1e-9);
      continue;
    }
    Eigen::VectorXcd next =
        pair_product(pattern_, damping, shape) + 2.0 * lambda * pair_product(pattern_, mass_, shape);
    elimination_.solve(next.data());
    if (!next.allFinite() || next.norm() == 0.0) return false;
    shape = next / next.norm();
    const auto form = [&](const Vector& values) -> Complex {
      return (shape.transpose() * pair_product(pattern_, values, shape))(0, 0);
    };
    const Complex a = form(mass_), c = form(damping),
                  k = form(stiffness) + (lossy ? Complex(0.0, 1.0) * form(loss) : 0.0);
    const Complex root = std::sqrt(c * c - 4.0 * a * k);
    const Complex one = (-c + root) / (2.0 * a), other = (-c - root) / (2.0 * a);
    const Complex found = std::abs(one - lambda) < std::abs(other - lambda) ? one : other;
    const double moved = std::abs(found - lambda);
    at = lambda = found;
    if (!std::isfinite(moved)) return false;
    if (moved <= kPairSettled * std::abs(lambda)) return lambda.imag() > 0.0;
  }
  return false;
}

bool DampedPairs::take_on(const Path& matrices, int steps, Complex& lambda, Eigen::VectorXcd& shape) {
  Complex found = lambda;
  Eigen::VectorXcd its = shape;
  for (int step = 1; step <= steps; ++step) {
    const double part = static_cast<double>(step) / steps;
    if (!refine([&](double omega) { return matrices(part, omega); }, found, its)) return false;
  }
  lambda = found, shape = its;
  return true;
}

bool DampedPairs::take_all_on(const Path& matrices, double highest, const std::function<void()>& pause,
                              Eigen::VectorXcd& lambda, Eigen::MatrixXcd& shapes) {
  constexpr double kLike = 0.999;  // likeness of two shapes that are one [-]
  const Eigen::MatrixXcd given = shapes;
  const Eigen::VectorXcd from = lambda;
  std::vector<Eigen::Index> lost;
  for (const int steps : {kFewSteps, 8 * kFewSteps, 64 * kFewSteps}) {
    lost.clear();
    shapes = given;
    for (Eigen::Index m = 0; m < given.cols(); ++m) {
      if (pause) pause();
      lambda[m] = from[m];
      const bool matters = std::abs(lambda[m]) <= highest;
      Eigen::VectorXcd shape = given.col(m);
      bool good = take_on(matrices, matters ? steps : kFewSteps, lambda[m], shape);
      for (Eigen::Index j = 0; j < m && good && matters; ++j)
        good = std::abs(lambda[j] - lambda[m]) > kSameMode * std::abs(lambda[m]) ||
               std::abs(shape.dot(shapes.col(j))) < kLike * shape.norm() * shapes.col(j).norm();
      if (good || !matters) shapes.col(m) = shape;
      if (!good && matters) lost.push_back(m);
    }
    if (lost.empty()) return true;
  }
  for (const Eigen::Index m : lost) lambda[m] = 0.0;
  return false;
}

Eigen::VectorXcd DampedPairs::residue(const DampedPole& pole, const Eigen::VectorXcd& p) const {
  const Eigen::MatrixXcd x = pole.shapes.colwise().normalized();
  Eigen::MatrixXcd n(x.cols(), x.cols());
  for (Eigen::Index j = 0; j < x.cols(); ++j) {
    const Eigen::VectorXcd of_mass = pair_product(pattern_, mass_, x.col(j)),
                           of_damping = pair_product(pattern_, pole.damping, x.col(j));
    for (Eigen::Index i = 0; i < x.cols(); ++i)
      n(i, j) = (x.col(i).transpose() * ((pole.lambda[i] + pole.lambda[j]) * of_mass + of_damping))(0, 0);
  }
  // Two of the shapes may be the same one. Real and imaginary parts as unknowns: Eigen's decomposition of complex matrices
  // alone takes as long to compile as half of this room.
  const Eigen::Index k = x.cols();
  Eigen::MatrixXd parts(2 * k, 2 * k);
  parts << n.real(), -n.imag(), n.imag(), n.real();
  const Eigen::VectorXcd force = x.transpose() * p;
  Vector right(2 * k);
  right << force.real(), force.imag();
  const Vector y = least_squares(parts, right, kSameShape);
  return x * (y.head(k) + Complex(0.0, 1.0) * y.tail(k));
}

}  // namespace drev
