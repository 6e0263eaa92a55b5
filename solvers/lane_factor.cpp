#include "solvers/lane_factor.hpp"

#include <Eigen/OrderingMethods>
#include <algorithm>
#include <limits>

namespace drev {

namespace {

template <class T>  // double where all lanes have one value
struct Triangle {
  int n;
  const int *order, *row_begin, *left_unknown, *column_begin, *unknown_of;
  const char* follows;
  const T *by_rows, *lower, *inverse;
};

/// A chain's neighbour stays in a register: through memory each unknown would wait for the last one's store.
template <class T>
[[gnu::always_inline]] inline void solve_with(const Triangle<T>& t, const LaneRow* b, double factor,
                                              const LaneRow* c, LaneRow* x) {
  Lanes last{};
  for (int k = 0; k < t.n; ++k) {
    const int i = t.order[k];
    Lanes sum = b[i].v + factor * c[i].v;
    const int end = t.row_begin[k + 1];
    const int apart = t.follows[k] ? end - 1 : end;
    for (int e = t.row_begin[k]; e < apart; ++e) sum -= each(t.by_rows[e]) * x[t.left_unknown[e]].v;
    if (t.follows[k]) sum -= each(t.by_rows[apart]) * last;
    x[i].v = last = sum;
  }
  for (int k = t.n - 1; k >= 0; --k) {
    const int i = t.order[k];
    Lanes sum = x[i].v * each(t.inverse[k]);
    int e = t.column_begin[k];
    const int first = e;
    if (k + 1 < t.n && t.follows[k + 1]) ++e;
    for (; e < t.column_begin[k + 1]; ++e) sum -= each(t.lower[e]) * x[t.unknown_of[e]].v;
    if (k + 1 < t.n && t.follows[k + 1]) sum -= each(t.lower[first]) * last;
    x[i].v = last = sum;
  }
}

DREV_WIDEST
void solve_lanes(const Triangle<double>& t, const LaneRow* b, double factor, const LaneRow* c, LaneRow* x) {
  solve_with(t, b, factor, c, x);
}
DREV_WIDEST
void solve_lanes(const Triangle<LaneRow>& t, const LaneRow* b, double factor, const LaneRow* c, LaneRow* x) {
  solve_with(t, b, factor, c, x);
}

}  // namespace

LaneFactor::LaneFactor(const SparseMatrix& pattern) : n_(static_cast<int>(pattern.rows())) {
  const auto n = static_cast<std::size_t>(n_);
  order_.resize(n);
  for (int k = 0; k < n_; ++k) order_[at(k)] = k;
  std::vector<std::vector<int>> below = columns(pattern, order_);
  const auto filled = [](const std::vector<std::vector<int>>& all) {
    std::size_t sum = 0;
    for (const auto& c : all) sum += c.size();
    return sum;
  };
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> amd;
  Eigen::AMDOrdering<int>()(pattern, amd);
  std::vector<int> other(n);
  for (int k = 0; k < n_; ++k) other[at(k)] = amd.indices()[k];
  if (std::vector<std::vector<int>> c = columns(pattern, other); filled(c) < filled(below)) {
    below = std::move(c);
    order_ = std::move(other);
  }

  std::vector<int> place(n);
  for (int k = 0; k < n_; ++k) place[at(order_[at(k)])] = k;
  follows_.assign(n, 0);
  std::vector<std::vector<int>> by_row(n);  // slots
  column_begin_.push_back(0);
  for (int k = 0; k < n_; ++k) {
    for (const int i : below[at(k)]) {
      by_row[at(i)].push_back(static_cast<int>(row_of_.size()));
      row_of_.push_back(i);
      unknown_of_.push_back(order_[at(i)]);
      if (i == k + 1) follows_[at(i)] = 1;
    }
    column_begin_.push_back(static_cast<int>(row_of_.size()));
  }
  row_begin_.push_back(0);
  for (int k = 0; k < n_; ++k) {
    for (const int slot : by_row[at(k)]) {  // columns ascend with their slots
      row_slot_.push_back(slot);
      const auto column = std::upper_bound(column_begin_.begin(), column_begin_.end(), slot) - 1;
      left_unknown_.push_back(order_[static_cast<std::size_t>(column - column_begin_.begin())]);
    }
    row_begin_.push_back(static_cast<int>(row_slot_.size()));
  }
  const auto target = [&](int row, int column) {
    if (row == column) return -1 - row;
    const auto& rows = below[at(column)];
    return column_begin_[at(column)] +
           static_cast<int>(std::lower_bound(rows.begin(), rows.end(), row) - rows.begin());
  };
  for (int j = 0; j < n_; ++j)
    for (int s = pattern.outerIndexPtr()[j]; s < pattern.outerIndexPtr()[j + 1]; ++s) {
      const int row = place[at(pattern.innerIndexPtr()[s])], column = place[at(j)];
      if (row < column) continue;
      pattern_slot_.push_back(s);
      pattern_target_.push_back(target(row, column));
    }
  for (const auto& rows : below)
    for (std::size_t a = 0; a < rows.size(); ++a)
      for (std::size_t b = a; b < rows.size(); ++b) update_target_.push_back(target(rows[b], rows[a]));
  lower_.rows.resize(row_of_.size());
  by_rows_.rows.resize(row_of_.size());
  pivot_.resize(n);
  inverse_.rows.resize(n);
}

std::vector<std::vector<int>> LaneFactor::columns(const SparseMatrix& pattern,
                                                  const std::vector<int>& order) const {
  const std::size_t n = order.size();
  std::vector<int> place(n);
  for (std::size_t k = 0; k < n; ++k) place[at(order[k])] = static_cast<int>(k);
  std::vector<std::vector<int>> all(n);
  for (std::size_t k = 0; k < n; ++k) {
    std::vector<int>& rows = all[k];  // holds what eliminated columns left to this one
    for (int s = pattern.outerIndexPtr()[order[k]]; s < pattern.outerIndexPtr()[order[k] + 1]; ++s)
      if (const int i = place[at(pattern.innerIndexPtr()[s])]; i > static_cast<int>(k)) rows.push_back(i);
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    if (!rows.empty()) {
      std::vector<int>& parent = all[at(rows.front())];
      parent.insert(parent.end(), rows.begin() + 1, rows.end());
    }
  }
  return all;
}

void LaneFactor::factorize(const LaneArray& values) {
  const LaneRow zero{};
  LaneArray &lower = lower_.rows, &inverse = inverse_.rows;
  std::fill(lower.begin(), lower.end(), zero);
  std::fill(pivot_.begin(), pivot_.end(), zero);
  for (std::size_t e = 0; e < pattern_slot_.size(); ++e) {
    const int target = pattern_target_[e];
    LaneRow& to = target < 0 ? pivot_[at(-1 - target)] : lower[at(target)];
    to.v += values[at(pattern_slot_[e])].v;
  }
  const LaneArray diagonal = pivot_;
  std::size_t update = 0;
  for (int k = 0; k < n_; ++k) {
    const int begin = column_begin_[at(k)], end = column_begin_[at(k + 1)];
    inverse[at(k)].v = 1.0 / pivot_[at(k)].v;
    for (int a = begin; a < end; ++a) {
      const Lanes scaled = lower[at(a)].v * inverse[at(k)].v;
      for (int b = a; b < end; ++b) {
        const int target = update_target_[update++];
        LaneRow& to = target < 0 ? pivot_[at(-1 - target)] : lower[at(target)];
        to.v -= scaled * lower[at(b)].v;
      }
    }
    for (int a = begin; a < end; ++a) lower[at(a)].v *= inverse[at(k)].v;
  }
  for (std::size_t e = 0; e < row_slot_.size(); ++e) by_rows_.rows[e] = lower[at(row_slot_[e])];
  for (LaneValues* v : {&lower_, &by_rows_, &inverse_}) v->find_common();
  common_ = lower_.common.size() == lower.size() && inverse_.common.size() == inverse.size();
  for (int lane = 0; lane < kLanes; ++lane) {
    ok_[lane] = true;
    for (std::size_t k = 0; k < pivot_.size(); ++k) {
      const double left = pivot_[k].v[lane] / diagonal[k].v[lane];
      if (!(diagonal[k].v[lane] > 0.0) ||
          !(left > (10 + n_) * std::numeric_limits<double>::epsilon()))
        ok_[lane] = false;
    }
  }
}

void LaneFactor::solve(const LaneRow* b, double factor, const LaneRow* c, LaneRow* x) const {
  const auto with = [&]<class T>(const T* by_rows, const T* lower, const T* inverse) {
    solve_lanes(Triangle<T>{n_, order_.data(), row_begin_.data(), left_unknown_.data(), column_begin_.data(),
                            unknown_of_.data(), follows_.data(), by_rows, lower, inverse},
                b, factor, c, x);
  };
  if (common_)
    with(by_rows_.common.data(), lower_.common.data(), inverse_.common.data());
  else
    with(by_rows_.rows.data(), lower_.rows.data(), inverse_.rows.data());
}

}  // namespace drev
