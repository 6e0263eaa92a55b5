#include "solvers/contact/linear_complementarity.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/dense/factorization.hpp"

namespace drev {

namespace {

constexpr double kPivot = 1e-11;    // smallest pivot over the largest entry of M: smaller ones are rounding
constexpr double kSame = 1e-12;     // relative difference of ratios that are equal except for rounding
constexpr int kTries = 4;           // tries with other artificial columns
constexpr double kNothing = 1e-12;  // a sum over the largest of its terms that is rounding

/// Rows w - M z - 1 z_0 = q; columns w, z, z_0, q.
class Lemke {
 public:
  Lemke(const Eigen::MatrixXd& m, const Eigen::VectorXd& q, int number)
      : n_(q.size()), table_(n_, 2 * n_ + 2) {
    const double largest = q.lpNorm<Eigen::Infinity>();
    scale_ = largest > 0.0 ? largest : 1.0;
    table_ << Eigen::MatrixXd::Identity(n_, n_), -m, -Eigen::VectorXd::Ones(n_), q / scale_;
    for (Eigen::Index i = 0; i < n_; ++i)  // not in step with anything in M
      table_(i, 2 * n_) *= 1.0 + number * std::fmod(0.618033988749895 * static_cast<double>(i + 1), 1.0);
    smallest_ = kPivot * std::max(1.0, m.size() > 0 ? m.cwiseAbs().maxCoeff() : 0.0);
    for (Eigen::Index i = 0; i < n_; ++i) basis_.push_back(i);
  }

  std::optional<ComplementarySolution> solve() {
    if (n_ > 0 && table_.col(2 * n_ + 1).minCoeff() < 0.0) {
      Eigen::Index row = 0;
      for (Eigen::Index i = 1; i < n_; ++i)
        if (precedes(i, row, table_(i, 2 * n_) * -1.0, table_(row, 2 * n_) * -1.0)) row = i;
      Eigen::Index entering = 2 * n_;
      const Eigen::Index most = 50 + 20 * n_ * n_;
      for (Eigen::Index round = 0;; ++round) {
        const Eigen::Index leaving = basis_[static_cast<std::size_t>(row)];
        pivot(row, entering);
        if (leaving == 2 * n_) break;
        entering = leaving < n_ ? leaving + n_ : leaving - n_;
        row = leaving_row(entering);
        if (row < 0 || round == most) return std::nullopt;
      }
    }
    ComplementarySolution found{Eigen::VectorXd::Zero(n_),
                                std::vector<char>(static_cast<std::size_t>(n_), 0)};
    for (Eigen::Index i = 0; i < n_; ++i) {
      const Eigen::Index variable = basis_[static_cast<std::size_t>(i)];
      if (variable < n_ || variable == 2 * n_) continue;
      found.z[variable - n_] = std::max(0.0, scale_ * table_(i, 2 * n_ + 1));
      found.basic[static_cast<std::size_t>(variable - n_)] = 1;
    }
    return found;
  }

 private:
  /// Whether row a over its divisor is lexicographically less than row b over its own.
  bool precedes(Eigen::Index a, Eigen::Index b, double divisor_a, double divisor_b) const {
    for (Eigen::Index j = -1; j < n_; ++j) {
      const Eigen::Index column = j < 0 ? 2 * n_ + 1 : j;
      const double of_a = table_(a, column) / divisor_a, of_b = table_(b, column) / divisor_b;
      if (!same(of_a, of_b)) return of_a < of_b;
    }
    return false;
  }
  static bool same(double a, double b) {
    return std::abs(a - b) <= kSame * std::max({1.0, std::abs(a), std::abs(b)});
  }
  Eigen::Index leaving_row(Eigen::Index entering) const {
    Eigen::Index row = -1;
    for (Eigen::Index i = 0; i < n_; ++i) {
      if (!(table_(i, entering) > smallest_)) continue;
      if (row < 0 || precedes(i, row, table_(i, entering), table_(row, entering))) row = i;
    }
    if (row < 0) return row;
    // z_0 leaves where it may: the problem is solved.
    const double least = table_(row, 2 * n_ + 1) / table_(row, entering);
    for (Eigen::Index i = 0; i < n_; ++i)
      if (basis_[static_cast<std::size_t>(i)] == 2 * n_ && table_(i, entering) > smallest_ &&
          same(table_(i, 2 * n_ + 1) / table_(i, entering), least))
        row = i;
    return row;
  }
  void pivot(Eigen::Index row, Eigen::Index column) {
    table_.row(row) /= table_(row, column);
    for (Eigen::Index i = 0; i < n_; ++i)
      if (i != row && table_(i, column) != 0.0) table_.row(i) -= table_(i, column) * table_.row(row);
    basis_[static_cast<std::size_t>(row)] = column;
  }

