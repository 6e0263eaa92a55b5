#include "solvers/reduction/residual_vectors.hpp"

#include <drev/core/assembler.hpp>
#include <drev/core/error.hpp>
#include <drev/core/units.hpp>
#include <drev/solvers/modes/modes.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/dense/eigenvalues.hpp"
#include "solvers/linear/sparse_cholesky.hpp"

namespace drev {

namespace {

using Matrix = Eigen::MatrixXd;

constexpr int kLoadSamples = 128;
constexpr double kShift = 1e-3;        // shift over the first eigenvalue
constexpr int kRefinements = 5;        // each takes the shift's error down by kShift at least
constexpr double kSamePattern = 1e-6;  // difference of equal load patterns over the largest one
constexpr double kDependent = 1e-10;   // energy of a shape beside the others, over its own

/// K^+ of the modes left out, contacts closed.
class Residual {
 public:
  Residual(const System& system, const KeptModes& modes) : modes_(modes), assembler_(system) {
    const double first = kShift * (modes.elastic > 0 ? modes.lambda[modes.rigid] : 1.0);
    Vector shifted;
    assembler_.contact_values({.m = first, .k = 1.0}, Contact::closed, shifted);
    assembler_.contact_values({.k = 1.0}, Contact::closed, stiffness_);
    if (const FactorStatus s = factor_.factorize(system.pattern(), shifted); s != FactorStatus::success)
      throw SolverError("reduction of " + system.name() + ": K - sigma M: " + to_text(s));
  }

  Matrix solve(const Matrix& forces) {
    Matrix shapes(forces.rows(), forces.cols());
    for (Eigen::Index j = 0; j < forces.cols(); ++j) {
      const Vector force = forces.col(j);
      Vector x = Vector::Zero(force.size()), kx = x, step;
      for (int i = 0; i < kRefinements; ++i) {
        Vector rest = force - kx;
        rest -= mass(modes_.vectors) * (modes_.vectors.transpose() * rest);
        factor_.solve(rest, step);
        x += step;
        x -= modes_.vectors * (modes_.vectors.transpose() * mass(x));
        assembler_.multiply(stiffness_, x, kx);
      }
      shapes.col(j) = x;
    }
    return shapes;
  }
  Matrix mass(const Matrix& x) const { return assembler_.product(assembler_.system().mass_values(), x); }
  Matrix stiffness(const Matrix& x) const { return assembler_.product(stiffness_, x); }

