#include "solvers/reduction/craig_bampton.hpp"

#include <drev/core/error.hpp>
#include <drev/core/units.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "core/dense/eigenvalues.hpp"
#include "solvers/linear/sturm_count.hpp"
#include "solvers/modes/lanczos.hpp"

namespace drev {

namespace {

using Matrix = Eigen::MatrixXd;

constexpr int kDense = 300;  // unknowns: quick enough, and all copies are there
constexpr int kDenseRescue = 3000;
constexpr double kLanczosTolerance = 1e-14;

SparseMatrix part(const SparseMatrix& pattern, const Vector& values, const std::vector<int>& rows,
                  const std::vector<int>& columns) {
  std::vector<int> place(idx(static_cast<int>(pattern.rows())), -1);
  for (std::size_t i = 0; i < rows.size(); ++i) place[idx(rows[i])] = static_cast<int>(i);
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t j = 0; j < columns.size(); ++j)
    for (int s = pattern.outerIndexPtr()[columns[j]]; s < pattern.outerIndexPtr()[columns[j] + 1]; ++s)
      if (const int i = place[idx(pattern.innerIndexPtr()[s])]; i >= 0)
        entries.emplace_back(i, static_cast<int>(j), values[s]);
  SparseMatrix m(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(columns.size()));
  m.setFromTriplets(entries.begin(), entries.end());
  return m;
}

Vector values_of(const SparseMatrix& m) { return Eigen::Map<const Vector>(m.valuePtr(), m.nonZeros()); }

}  // namespace

std::vector<int> nodes_to_keep(const System& system, const std::vector<std::string>& names) {
  std::set<int> kept;
  const auto keep = [&](int node) {
    if (node >= 0 && system.node_map(node).unknown >= 0) kept.insert(system.node_map(node).unknown);
  };
  for (const std::string& name : names) keep(system.node(name));
  for (const ScalarTerm& s : system.scalars()) {
    for (const Entry& e : s.nodes) keep(e.index);
    keep(s.phase_node);
  }
  for (const GeneralTerm& g : system.generals())
    for (const int node : g.nodes) keep(node);
  return {kept.begin(), kept.end()};
}

CraigBampton::CraigBampton(const System& system, std::vector<int> kept)
    : system_(system), kept_(std::move(kept)) {
  for (int i = 0; i < system.size(); ++i)
    if (!std::binary_search(kept_.begin(), kept_.end(), i)) inside_.push_back(i);
  const SparseMatrix& p = system.pattern();
  stiffness_ = part(p, system.stiffness_values(), inside_, inside_);
  mass_ = part(p, system.mass_values(), inside_, inside_);
  boundary_stiffness_ = part(p, system.stiffness_values(), inside_, kept_);
}

Matrix CraigBampton::basis(int modes, double up_to_Hz) {
  const auto b = static_cast<Eigen::Index>(kept_.size());
  const int n = static_cast<int>(inside_.size());
  Matrix inner(n, b);
  if (n > 0) {
    if (factor_.factorize(stiffness_, values_of(stiffness_)) != FactorStatus::success) {
      const int column = factor_.failed_column();
      throw SolverError("reduction of " + system_.name() + ": the part with node " +
                        system_.unknown_name(inside_[idx(std::max(column, 0))]) +
                        " hangs on no kept node: keep one of its nodes");
    }
    Vector x;
    for (Eigen::Index j = 0; j < b; ++j) {
      factor_.solve(-Vector(boundary_stiffness_.col(j)), x);
      inner.col(j) = x;
    }
    const auto below = [&] {
      return static_cast<int>((lambda_.array() <= hz(up_to_Hz) * hz(up_to_Hz)).count());
    };
    find_modes(std::min(n, modes > 0 ? modes + 1 : 10));
    while (modes == 0 && below() == lambda_.size() && lambda_.size() < n)
      find_modes(static_cast<int>(std::min<Eigen::Index>(n, 2 * lambda_.size())));
    modes_ = modes > 0 ? std::min(n, modes) : below();
  }
  first_left_out_Hz_ =
      modes_ < n ? to_hz(std::sqrt(lambda_[modes_])) : std::numeric_limits<double>::infinity();
  Matrix basis = Matrix::Zero(system_.size(), b + modes_);
  for (Eigen::Index j = 0; j < b; ++j) basis(kept_[static_cast<std::size_t>(j)], j) = 1.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    auto row = basis.row(inside_[static_cast<std::size_t>(i)]);
    row.head(b) = inner.row(i);
    if (modes_ > 0) row.tail(modes_) = vectors_.row(i).head(modes_);
  }
  return basis;
}

void CraigBampton::find_modes(int count) {
  const int n = static_cast<int>(inside_.size());
  if (n > kDense && 2 * count + 1 < n) {
    ShiftInvertProblem problem;
    problem.size = n;
    problem.count = count;
    Vector in(n), out(n);
    problem.solve = [&](const double* f, double* x) {
      std::copy_n(f, n, in.data());
      factor_.solve(in, out);
      std::copy_n(out.data(), n, x);
    };
    problem.mass = [&](const double* x, double* y) {
      Eigen::Map<Vector>(y, n) = mass_ * Eigen::Map<const Vector>(x, n);
    };
    ShiftInvertResult found = ShiftInvertLanczos(problem).pairs(count, kLanczosTolerance);
    if (found.status == ArpackStatus::success) {
      // No copy of a frequency is missing where the Sturm count agrees.
      const double point = found.lambda[count - 1] * (1.0 - 1e-6);
      const Vector k = values_of(stiffness_), m = values_of(mass_);
      const SturmCount below = InertiaCounter(stiffness_, k, m).count_below(point);
      const auto expected = (found.lambda.array() < point).count();
      if (below.trusted && below.below == expected) {
        lambda_ = std::move(found.lambda);
        vectors_ = std::move(found.vectors);
        return;
      }
    }
    if (n > kDenseRescue)
      throw SolverError("reduction of " + system_.name() +
                        ": the modes with kept nodes held were not all found; keep more nodes");
  }
  const SymmetricEigen all = symmetric_eigen(Matrix(mass_), Matrix(stiffness_));
  lambda_ = all.values.reverse().cwiseInverse();
  vectors_ = all.vectors.rowwise().reverse();
  for (int j = 0; j < n; ++j) vectors_.col(j) /= std::sqrt(vectors_.col(j).dot(mass_ * vectors_.col(j)));
}

}  // namespace drev
