#include "solvers/modal_problem.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "solvers/arpack_shift_invert.hpp"

namespace drev {

namespace {

Vector stiffness_values(const Assembler& assembler, Contact contact) {
  if (!assembler.system().symmetric_tangent())
    throw SolverError("modes of " + assembler.system().name() +
                      ": an element says that its tangent is not symmetric; take the damped modes");
  Vector values;
  assembler.contact_values({0.0, 0.0, 1.0}, contact, values);
  return values;
}

/// Largest row sum of |K_ij| / sqrt(M_ii M_jj): lambda_max within a small factor.
double spectrum_scale(const SparseMatrix& pattern, const Vector& stiffness, const Vector& mass) {
  const int n = static_cast<int>(pattern.rows());
  Vector root(n), sum = Vector::Zero(n);
  const auto for_each = [&](auto&& visit) {
    for (int j = 0; j < n; ++j)
      for (int s = pattern.outerIndexPtr()[j]; s < pattern.outerIndexPtr()[j + 1]; ++s)
        visit(pattern.innerIndexPtr()[s], j, s);
  };
  for_each([&](int i, int j, int s) {
    if (i == j) root[i] = std::sqrt(mass[s]);
  });
  for_each([&](int i, int j, int s) { sum[i] += std::abs(stiffness[s]) / (root[i] * root[j]); });
  return sum.maxCoeff();
}

Eigen::MatrixXd to_dense(const SparseMatrix& pattern, const Vector& values) {
  SparseMatrix a = pattern;
  std::copy(values.begin(), values.end(), a.valuePtr());
  return a;
}

}  // namespace

ModalProblem::ModalProblem(const System& system, Contact contact, ModesSummary& summary)
    : system_(system),
      assembler_(system),
      stiffness_(stiffness_values(assembler_, contact)),
      mass_(system.mass_values()),
      lambda_max_(spectrum_scale(system.pattern(), stiffness_, mass_)),
      summary_(summary),
      sturm_(system.pattern(), stiffness_, mass_),
      shifted_(system.pattern()) {}

void ModalProblem::factor(double sigma) {
  const double limit = std::max(100.0 * lambda_max_, 100.0);
  for (; - sigma <= limit; sigma *= 100.0) {
    ++summary_.factorizations;
    if (shifted_.factorize(system_.pattern(), stiffness_ - sigma * mass_) ==
        FactorStatus::success) {
      summary_.shift = sigma;
      return;
    }
  }
  const int column = shifted_.failed_column();
  throw SolverError("modes of " + system_.name() + ": K - sigma M is " +
                    to_text(shifted_.status()) +
                    (column >= 0 ? " at node " + system_.unknown_name(column) : std::string()) +
                    " even with a shift far below zero: the mass matrix is not positive definite");
}

void ModalProblem::find_shift(int rigid_modes, bool prefer_dense) {
  const double n = system_.size();
  double sigma = lambda_max_ > 0.0 ? -lambda_max_ / (n * n) : -1.0;
  for (int round = 0; round < 6; ++round) {
    factor(sigma);
    if (rigid_modes >= system_.size()) return;
    const ModalPairs pairs = lowest(rigid_modes + 1, 0, prefer_dense);
    const double first = std::abs(pairs.lambda[rigid_modes]);
    const double ratio = -summary_.shift / first;
    if ((ratio <= 10.0 && ratio >= 0.01) || summary_.shift != sigma) return;
    // Rounding hides what is far below |sigma|: approach it in steps.
    sigma = -std::max(first, 1e-6 * -summary_.shift);
  }
}

const ModalPairs& ModalProblem::dense() {
  if (dense_shift_ == summary_.shift) return dense_pairs_;
  dense_shift_ = summary_.shift;
  const Eigen::MatrixXd mass = to_dense(system_.pattern(), mass_);
  const Eigen::MatrixXd shifted = to_dense(system_.pattern(), stiffness_ - summary_.shift * mass_);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(mass, shifted);
  if (solver.info() != Eigen::Success)
    throw SolverError("modes of " + system_.name() + ": the dense eigensolver did not converge");
  ModalPairs& pairs = dense_pairs_;
  pairs.lambda = solver.eigenvalues().reverse().cwiseInverse().array() + summary_.shift;
  pairs.vectors = solver.eigenvectors().rowwise().reverse();
  refine(pairs);
  return pairs;
}

ModalPairs ModalProblem::lanczos(int count, int start) {
  ShiftInvertProblem problem;
  problem.size = system_.size();
  problem.count = count;
  problem.sigma = summary_.shift;
  problem.start = start;
  problem.solve = [this](const Vector& b, Vector& x) { shifted_.solve(b, x); };
  problem.mass = [this](const Vector& x, Vector& y) { assembler_.multiply(mass_, x, y); };
  ShiftInvertResult result;
  for (int attempt = 0; attempt < 3; ++attempt) {
    result = arpack_shift_invert(problem);
    summary_.solves += result.solves;
    if (result.status == ArpackStatus::success) break;
    problem.basis = 2 * std::max(20, std::max(2 * count + 1, problem.basis));
    problem.start += 17;
  }
  if (result.status != ArpackStatus::success) {
    if (system_.size() <= kDenseRescue) return lowest(count, start, true);
    throw SolverError("modes of " + system_.name() + ": ARPACK: " + result.reason);
  }
  ModalPairs pairs{std::move(result.lambda), std::move(result.vectors)};
  refine(pairs);
  return pairs;
}

ModalPairs ModalProblem::lowest(int count, int start, bool prefer_dense) {
  // Lanczos needs a basis of twice the number asked for: near n dense is cheaper and surer.
  const bool all = prefer_dense || 2 * count + 1 > system_.size();
  summary_.method = all ? ModesMethod::dense : ModesMethod::lanczos;
  return all ? dense() : lanczos(count, start);
}

void ModalProblem::refine(ModalPairs& pairs) const {
  const int n = pairs.count();
  Vector x, product;
  for (int j = 0; j < n; ++j) {
    x = pairs.vectors.col(j);
    assembler_.multiply(mass_, x, product);
    x /= std::sqrt(x.dot(product));
    pairs.vectors.col(j) = x;
    const double distance = pairs.lambda[j] - summary_.shift;
    if (distance * distance > -summary_.shift * lambda_max_) {
      assembler_.multiply(stiffness_, x, product);
      pairs.lambda[j] = x.dot(product);
    }
  }
  // The two estimates may swap what rounding makes equal.
  for (int j = 1; j < n; ++j)
    for (int i = j; i > 0 && pairs.lambda[i] < pairs.lambda[i - 1]; --i) {
      std::swap(pairs.lambda[i], pairs.lambda[i - 1]);
      pairs.vectors.col(i).swap(pairs.vectors.col(i - 1));
    }
}

bool ModalProblem::stores_no_energy(const Vector& x) const {
  constexpr double kRounding = 1e-13;
  Vector product, magnitude;
  assembler_.multiply(stiffness_, x, product);
  assembler_.multiply(stiffness_.cwiseAbs(), x.cwiseAbs(), magnitude);
  return std::abs(x.dot(product)) <= kRounding * x.cwiseAbs().dot(magnitude);
}

double ModalProblem::residual(double lambda, const Vector& x) const {
  Vector kx, mx, k_size, m_size;
  assembler_.multiply(stiffness_, x, kx);
  assembler_.multiply(mass_, x, mx);
  assembler_.multiply(stiffness_.cwiseAbs(), x.cwiseAbs(), k_size);
  assembler_.multiply(mass_.cwiseAbs(), x.cwiseAbs(), m_size);
  return (kx - lambda * mx).cwiseAbs().maxCoeff() / (k_size + lambda * m_size).maxCoeff();
}

const std::string& ModalProblem::largest_entry(const Vector& x) const {
  Eigen::Index largest = 0;
  x.cwiseAbs().maxCoeff(&largest);
  return system_.unknown_name(static_cast<int>(largest));
}

}  // namespace drev