 private:
  const KeptModes& modes_;
  Assembler assembler_;
  SparseCholesky factor_;
  Vector stiffness_;
};

/// Two turns of the reference shaft, or up to the last breakpoint if that is later [s].
double cycle(const System& system) {
  const double speed = system.reference_speed();
  double duration = speed > 0.0 ? 2.0 * kTwoPi / speed : 0.0;
  if (!system.breakpoints().empty()) duration = std::max(duration, system.breakpoints().back());
  return duration > 0.0 ? duration : 1.0;
}

/// Forces that are taken up whatever their share: laws, motions of prescribed nodes, mean drag.
Matrix rows_of_laws(const System& system) {
  const bool moves = system.any_prescribed_moves();
  const bool drags = !system.nominal_drag().head(system.size()).isZero(0.0);
  const auto laws = static_cast<Eigen::Index>(system.scalars().size());
  Matrix rows = Matrix::Zero(system.size(), laws + (moves ? system.prescribed_count() : 0) + drags);
  for (Eigen::Index j = 0; j < laws; ++j)
    for (const Entry& e : system.scalars()[static_cast<std::size_t>(j)].z) rows(e.index, j) += e.coeff;
  if (moves) rows.middleCols(laws, system.prescribed_count()) = Matrix(system.coupling_zu().stiffness);
  if (drags) rows.rightCols(1) = system.nominal_drag().head(system.size());
  return rows;
}

/// Patterns of the loads: columns whose products with themselves sum to the samples' mean.
Matrix patterns(const Matrix& samples) {
  if (samples.isZero(0.0)) return Matrix(samples.rows(), 0);
  const SymmetricEigen gram = symmetric_eigen(samples.transpose() * samples);
  const Vector& squares = gram.values;
  const auto count = (squares.array() > kSamePattern * kSamePattern * squares[squares.size() - 1]).count();
  return samples * gram.vectors.rightCols(count) / std::sqrt(static_cast<double>(samples.cols()));
}

/// Combinations of columns with energies above a share of the largest, scaled to energy 1; energies: x' K x
/// of the columns.
Matrix independent(const Matrix& energies, double least) {
  const SymmetricEigen eigen = symmetric_eigen(energies);
  const Vector& e = eigen.values;
  const auto count = (e.array() > least * e[e.size() - 1]).count();
  if (!(e[e.size() - 1] > 0.0)) return Matrix(energies.rows(), 0);
  return eigen.vectors.rightCols(count) * e.tail(count).cwiseSqrt().cwiseInverse().asDiagonal();
}

Matrix beside(const Matrix& a, const Matrix& b) {
  Matrix both(a.rows(), a.cols() + b.cols());
  both << a, b;
  return both;
}

}  // namespace

KeptModes kept_modes(const System& system, int count, double up_to_Hz) {
  const int all = system.elastic_mode_count();
  if (all < 1)
    throw ModelError(
        {{system.name() + "/reduction", "system", "no elastic mode", "", "there is nothing to leave out"}});
  // One more than is kept, where there is one: the first left out.
  int ask = std::min(all, count > 0 ? count + 1 : 10);
  ModeSet modes = solve_modes(system, {.count = ask, .in_time = true});
  while (count == 0 && ask < all && modes.frequency_Hz.back() <= up_to_Hz) {
    ask = std::min(all, 2 * ask);
    modes = solve_modes(system, {.count = ask, .in_time = true});
  }
  KeptModes kept;
  kept.rigid = modes.rigid_modes;
  kept.elastic = count > 0 ? count
                           : static_cast<int>(std::upper_bound(modes.frequency_Hz.begin(),
                                                               modes.frequency_Hz.end(), up_to_Hz) -
                                              modes.frequency_Hz.begin());
  kept.first_left_out_Hz = kept.elastic < modes.count() ? modes.frequency_Hz[idx(kept.elastic)]
                                                        : std::numeric_limits<double>::infinity();
  kept.vectors = beside(modes.rigid_vectors, modes.vectors.leftCols(kept.elastic));
  kept.lambda = Vector::Zero(kept.rigid + kept.elastic);
  for (int j = 0; j < kept.elastic; ++j) kept.lambda[kept.rigid + j] = std::pow(modes.omega(j), 2);
  return kept;
}

Matrix sampled_loads(const System& system, double duration, int count) {
  if (system.loads().empty()) return Matrix(system.size(), 0);
  Assembler assembler(system);
  const Vector rest = Vector::Zero(system.size());
  Matrix samples(system.size(), count);
  Vector with, without;
  for (int i = 0; i < count; ++i) {
    assembler.set_time(duration * (i + 0.5) / count);
    assembler.external(rest, rest, with);
    assembler.external_of_motions(without);
    samples.col(i) = with - without;
  }
  return samples;
}

ResidualVectors residual_vectors(const System& system, const KeptModes& modes, double accuracy) {
  Residual residual(system, modes);
  ResidualVectors found;
  found.columns.resize(system.size(), 0);
  const auto orthonormal_in_energy = [&](const Matrix& shapes, double least) -> Matrix {
    if (shapes.cols() == 0) return shapes;
    return shapes * independent(shapes.transpose() * residual.stiffness(shapes), least);
  };
  // What the modes kept give under constant forces, f' K^+ f of each.
  const auto kept_energies = [&](const Matrix& forces) -> Vector {
    const Matrix shares = modes.vectors.rightCols(modes.elastic).transpose() * forces;
    return (shares.array().square().colwise() / modes.lambda.tail(modes.elastic).array()).colwise().sum();
  };
  // Scaled by their whole energies, so that a soft law does not hide a stiff one.
  const Matrix laws = rows_of_laws(system);
  const Matrix of_laws = residual.solve(laws);
  const Vector left_out = laws.cwiseProduct(of_laws).colwise().sum();
  const Vector whole_laws = left_out + kept_energies(laws);
  Matrix needed(system.size(), 0);
  for (Eigen::Index j = 0; j < laws.cols(); ++j)
    if (left_out[j] > kDependent * whole_laws[j])
      needed = beside(needed, of_laws.col(j) / std::sqrt(whole_laws[j]));
  Matrix taken = orthonormal_in_energy(needed, kDependent);

  const Matrix loads = patterns(sampled_loads(system, cycle(system), kLoadSamples));
  if (loads.cols() > 0) {
    Matrix of_loads = residual.solve(loads);
    const double whole = kept_energies(loads).sum() + loads.cwiseProduct(of_loads).sum();
    if (taken.cols() > 0) of_loads -= taken * (taken.transpose() * residual.stiffness(of_loads));
    const SymmetricEigen eigen = symmetric_eigen(of_loads.transpose() * residual.stiffness(of_loads));
    const Vector energies = eigen.values.cwiseMax(0.0);
    const auto all = energies.size();
    double rest = energies.sum();
    Eigen::Index count = 0;
    while (count < all && rest > accuracy * accuracy * whole) rest -= energies[all - ++count];
    found.error = whole > 0.0 ? std::sqrt(std::max(rest, 0.0) / whole) : 0.0;
    const Matrix most = of_loads * eigen.vectors.rightCols(count);
    taken = beside(taken, orthonormal_in_energy(most, kDependent));
  }
  if (taken.cols() == 0) return found;
  // Among them: K-orthonormal already, except for rounding, so M x = mu K x.
  found.columns = taken * symmetric_eigen(taken.transpose() * residual.stiffness(taken),
                                          taken.transpose() * residual.mass(taken))
                              .vectors;
  return found;
}

}  // namespace drev
