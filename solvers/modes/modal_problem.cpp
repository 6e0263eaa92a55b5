#include "solvers/modes/modal_problem.hpp"

#include <drev/core/error.hpp>
#include <drev/core/lanes.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/dense/eigenvalues.hpp"
#include "core/dense/factorization.hpp"
#include "solvers/linear/huge_pages.hpp"
#include "solvers/linear/low_fill_factor.hpp"
#include "solvers/linear/vector_kernels.hpp"
#include "solvers/modes/lanczos.hpp"

namespace drev {

namespace {

constexpr int kStrip = 2048;     // rows whose matrix entries stay in the cache for all vectors
constexpr int kStripRows = 512;  // rows whose entries of all vectors stay in the cache
// Times epsilon |x|' |K| |x|: the error of lambda that rounding of K leaves.
constexpr double kRoundings = 16.0;
constexpr double kOfResidual =
    4.0;  // rounding stands in the distances and in r itself, and couples neighbours
constexpr double kInfinite = std::numeric_limits<double>::infinity();

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

/// The upper triangle of X' Y.
void products(const double* x, const double* y, int n, int count, double* g) {
  const std::ptrdiff_t next = n;
  for (int start = 0; start < n; start += kStripRows) {
    const int rows = std::min(kStripRows, n - start);
    for (int j = 0; j < count; ++j)
      for (int i = 0; i <= j; ++i) g[i + j * count] += dot(rows, x + i * next + start, y + j * next + start);
  }
}

/// out = W X C, rows of X taken from their places, C upper triangular. Null places and weights: out may be X.
DREV_WIDEST void arrange(const double* x, int n, int count, const double* c, const int* place,
                         const double* weight, double* out) {
  const std::ptrdiff_t next = n;
  std::vector<double> strip(idx(count + 1) * idx(kStripRows));
  double* w = strip.data() + count * kStripRows;
  for (int start = 0; start < n; start += kStripRows) {
    const int rows = std::min(kStripRows, n - start);
    const auto take = [&](const double* from, double* to) {
      for (int k = 0; k < rows; ++k) to[k] = from[place ? place[start + k] : start + k];
    };
    for (int j = 0; j < count; ++j) take(x + j * next, strip.data() + j * kStripRows);
    if (weight)
      take(weight, w);
    else
      std::fill_n(w, rows, 1.0);
    for (int j = 0; j < count; ++j) {
      double* to = out + j * next + start;
      const double *column = strip.data() + j * kStripRows, own = c[j + j * count];
      for (int k = 0; k < rows; ++k) to[k] = own * column[k];
      for (int i = 0; i < j; ++i) {
        const double share = c[i + j * count];
        column = strip.data() + i * kStripRows;
        for (int k = 0; k < rows; ++k) to[k] += share * column[k];
      }
      for (int k = 0; k < rows; ++k) to[k] *= w[k];
    }
  }
}

}  // namespace

ModalProblem::ModalProblem(const System& system, Contact contact, ModesSummary& summary)
    : system_(system),
      assembler_(system),
      stiffness_(stiffness_values(assembler_, contact)),
      mass_(system.mass_values()),
      lambda_max_(spectrum_scale(system.pattern(), stiffness_, mass_)),
      summary_(summary),
      shifted_(system.pattern()),
      sturm_(system.pattern(), stiffness_, mass_, shifted_.low_fill()) {
  if (!std::isfinite(lambda_max_))
    throw SolverError("modes of " + system.name() +
                      ": a stiffness over an inertia is beyond the range of numbers: an inertia is too small "
                      "beside the stiffness of what it turns with, or a stiffness is not finite");
  const auto low_fill = shifted_.low_fill();
  if (!low_fill || !system.mass_is_diagonal()) return;
  weight_.resize(system.size());
  place_.resize(idx(system.size()));
  for (int j = 0; j < system.size(); ++j) {
    place_[idx(low_fill->order[idx(j)])] = j;
    weight_[j] = 1.0 / std::sqrt(mass_[low_fill->diagonal[idx(j)]]);
  }
}

void ModalProblem::factor(double sigma) {
  const double limit = std::max(100.0 * lambda_max_, 100.0);
  for (; - sigma <= limit; sigma *= 100.0) {
    ++summary_.factorizations;
    if (shifted_.factorize(system_.pattern(), stiffness_ - sigma * mass_) == FactorStatus::success) {
      summary_.shift = sigma;
      lanczos_.reset();
      if (weight_.size() > 0) shifted_.low_fill_factor()->weigh(weight_);
      return;
    }
  }
  const int column = shifted_.failed_column();
  throw SolverError("modes of " + system_.name() + ": K - sigma M is " + to_text(shifted_.status()) +
                    (column >= 0 ? " at node " + system_.unknown_name(column) : std::string()) +
                    " even with a shift far below zero: the mass matrix is not positive definite");
}

void ModalProblem::find_shift(int rigid_modes, int most, bool prefer_dense) {
  const double n = system_.size();
  double sigma = lambda_max_ > 0.0 ? -lambda_max_ / (n * n) : -1.0;
  for (int round = 0; round < 6; ++round) {
    factor(sigma);
    if (rigid_modes >= system_.size()) return;
    const double first = std::abs(first_elastic(rigid_modes, most, prefer_dense));
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
  const SymmetricEigen eigen = symmetric_eigen(mass, shifted);
  if (!eigen.converged)
    throw SolverError("modes of " + system_.name() + ": the dense eigensolver did not converge");
  ModalPairs& pairs = dense_pairs_;
  pairs.lambda = eigen.values.reverse().cwiseInverse().array() + summary_.shift;
  pairs.vectors = eigen.vectors.rowwise().reverse();
  refine(pairs);
  return pairs;
}

ShiftInvertProblem ModalProblem::shift_invert(int count, int start) {
  ShiftInvertProblem problem;
  problem.size = system_.size();
  problem.count = count;
  problem.sigma = summary_.shift;
  problem.start = start;
  const int n = problem.size;
  if (weight_.size() > 0) {
    problem.solve = [this](const double* b, double* x) { shifted_.low_fill_factor()->solve_in_order(b, x); };
    return problem;
  }
  problem.solve = [this, n, in = Vector(n), out = Vector(n)](const double* b, double* x) mutable {
    std::copy_n(b, n, in.data());
    shifted_.solve(in, out);
    std::copy_n(out.data(), n, x);
  };
  problem.mass = [this, n, in = Vector(n), out = Vector(n)](const double* x, double* y) mutable {
    std::copy_n(x, n, in.data());
    assembler_.multiply(mass_, in, out);
    std::copy_n(out.data(), n, y);
  };
  return problem;
}

double ModalProblem::first_elastic(int rigid_modes, int most, bool prefer_dense) {
  constexpr double kRoughly = 1e-2;
  const int count = rigid_modes + 1;
  if (!all_at_once(count, prefer_dense)) {
    lanczos_ = std::make_unique<ShiftInvertLanczos>(shift_invert(std::max(count, most), 0));
    const ShiftInvertResult rough = lanczos_->values(count, kRoughly);
    summary_.solves += rough.solves;
    if (rough.status == ArpackStatus::success) return rough.lambda[rigid_modes];
  }
  return lowest(count, 0, prefer_dense).lambda[rigid_modes];
}

ModalPairs ModalProblem::lanczos(int count, int round) {
  // Rounding in K - sigma M changes its inverse by epsilon lambda_max/|sigma|, relatively: a small part of it
  // is not felt in the pairs. On chains of 2e4 to 1e6 it is below a hundredth of the error that they have.
  constexpr double kNotFelt = 1e-4 * std::numeric_limits<double>::epsilon();
  const double tolerance = std::clamp(kNotFelt * lambda_max_ / -summary_.shift, 1e-15, 1e-10);
  ShiftInvertProblem problem = shift_invert(count, round);
  ShiftInvertResult result;
  if (round == 0) {  // the last pair is only asked where the next frequency lies
    if (!lanczos_ || lanczos_->count() != count) lanczos_ = std::make_unique<ShiftInvertLanczos>(problem);
    result = lanczos_->pairs(std::max(1, count - 1), tolerance);
    lanczos_.reset();
    summary_.solves += result.solves;
    if (result.status == ArpackStatus::success) polish(problem, result);
  }
  for (int attempt = 0; attempt < 3 && result.status != ArpackStatus::success; ++attempt) {
    result = arpack_shift_invert(problem);
    if (result.status == ArpackStatus::success)
      result.vectors = over_unknowns(std::move(result.vectors), Eigen::MatrixXd::Identity(count, count));
    summary_.solves += result.solves;
    problem.basis = 2 * std::max(20, std::max(2 * count + 1, problem.basis));
    problem.start += 17;
  }
  if (result.status != ArpackStatus::success) {
    if (system_.size() <= kDenseRescue) return lowest(count, round, true);
    throw SolverError("modes of " + system_.name() + ": ARPACK: " + result.reason);
  }
  ModalPairs pairs{std::move(result.lambda), std::move(result.vectors), {}, {}};
  refine(pairs);
  return pairs;
}

void ModalProblem::polish(const ShiftInvertProblem& problem, ShiftInvertResult& pairs) {
  Eigen::MatrixXd& x = pairs.vectors;
  const auto count = static_cast<int>(x.cols());
  Eigen::MatrixXd mx(problem.mass ? x.rows() : 0, problem.mass ? count : 0);
  for (int j = 0; j < count; ++j) {
    double* column = x.col(j).data();
    if (problem.mass) problem.mass(column, mx.col(j).data());
    problem.solve(problem.mass ? mx.col(j).data() : column, column);
    if (problem.mass) problem.mass(column, mx.col(j).data());
    ++summary_.solves;
  }
  Eigen::MatrixXd g = Eigen::MatrixXd::Zero(count, count);
  products(x.data(), problem.mass ? mx.data() : x.data(), problem.size, count, g.data());
  const Eigen::VectorXd size = g.diagonal().cwiseSqrt().cwiseInverse();
  g = size.asDiagonal() * g * size.asDiagonal();
  const CholeskyFactor root(g.transpose());  // G is written above its diagonal.
  Eigen::MatrixXd c = Eigen::MatrixXd::Identity(count, count);
  if (root.positive_definite()) c = root.solve_lower_transposed(c);
  x = over_unknowns(std::move(x), size.asDiagonal() * c);
}

Eigen::MatrixXd ModalProblem::over_unknowns(Eigen::MatrixXd vectors, const Eigen::MatrixXd& c) const {
  const auto n = static_cast<int>(vectors.rows()), count = static_cast<int>(vectors.cols());
  if (weight_.size() == 0) {
    arrange(vectors.data(), n, count, c.data(), nullptr, nullptr, vectors.data());
    return vectors;
  }
  Eigen::MatrixXd out(n, count);
  prefer_huge_pages(out);
  arrange(vectors.data(), n, count, c.data(), place_.data(), weight_.data(), out.data());
  return out;
}

bool ModalProblem::all_at_once(int count, bool prefer_dense) const {
  // Lanczos needs a basis of twice the number asked for: near n dense is cheaper and surer.
  return prefer_dense || 2 * count + 1 > system_.size();
}

ModalPairs ModalProblem::lowest(int count, int round, bool prefer_dense) {
  const bool all = all_at_once(count, prefer_dense);
  summary_.method = all ? ModesMethod::dense : ModesMethod::lanczos;
  return all ? dense() : lanczos(count, round);
}

void ModalProblem::refine(ModalPairs& pairs) const {
  constexpr double kRounding = 1e-13, kNormalised = 1e-13, kNothing = 1e-8;
  constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
  const int n = pairs.count();
  pairs.error.resize(n);
  const SparseMatrix& p = system_.pattern();
  const int *outer = p.outerIndexPtr(), *inner = p.innerIndexPtr();
  struct Sums {
    double xmx = 0.0, xkx = 0.0, size = 0.0;
  };
  std::vector<Sums> sums(idx(n));
  for (int start = 0; start < p.rows(); start += kStrip) {
    const int end = std::min(start + kStrip, static_cast<int>(p.rows()));
    for (int j = 0; j < n; ++j) {
      const double* x = &pairs.vectors(0, j);
      Sums& sum = sums[idx(j)];
      for (int row = start; row < end; ++row) {
        double mx = 0.0, kx = 0.0, k_size = 0.0;
        for (int s = outer[row]; s < outer[row + 1]; ++s) {
          const double xi = x[inner[s]], k = stiffness_[s] * xi;
          mx += mass_[s] * xi;
          kx += k;
          k_size += std::abs(k);
        }
        sum.xmx += x[row] * mx;
        sum.xkx += x[row] * kx;
        sum.size += std::abs(x[row]) * k_size;
      }
    }
  }
  pairs.rigid.resize(idx(n));
  for (int j = 0; j < n; ++j) {
    const auto& [xmx, xkx, size] = sums[idx(j)];
    if (!(std::abs(xmx - 1.0) < kNormalised)) pairs.vectors.col(j) /= std::sqrt(xmx);
    const double distance = pairs.lambda[j] - summary_.shift;
    const double of_shift = distance * distance / -summary_.shift;
    if (of_shift > lambda_max_) pairs.lambda[j] = xkx / xmx;
    pairs.error[j] = kRoundings * kEpsilon * (size / xmx + std::min(of_shift, lambda_max_));
    pairs.rigid[idx(j)] =
        std::abs(xkx) <= kRounding * size || std::abs(pairs.lambda[j]) <= kNothing * -summary_.shift;
  }
  // The two estimates may swap what rounding makes equal.
  for (int j = 1; j < n; ++j)
    for (int i = j; i > 0 && pairs.lambda[i] < pairs.lambda[i - 1]; --i) {
      std::swap(pairs.lambda[i], pairs.lambda[i - 1]);
      std::swap(pairs.error[i], pairs.error[i - 1]);
      pairs.vectors.col(i).swap(pairs.vectors.col(i - 1));
      pairs.rigid.swap(pairs.rigid[idx(i)], pairs.rigid[idx(i - 1)]);
    }
}

double ModalProblem::check_residuals(ModalPairs& pairs, int first, int count) const {
  const SparseMatrix& p = system_.pattern();
  const int *outer = p.outerIndexPtr(), *inner = p.innerIndexPtr();
  std::vector<double> largest(idx(count), 0.0), scale(idx(count), 0.0), square(idx(count), 0.0);
  for (int start = 0; start < p.rows(); start += kStrip) {
    const int end = std::min(start + kStrip, static_cast<int>(p.rows()));
    for (int j = 0; j < count; ++j) {
      const double *x = &pairs.vectors(0, first + j), lambda = pairs.lambda[first + j];
      for (int row = start; row < end; ++row) {
        double sum = 0.0, size = 0.0;
        for (int s = outer[row]; s < outer[row + 1]; ++s) {
          const double kx = stiffness_[s] * x[inner[s]], mx = lambda * mass_[s] * x[inner[s]];
          sum += kx - mx;
          size += std::abs(kx) + std::abs(mx);
        }
        largest[idx(j)] = std::max(largest[idx(j)], std::abs(sum));
        scale[idx(j)] = std::max(scale[idx(j)], size);
        square[idx(j)] += sum * sum / mass_[system_.diagonal_slots()[idx(row)]];
      }
    }
  }
  double worst = 0.0;
  for (int j = 0; j < count; ++j) {
    worst = std::max(worst, largest[idx(j)] / scale[idx(j)]);
    const int i = first + j;
    double apart = kInfinite;
    if (i > 0) apart = pairs.lambda[i] - pairs.lambda[i - 1];
    if (i + 1 < pairs.count()) apart = std::min(apart, pairs.lambda[i + 1] - pairs.lambda[i]);
    const double r = std::sqrt(square[idx(j)]);
    pairs.error[i] += kOfResidual * std::min(r, r * (r / apart));
  }
  return worst;
}

const std::string& ModalProblem::largest_entry(const Vector& x) const {
  Eigen::Index largest = 0;
  x.cwiseAbs().maxCoeff(&largest);
  return system_.unknown_name(static_cast<int>(largest));
}

}  // namespace drev
