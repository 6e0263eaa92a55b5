#include <drev/core/assembler.hpp>
#include <drev/core/control/controllers.hpp>
#include <drev/core/error.hpp>
#include <drev/core/law/friction.hpp>
#include <drev/core/units.hpp>
#include <drev/solvers/modes/damped_modes.hpp>
#include <drev/solvers/modes/modes.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "core/dense/eigenvalues.hpp"
#include "core/dense/factorization.hpp"
#include "solvers/modes/own_frequency.hpp"
#include "solvers/modes/tied_system.hpp"

namespace drev {

namespace {

using Matrix = Eigen::MatrixXd;

constexpr double kRealRounding = 4.0 * std::numeric_limits<double>::epsilon();

Matrix dense(const SparseMatrix& pattern, const Vector& values) {
  SparseMatrix a = pattern;
  std::copy(values.begin(), values.end(), a.valuePtr());
  return a;
}

/// Orthonormal columns; the first span the null space of K^.
Matrix basis_by_stiffness(const Matrix& k, bool symmetric) {
  if (!symmetric) {
    // K^' P = Q R: what R does not reach is orthogonal to the rows of K^.
    return pivoted_basis(k.transpose()).rowwise().reverse();
  }
  const SymmetricEigen eigen = symmetric_eigen(k);
  const Vector size = eigen.values.cwiseAbs();
  std::vector<int> order(static_cast<std::size_t>(size.size()));
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return size[a] < size[b]; });
  return eigen.vectors(Eigen::all, order);
}

/// Whether the rounding of the stiffest element leaves as many motions without a restoring torque as the graph has.
bool rigid_motions_stand_apart(const Matrix& k, const Matrix& v, int rigid) {
  constexpr double kRounding = 1e-13;
  int found = 0;
  while (found < k.rows() && (k * v.col(found)).norm() <= kRounding * k.norm()) ++found;
  return found == rigid;
}

/// Whether a pair is a multiple real lambda that rounding has split: 0, of several rigid motions' rates, or of equal parts.
bool is_split(std::complex<double> lambda, const Eigen::VectorXcd& vector, int elastic, double rounding) {
  constexpr double kNoSwing = 1e-9, kNoDeflection = 1e-6;
  if (lambda.imag() > rounding) return false;
  if (lambda.imag() <= kNoSwing * std::abs(lambda.real())) return true;
  // What swings deflects, however slowly: a very soft mode stays one.
  return std::abs(lambda) <= rounding && vector.head(elastic).norm() <= kNoDeflection * vector.norm();
}

/// rounding: absolute value of a real part [1/s] up to which it is 0.
DampedMode to_mode(std::complex<double> lambda, double rounding) {
  if (std::abs(lambda.real()) <= rounding) lambda.real(0.0);
  const double w = std::abs(lambda);
  return {lambda, to_hz(lambda.imag()), to_hz(w), 0.0 - lambda.real() / w};
}

}  // namespace

void DampedModeSet::set_modes(const System& system, const Eigen::VectorXcd& lambda, const Vector& rounding) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(lambda.size()));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](Eigen::Index i, Eigen::Index j) { return std::abs(lambda[i]) < std::abs(lambda[j]); });
  vectors = vectors(Eigen::all, order).eval();
  modes.clear();
  shapes.setZero(system.node_count(), lambda.size());
  for (Eigen::Index j = 0; j < lambda.size(); ++j) {
    const Eigen::Index from = order[static_cast<std::size_t>(j)];
    modes.push_back(
        to_mode(lambda[from], rounding.size() > 0 ? rounding[from] : kRealRounding * std::abs(lambda[from])));
    auto shape = shapes.col(j);
    for (int i = 0; i < system.node_count(); ++i)
      for (const Entry& e : system.row_of(i)) shape[i] += e.coeff * vectors(e.index, j);
    Eigen::Index largest = 0;
    shape.cwiseAbs().maxCoeff(&largest);
    const std::complex<double> scale = shape[largest];
    shape /= scale;
  }
}