  Eigen::Index n_;
  Eigen::MatrixXd table_;
  double scale_ = 1.0, smallest_ = kPivot;
  std::vector<Eigen::Index> basis_;
};

/// Whether rows depend on each other within rounding.
bool singular(const Eigen::MatrixXd& rows) {
  if (rows.size() == 0) return false;
  const Eigen::MatrixXd inverse =
      lu_solve(rows, Eigen::MatrixXd(Eigen::MatrixXd::Identity(rows.rows(), rows.cols())));
  return !(kPivot * inverse.cwiseAbs().maxCoeff() * rows.cwiseAbs().maxCoeff() < 1.0);
}

}  // namespace

std::optional<ComplementarySolution> solve_complementarity(const Eigen::MatrixXd& m,
                                                           const Eigen::VectorXd& q) {
  for (int number = 0; number < kTries; ++number)
    if (auto found = Lemke(m, q, number).solve()) return found;
  return std::nullopt;
}

std::optional<ComplementarySolution> try_every_set(const Eigen::MatrixXd& m, const Eigen::VectorXd& q,
                                                   const std::vector<char>& wanted) {
  const auto n = static_cast<int>(q.size());
  if (n > kMostTried) return std::nullopt;
  const auto bit = [](int set, int i) { return static_cast<char>(set >> i & 1); };
  std::vector<std::pair<int, int>> sets;  // places that differ, set
  for (int set = 0; set < 1 << n; ++set) {
    int differ = 0;
    for (int i = 0; i < n; ++i)
      if (const char w = wanted[static_cast<std::size_t>(i)]; w == 0 || w == 1) differ += w != bit(set, i);
    sets.emplace_back(differ, set);
  }
  std::sort(sets.begin(), sets.end());
  for (const auto& [differ, set] : sets) {
    ComplementarySolution found{Eigen::VectorXd::Zero(n), {}};
    std::vector<Eigen::Index> basic;
    for (int i = 0; i < n; ++i) {
      found.basic.push_back(bit(set, i));
      if (bit(set, i) == 1) basic.push_back(i);
    }
    const Eigen::MatrixXd rows = m(basic, basic);
    if (!basic.empty()) {
      const Vector right = -q(basic);
      found.z(basic) = lu_solve(rows, right);
    }
    if (!found.z.allFinite()) continue;
    const Eigen::VectorXd w = m * found.z + q, terms = m.cwiseAbs() * found.z.cwiseAbs() + q.cwiseAbs();
    const double largest = found.z.size() > 0 ? found.z.cwiseAbs().maxCoeff() : 0.0;
    bool holds = true;
    for (int i = 0; i < n; ++i) {
      const double slack = kNothing * terms[i];
      holds = holds && (bit(set, i) == 1 ? std::abs(w[i]) <= slack && found.z[i] >= -kNothing * largest
                                         : w[i] >= -slack);
    }
    if (!holds || singular(rows)) continue;
    found.z = found.z.cwiseMax(0.0);
    return found;
  }
  return std::nullopt;
}

}  // namespace drev
