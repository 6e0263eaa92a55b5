#include "solvers/periodic/damped_pairs.hpp"

#include <drev/core/assembler.hpp>
#include <drev/solvers/periodic/linear_sweep.hpp>

#include <cmath>
#include <complex>
#include <vector>

#include "core/dense/factorization.hpp"

namespace drev {

namespace {

using Complex = std::complex<double>;

constexpr int kMostSteps = 25;
constexpr double kPairSettled = 1e-12;  // last change of lambda relative to lambda [-]
// Difference of lambda relative to it below which shapes are any of their common space [-], and the part of N that is rounding there.
constexpr double kCoincide = 1e-7, kSameShape = 1e-6;

/// The product A x, with A given by its values on the pattern.
Eigen::VectorXcd pair_product(const SparseMatrix& pattern, const Vector& values, const Eigen::VectorXcd& x) {
  Eigen::VectorXcd y = Eigen::VectorXcd::Zero(x.size());
  const int *outer = pattern.outerIndexPtr(), *inner = pattern.innerIndexPtr();
  for (int j = 0; j < pattern.cols(); ++j)
    for (int e = outer[j]; e < outer[j + 1]; ++e) y[inner[e]] += values[e] * x[j];
  return y;
}

}  // namespace

DampedPairs::DampedPairs(const System& system) : pattern_(system.pattern()), elimination_(system.pattern()) {
  Assembler(system).contact_values({1.0, 0.0, 0.0}, Contact::closed, mass_);
}

bool DampedPairs::refine(const std::function<ModeMatrices(double)>& matrices, Complex& lambda,
                         Eigen::VectorXcd& shape) {
  Complex at = lambda;  // value of s at which S is factored, moved off an exact eigenvalue
  for (int step = 0; step < kMostSteps; ++step) {
    if (!(lambda.imag() > 0.0)) return false;
    const auto [damping, stiffness] = matrices(lambda.imag());
    if (!elimination_.factorize(mass_, damping, stiffness, at)) {
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
    const Complex a = form(mass_), c = form(damping), k = form(stiffness);
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

DampedPole DampedPoles::at(const SweepModes& modes, Eigen::Index mode, double speed) {
  Eigen::Index nearest = 0;
  (modes.speeds.array() - speed).abs().minCoeff(&nearest);
  const auto column = static_cast<std::size_t>(nearest);
  const Eigen::VectorXcd& all = lambda[column];
  const auto coincides = [](Complex a, Complex b) { return std::abs(a - b) <= kCoincide * std::abs(b); };
  std::vector<Eigen::Index> same{mode};
  for (Eigen::Index j = 0; j < all.size(); ++j)
    if (j != mode && coincides(all[j], all[mode])) same.push_back(j);
  DampedPole pole{{}, all(same), shapes[column](Eigen::all, same)};
  // Asked for only where it is needed: loads that are called are looked at anew at another speed.
  const auto damping_of = [&](double at, Complex of) { return matrices(at, of.imag()).damping; };
  if (modes.speeds.size() == 1) {
    pole.damping = damping_of(modes.speeds[nearest], all[mode]);
    return pole;
  }
  const Complex guess = modes.at(mode, speed);
  DampedPole here{{}, pole.lambda, pole.shapes};
  Eigen::Index count = 0;
  for (Eigen::Index j = 0; j < pole.lambda.size(); ++j) {
    Complex found = guess;
    Eigen::VectorXcd shape = pole.shapes.col(j);
    bool good = pairs.refine([&](double omega) { return matrices(speed, omega); }, found, shape);
    for (Eigen::Index k = 0; k < all.size() && j == 0; ++k)
      good &=
          all[k] == 0.0 || coincides(all[k], all[mode]) || std::abs(found - all[k]) > std::abs(found - guess);
    if (!good && j == 0) {
      pole.damping = damping_of(modes.speeds[nearest], all[mode]);
      pole.lambda.setConstant(guess);
      return pole;
    }
    if (!good || (j > 0 && !coincides(found, here.lambda[0]))) continue;
    here.lambda[count] = found;
    here.shapes.col(count++) = shape;
  }
  here.damping = damping_of(speed, here.lambda[0]);
  here.lambda = here.lambda.head(count).eval();
  here.shapes = here.shapes.leftCols(count).eval();
  return here;
}

}  // namespace drev