DampedModeSet solve_damped_modes(const System& system, const DampedModesOptions& options) {
  refuse_controllers(system, "the solution for damped modes");
  if (const auto tied = tied_system(system)) {
    if (options.damping.size() > 0) refuse_friction(system, "a damping by speed");
    DampedModeSet set = solve_damped_modes(tied->system, options);
    set.vectors = (tied->basis * set.vectors).eval();
    return set;
  }
  if (const Eigen::Index places = system.pattern().nonZeros();
      options.damping.size() > 0 && options.damping.size() != places)
    throw ModelError(
        {{system.name() + "/damped modes", "damping", std::to_string(options.damping.size()), "values",
          "must have " + std::to_string(places) + ", one for each place of the system's pattern, or none"}});
  if (!options.in_time && !system.frequency_terms().empty() && system.symmetric_tangent())
    return damped_modes_at_own_frequency(system, options);
  const int n = system.size();
  if (n > options.size_limit)
    throw ModelError({{system.name() + "/damped modes", "unknowns", std::to_string(n), "",
                       "must not exceed size_limit = " + std::to_string(options.size_limit) +
                           ": the eigenproblem is dense"}});
  const Assembler assembler(system);
  Vector values;
  const CholeskyFactor mass(dense(system.pattern(), system.mass_values()));
  if (!mass.positive_definite())
    throw SolverError("damped modes of " + system.name() + ": mass matrix not positive definite");
  // L^-1 A L^-T
  const auto reduced = [&](const Weights& weights) {
    assembler.contact_values(weights, options.contact, values);
    if (options.damping.size() > 0) values += weights.c * options.damping;
    const Matrix half = mass.solve_lower(dense(system.pattern(), values));
    return Matrix(mass.solve_lower(half.transpose()).transpose());
  };
  Matrix k = reduced({0.0, 0.0, 1.0}), c = reduced({0.0, 1.0, 0.0});
  if (system.symmetric_tangent()) k = (0.5 * (k + k.transpose())).eval();

  DampedModeSet set;
  set.contact = options.contact;
  const int r = set.rigid_modes = system.rigid_mode_count(options.contact);
  const int e = n - r;
  Matrix v = basis_by_stiffness(k, system.symmetric_tangent());
  Vector scale = Vector::Constant(e, k.norm() > 0.0 ? std::sqrt(k.norm()) : 1.0);
  const bool one_scale = rigid_motions_stand_apart(k, v, r);
  if (one_scale) {
    k = (v.transpose() * k * v).eval();
  } else {
    // Soft parts beside very stiff ones: the undamped modes, which are found to their own accuracy.
    const ModeSet undamped = solve_modes(system, {.count = e, .contact = options.contact, .in_time = true});
    Matrix x(n, n);
    x << undamped.rigid_vectors, undamped.vectors;
    v = mass.lower().transpose() * x;
    for (int j = 0; j < e; ++j) scale[j] = undamped.omega(j);
    k.setZero();
    k.diagonal().tail(e) = scale.cwiseAbs2();
  }
  c = (v.transpose() * c * v).eval();

  // Unknowns: w_0 y of the elastic coordinates, y' of all.
  Matrix a = Matrix::Zero(e + n, e + n);
  a.block(0, e + r, e, e) = scale.asDiagonal();
  a.block(e, 0, n, e) = -k.rightCols(e) * scale.cwiseInverse().asDiagonal();
  a.block(e, e, n, n) = -c;
  const GeneralEigen eigen = general_eigen(a);
  if (!eigen.converged)
    throw SolverError("damped modes of " + system.name() + ": the eigensolver did not converge");

  std::vector<int> oscillating;
  for (int j = 0; j < e + n; ++j) {
    const std::complex<double> lambda = eigen.values[j];
    if (lambda.imag() == 0.0)
      set.real_lambda.push_back(lambda.real());
    else if (lambda.imag() > 0.0 && is_split(lambda, eigen.vectors.col(j), e, kRealRounding * a.norm()))
      set.real_lambda.insert(set.real_lambda.end(), 2, lambda.real());
    else if (lambda.imag() > 0.0)
      oscillating.push_back(j);
  }
  std::sort(set.real_lambda.rbegin(), set.real_lambda.rend());
  // Nothing damps or feeds energy in: no mode decays or grows.
  const bool conservative = system.symmetric_tangent() && c.isZero(0.0);
  const Matrix to_unknowns = mass.solve_lower_transposed(v);
  const auto count = static_cast<Eigen::Index>(oscillating.size());
  Eigen::VectorXcd lambdas(count);
  Vector rounding(count);
  set.vectors.resize(n, count);
  for (Eigen::Index j = 0; j < count; ++j) {
    const int at = oscillating[static_cast<std::size_t>(j)];
    lambdas[j] = eigen.values[at];
    const double size = one_scale ? scale[0] : std::abs(lambdas[j]);
    rounding[j] = conservative ? std::abs(lambdas[j]) : kRealRounding * size;
    // Rates are lambda times the shape: the common factor is scaled away.
    set.vectors.col(j) = to_unknowns * eigen.vectors.col(at).tail(n);
  }
  set.set_modes(system, lambdas, rounding);
  return set;
}

}  // namespace drev
