#include "solvers/linear/complex_elimination.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>

namespace drev {

namespace {

using Number = std::complex<double>;

/// Without the search for infinities that the operators of std::complex make.
Number times(Number a, Number b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

/// Place of (row, column) in the pattern; -1: none.
int place_in(const SparseMatrix& pattern, int row, int column) {
  const int* begin = pattern.innerIndexPtr() + pattern.outerIndexPtr()[column];
  const int* end = pattern.innerIndexPtr() + pattern.outerIndexPtr()[column + 1];
  const int* found = std::lower_bound(begin, end, row);
  return found != end && *found == row ? static_cast<int>(found - pattern.innerIndexPtr()) : -1;
}

}  // namespace

struct ComplexElimination::Pivoted {
  Eigen::SparseMatrix<Complex> a;
  Eigen::SparseLU<Eigen::SparseMatrix<Complex>> lu;
  bool analysed = false;
};

ComplexElimination::~ComplexElimination() = default;
ComplexElimination::ComplexElimination(ComplexElimination&&) noexcept = default;

ComplexElimination::ComplexElimination(const SparseMatrix& pattern, const std::vector<bool>& held)
    : held_(held), pattern_(pattern) {
  held_.resize(idx(static_cast<int>(pattern.rows())), false);
  std::vector<int> kept, place(held_.size(), -1);
  for (int u = 0; u < static_cast<int>(held_.size()); ++u)
    if (!held_[idx(u)]) {
      place[idx(u)] = static_cast<int>(kept.size());
      kept.push_back(u);
    }
  n_ = static_cast<int>(kept.size());
  std::vector<Eigen::Triplet<double>> entries;
  for (const int column : kept)
    for (SparseMatrix::InnerIterator it(pattern_, column); it; ++it)
      if (const int row = place[idx(static_cast<int>(it.row()))]; row >= 0)
        entries.emplace_back(row, place[idx(column)], 1.0);
  SparseMatrix of_kept(n_, n_);
  of_kept.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation(n_);
  if (n_ > 0) Eigen::AMDOrdering<int>()(of_kept, permutation);
  for (const int i : permutation.indices()) order_.push_back(kept[idx(i)]);
  std::vector<int> number(held_.size(), -1);
  for (int j = 0; j < n_; ++j) number[idx(order_[idx(j)])] = j;

  // Rows of each column of L: those of the matrix and those that its children hand up, in ascending order.
  std::vector<std::vector<int>> rows(order_.size());
  std::vector<std::vector<int>> children(order_.size());
  std::vector<int> mark(order_.size(), -1);
  begin_.push_back(0);
  for (int j = 0; j < n_; ++j) {
    std::vector<int>& own = rows[idx(j)];
    const int unknown = order_[idx(j)];
    mark[idx(j)] = j;
    const auto take = [&](int row) {
      if (row <= j || mark[idx(row)] == j) return;
      mark[idx(row)] = j;
      own.push_back(row);
    };
    for (SparseMatrix::InnerIterator it(pattern_, unknown); it; ++it)
      take(number[idx(static_cast<int>(it.row()))]);
    for (const int child : children[idx(j)])
      for (const int row : rows[idx(child)]) take(row);
    std::sort(own.begin(), own.end());
    if (!own.empty()) children[idx(own.front())].push_back(j);
    diagonal_slot_.push_back(place_in(pattern_, unknown, unknown));
    for (const int row : own) {
      row_.push_back(row);
      slot_.push_back(place_in(pattern_, order_[idx(row)], unknown));
    }
    begin_.push_back(static_cast<int>(row_.size()));
  }
  for (int j = 0; j < n_; ++j)
    for (int a = begin_[idx(j)]; a < begin_[idx(j + 1)]; ++a)
      for (int b = a; b < begin_[idx(j + 1)]; ++b) {
        const int column = row_[idx(a)], row = row_[idx(b)];
        const auto first = row_.begin() + begin_[idx(column)], last = row_.begin() + begin_[idx(column + 1)];
        target_.push_back(row == column
                              ? -1 - column
                              : static_cast<int>(std::lower_bound(first, last, row) - row_.begin()));
      }
  d_.resize(order_.size());
  x_.resize(order_.size());
  l_.resize(row_.size());
  w_.resize(row_.size());
}

bool ComplexElimination::factorize(const Vector& m, const Vector& c, const Vector& k, Complex s) {
  use_pivoted_ = false;
  const Complex s2 = s * s;
  const double size_2 = std::norm(s), size_1 = std::sqrt(size_2);
  const auto value = [&](int slot) {
    if (slot < 0) return Complex(0.0, 0.0);
    return Complex(k[slot] + s.real() * c[slot] + s2.real() * m[slot],
                   s.imag() * c[slot] + s2.imag() * m[slot]);
  };
  for (int j = 0; j < n_; ++j) d_[idx(j)] = value(diagonal_slot_[idx(j)]);
  for (std::size_t e = 0; e < row_.size(); ++e) w_[e] = value(slot_[e]);
  std::size_t update = 0;
  for (int j = 0; j < n_; ++j) {
    const Complex pivot = d_[idx(j)];
    const int slot = diagonal_slot_[idx(j)];
    const double terms =
        slot < 0 ? 0.0 : std::abs(k[slot]) + size_1 * std::abs(c[slot]) + size_2 * std::abs(m[slot]);
    const double size = std::norm(pivot);
    if (!(size > kLostPivot * kLostPivot * terms * terms) || !std::isfinite(size))
      return factorize_pivoted(m, c, k, s);
    const Complex inverse(pivot.real() / size, -pivot.imag() / size);
    d_[idx(j)] = inverse;
    for (int a = begin_[idx(j)]; a < begin_[idx(j + 1)]; ++a) {
      l_[idx(a)] = times(w_[idx(a)], inverse);
      for (int b = a; b < begin_[idx(j + 1)]; ++b) {
        const int target = target_[update++];
        (target < 0 ? d_[idx(-1 - target)] : w_[idx(target)]) -= times(l_[idx(a)], w_[idx(b)]);
      }
    }
  }
  return true;
}

bool ComplexElimination::factorize_pivoted(const Vector& m, const Vector& c, const Vector& k, Complex s) {
  if (!pivoted_) {
    pivoted_ = std::make_unique<Pivoted>();
    pivoted_->a = pattern_.cast<Complex>();
  }
  for (Eigen::Index slot = 0; slot < k.size(); ++slot)
    pivoted_->a.valuePtr()[slot] = k[slot] + s * c[slot] + s * s * m[slot];
  for (int column = 0; column < static_cast<int>(held_.size()); ++column)
    for (Eigen::SparseMatrix<Complex>::InnerIterator it(pivoted_->a, column); it; ++it)
      if (held_[idx(column)] || held_[idx(static_cast<int>(it.row()))])
        it.valueRef() = it.row() == column ? 1.0 : 0.0;
  if (!pivoted_->analysed) pivoted_->lu.analyzePattern(pivoted_->a);
  pivoted_->analysed = true;
  pivoted_->lu.factorize(pivoted_->a);
  use_pivoted_ = pivoted_->lu.info() == Eigen::Success;
  return use_pivoted_;
}

void ComplexElimination::solve(Complex* x) {
  if (use_pivoted_) {
    Eigen::Map<Eigen::VectorXcd> values(x, static_cast<Eigen::Index>(held_.size()));
    const Eigen::VectorXcd found = pivoted_->lu.solve(Eigen::VectorXcd(values));
    values = found;
    return;
  }
  for (int j = 0; j < n_; ++j) x_[idx(j)] = x[order_[idx(j)]];
  for (int j = 0; j < n_; ++j) {
    const Complex known = x_[idx(j)];
    for (int a = begin_[idx(j)]; a < begin_[idx(j + 1)]; ++a)
      x_[idx(row_[idx(a)])] -= times(l_[idx(a)], known);
    x_[idx(j)] = times(known, d_[idx(j)]);
  }
  for (int j = n_ - 1; j >= 0; --j) {
    Complex sum = x_[idx(j)];
    for (int a = begin_[idx(j)]; a < begin_[idx(j + 1)]; ++a) sum -= times(l_[idx(a)], x_[idx(row_[idx(a)])]);
    x_[idx(j)] = sum;
    x[order_[idx(j)]] = sum;
  }
}

}  // namespace drev
