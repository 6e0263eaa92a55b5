#include "solvers/batch/lane_factor.hpp"

#include <Eigen/OrderingMethods>
#include <algorithm>
#include <functional>
#include <limits>

namespace drev {

namespace {

template <class T>  // double where all lanes have one value
struct Triangle {
  int n, entries;
  const LaneFactor::Step *rows, *columns;
  const int *left_unknown, *unknown_of;
  const T *by_rows, *lower, *inverse;
};

/// A chain's neighbours stay in registers: through memory each unknown would wait for the last one's store.
template <class T>
[[gnu::always_inline]] inline void solve_with(const Triangle<T>& t, const LaneRow* b, double factor,
                                              const LaneRow* c, LaneRow* x) {
  Lanes last{}, last_but_one{};
  const T* l = t.by_rows;
  const int* other = t.left_unknown;
  for (const LaneFactor::Step *s = t.rows, *end = s + t.n; s != end; ++s) {
    Lanes sum = b[s->unknown].v + factor * c[s->unknown].v;
    for (const int* stop = other + s->others; other != stop; ++l, ++other) sum -= each(*l) * x[*other].v;
    if (s->near == 2)
      sum -= each(*l++) * last_but_one, ++other;
    else if (s->near == 1)
      sum -= each(*l++) * last, ++other;
    last_but_one = last;
    x[s->unknown].v = last = sum;
  }
  l = t.lower + t.entries;
  other = t.unknown_of + t.entries;
  const T* inverse = t.inverse + t.n;
  for (const LaneFactor::Step* s = t.columns + t.n; s-- != t.columns;) {
    Lanes sum = x[s->unknown].v * each(*--inverse);
    for (const int* stop = other - s->others; other != stop;) sum -= each(*--l) * x[*--other].v;
    if (s->near == 2)
      sum -= each(*--l) * last_but_one, --other;
    else if (s->near == 1)
      sum -= each(*--l) * last, --other;
    last_but_one = last;
    x[s->unknown].v = last = sum;
  }
}

/// The same where places 0, 2, ... are a chain's unknowns from its low end, 1, 3, ... from its high end, and
/// the last one is where both ends meet.
template <class T>
[[gnu::always_inline]] inline void solve_chain(const Triangle<T>& t, const LaneRow* b, double factor,
                                               const LaneRow* c, LaneRow* x) {
  const int n = t.n;
  const bool even = n % 2 == 0;
  const T *l = t.by_rows, *lower = t.lower, *inverse = t.inverse;
  int low = 0, high = n - 1, k = 2;
  Lanes at_low = b[low].v + factor * c[low].v, at_high = b[high].v + factor * c[high].v;
  x[low].v = at_low, x[high].v = at_high;
  const auto step_low = [&] {
    ++low;
    Lanes sum = b[low].v + factor * c[low].v;
    sum -= each(*l++) * at_low;
    x[low].v = at_low = sum;
  };
  for (; k < n - 2; k += 2) {
    step_low();
    --high;
    Lanes sum = b[high].v + factor * c[high].v;
    sum -= each(*l++) * at_high;
    x[high].v = at_high = sum;
  }
  if (even) step_low();
  const int middle = low + 1;
  Lanes sum = b[middle].v + factor * c[middle].v;
  sum -= each(*l++) * (even ? at_high : at_low);
  sum -= each(*l++) * (even ? at_low : at_high);
  x[middle].v = at_low = at_high = sum * each(inverse[n - 1]);
  k = n - 2;
  const auto back_low = [&] {
    Lanes back = x[low].v * each(inverse[k]);
    back -= each(lower[k--]) * at_low;
    x[low--].v = at_low = back;
  };
  if (even) back_low();
  while (k > 0) {
    Lanes back = x[high].v * each(inverse[k]);
    back -= each(lower[k--]) * at_high;
    x[high++].v = at_high = back;
    back_low();
  }
}

DREV_WIDEST
void solve_lanes(bool chain, const Triangle<double>& t, const LaneRow* b, double factor, const LaneRow* c,
                 LaneRow* x) {
  chain ? solve_chain(t, b, factor, c, x) : solve_with(t, b, factor, c, x);
}
DREV_WIDEST
void solve_lanes(bool chain, const Triangle<LaneRow>& t, const LaneRow* b, double factor, const LaneRow* c,
                 LaneRow* x) {
  chain ? solve_chain(t, b, factor, c, x) : solve_with(t, b, factor, c, x);
}

}  // namespace

LaneFactor::LaneFactor(const SparseMatrix& pattern, bool chain)
    : n_(static_cast<int>(pattern.rows())), chain_(chain) {
  const auto n = static_cast<std::size_t>(n_);
  std::vector<int> order(n);  // unknown at place k
  const auto filled = [](const std::vector<std::vector<int>>& all) {
    std::size_t sum = 0;
    for (const auto& c : all) sum += c.size();
    return sum;
  };
  // From both ends a chain's solve is two chains of half the length, which run at once. No order of a whole
  // chain fills less.
  for (int k = 0; k < n_; ++k) order[idx(k)] = k % 2 == 0 ? k / 2 : n_ - 1 - k / 2;
  std::vector<std::vector<int>> below = columns(pattern, order);
  std::vector<int> own(n), least(n);
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> amd;
  Eigen::AMDOrdering<int>()(pattern, amd);
  for (int k = 0; k < n_; ++k) own[idx(k)] = k, least[idx(k)] = amd.indices()[k];
  for (std::vector<int>& other : {std::ref(own), std::ref(least)})
    if (std::vector<std::vector<int>> c = columns(pattern, other); filled(c) < filled(below)) {
      below = std::move(c);
      order = std::move(other);
    }

  std::vector<int> place(n);
  for (int k = 0; k < n_; ++k) place[idx(order[idx(k)])] = k;
  for (const int i : order) rows_.push_back({i, 0, 0});
  columns_ = rows_;
  std::vector<std::vector<int>> by_row(n);  // slots
  column_begin_.push_back(0);
  for (int k = 0; k < n_; ++k) {
    for (const int i : below[idx(k)]) {
      by_row[idx(i)].push_back(static_cast<int>(row_of_.size()));
      row_of_.push_back(i);
      unknown_of_.push_back(order[idx(i)]);
    }
    column_begin_.push_back(static_cast<int>(row_of_.size()));
    columns_[idx(k)].others = static_cast<int>(below[idx(k)].size());
    if (!below[idx(k)].empty()) columns_[idx(k)].take_near(below[idx(k)].front() - k);
  }
  for (int k = 0; k < n_; ++k) {
    int left = -1;
    for (const int slot : by_row[idx(k)]) {  // columns ascend with their slots
      row_slot_.push_back(slot);
      const auto column = std::upper_bound(column_begin_.begin(), column_begin_.end(), slot) - 1;
      left = static_cast<int>(column - column_begin_.begin());
      left_unknown_.push_back(order[idx(left)]);
    }
    rows_[idx(k)].others = static_cast<int>(by_row[idx(k)].size());
    if (left >= 0) rows_[idx(k)].take_near(k - left);
  }
  const auto target = [&](int row, int column) {
    if (row == column) return -1 - row;
    const auto& rows = below[idx(column)];
    return column_begin_[idx(column)] +
           static_cast<int>(std::lower_bound(rows.begin(), rows.end(), row) - rows.begin());
  };
  for (int j = 0; j < n_; ++j)
    for (int s = pattern.outerIndexPtr()[j]; s < pattern.outerIndexPtr()[j + 1]; ++s) {
      const int row = place[idx(pattern.innerIndexPtr()[s])], column = place[idx(j)];
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
  for (std::size_t k = 0; k < n; ++k) place[idx(order[k])] = static_cast<int>(k);
  std::vector<std::vector<int>> all(n);
  for (std::size_t k = 0; k < n; ++k) {
    std::vector<int>& rows = all[k];  // holds what eliminated columns left to this one
    for (int s = pattern.outerIndexPtr()[order[k]]; s < pattern.outerIndexPtr()[order[k] + 1]; ++s)
      if (const int i = place[idx(pattern.innerIndexPtr()[s])]; i > static_cast<int>(k)) rows.push_back(i);
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    if (!rows.empty()) {
      std::vector<int>& parent = all[idx(rows.front())];
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
    LaneRow& to = target < 0 ? pivot_[idx(-1 - target)] : lower[idx(target)];
    to.v += values[idx(pattern_slot_[e])].v;
  }
  const LaneArray diagonal = pivot_;
  std::size_t update = 0;
  for (int k = 0; k < n_; ++k) {
    const int begin = column_begin_[idx(k)], end = column_begin_[idx(k + 1)];
    inverse[idx(k)].v = 1.0 / pivot_[idx(k)].v;
    for (int a = begin; a < end; ++a) {
      const Lanes scaled = lower[idx(a)].v * inverse[idx(k)].v;
      for (int b = a; b < end; ++b) {
        const int target = update_target_[update++];
        LaneRow& to = target < 0 ? pivot_[idx(-1 - target)] : lower[idx(target)];
        to.v -= scaled * lower[idx(b)].v;
      }
    }
    for (int a = begin; a < end; ++a) lower[idx(a)].v *= inverse[idx(k)].v;
  }
  for (std::size_t e = 0; e < row_slot_.size(); ++e) by_rows_.rows[e] = lower[idx(row_slot_[e])];
  for (LaneValues* v : {&lower_, &by_rows_, &inverse_}) v->find_common();
  common_ = lower_.common.size() == lower.size() && inverse_.common.size() == inverse.size();
  for (int lane = 0; lane < kLanes; ++lane) {
    ok_[lane] = true;
    for (std::size_t k = 0; k < pivot_.size(); ++k) {
      const double left = pivot_[k].v[lane] / diagonal[k].v[lane];
      if (!(diagonal[k].v[lane] > 0.0) || !(left > (10 + n_) * std::numeric_limits<double>::epsilon()))
        ok_[lane] = false;
    }
  }
}

void LaneFactor::solve(const LaneRow* b, double factor, const LaneRow* c, LaneRow* x) const {
  const auto with = [&]<class T>(const T* by_rows, const T* lower, const T* inverse) {
    solve_lanes(chain_,
                Triangle<T>{n_, static_cast<int>(row_of_.size()), rows_.data(), columns_.data(),
                            left_unknown_.data(), unknown_of_.data(), by_rows, lower, inverse},
                b, factor, c, x);
  };
  if (common_)
    with(by_rows_.common.data(), lower_.common.data(), inverse_.common.data());
  else
    with(by_rows_.rows.data(), lower_.rows.data(), inverse_.rows.data());
}

}  // namespace drev
