#include "solvers/linear/low_fill_factor.hpp"

#include <drev/core/lanes.hpp>

#include <algorithm>
#include <cmath>

#include "solvers/linear/cholmod_factor.hpp"
#include "solvers/linear/huge_pages.hpp"

namespace drev {

namespace {

constexpr long kProducts = 32;  // a column of L on average, above which CHOLMOD is left to it
constexpr long kSmall = 1000;   // products that are always accepted
constexpr int kShortestRun = 8, kLongestRun = 4096;

using Run = LowFillPattern::Run;

std::vector<int> inverse(const std::vector<int>& order) {
  std::vector<int> place(order.size());
  for (std::size_t j = 0; j < order.size(); ++j) place[idx(order[j])] = static_cast<int>(j);
  return place;
}

/// The same elimination tree, all columns of one height after another.
std::vector<int> by_height(const SparseMatrix& p, const std::vector<int>& order) {
  const int n = static_cast<int>(order.size());
  const std::vector<int> place = inverse(order);
  std::vector<int> parent(idx(n), -1), ancestor(idx(n), -1), height(idx(n), 0);
  for (int j = 0; j < n; ++j)
    for (int s = p.outerIndexPtr()[order[idx(j)]]; s < p.outerIndexPtr()[order[idx(j)] + 1]; ++s)
      for (int i = place[idx(p.innerIndexPtr()[s])]; i >= 0 && i < j;) {
        const int next = ancestor[idx(i)];
        ancestor[idx(i)] = j;
        if (next < 0) parent[idx(i)] = j;
        i = next;
      }
  std::vector<int> first(idx(n + 1), 0), sorted(idx(n));
  for (int j = 0; j < n; ++j) {
    if (parent[idx(j)] >= 0) {
      int& above = height[idx(parent[idx(j)])];
      above = std::max(above, height[idx(j)] + 1);
    }
    ++first[idx(height[idx(j)] + 1)];
  }
  for (int h = 0; h < n; ++h) first[idx(h + 1)] += first[idx(h)];
  for (int j = 0; j < n; ++j) sorted[idx(first[idx(height[idx(j)])]++)] = order[idx(j)];
  return sorted;
}

/// Columns of L; false where they fill too much.
bool find_columns(const SparseMatrix& p, const std::vector<int>& place, LowFillPattern& s) {
  const int n = s.size;
  std::vector<int> mark(idx(n), -1), child(idx(n), -1), sibling(idx(n), -1);
  s.begin.reserve(idx(n + 1));
  s.rows.reserve(idx(n));
  s.begin.push_back(0);
  long products = 0;
  for (int j = 0; j < n; ++j) {
    const std::size_t start = s.rows.size();
    const auto take = [&](int i) {
      if (i > j && mark[idx(i)] != j) mark[idx(i)] = j, s.rows.push_back(i);
    };
    const int row = s.order[idx(j)];
    for (int e = p.outerIndexPtr()[row]; e < p.outerIndexPtr()[row + 1]; ++e)
      take(place[idx(p.innerIndexPtr()[e])]);
    for (int c = child[idx(j)]; c >= 0; c = sibling[idx(c)])
      for (int e = s.begin[idx(c)]; e < s.begin[idx(c + 1)]; ++e) take(s.rows[idx(e)]);
    std::sort(s.rows.begin() + static_cast<std::ptrdiff_t>(start), s.rows.end());
    s.begin.push_back(static_cast<int>(s.rows.size()));
    if (s.rows.size() == start) continue;
    const int parent = s.rows[start];
    sibling[idx(j)] = child[idx(parent)];
    child[idx(parent)] = j;
    const long count = static_cast<long>(s.rows.size() - start);
    products += count * (count - 1) / 2;
    if (products > kSmall && products > kProducts * n) return false;
  }
  return true;
}

void find_slots(const SparseMatrix& p, const std::vector<int>& place, LowFillPattern& s) {
  s.diagonal.assign(idx(s.size), -1);
  s.slot.assign(s.rows.size(), -1);
  const auto entry = [&](int row, int column) {
    const auto first = s.rows.begin() + s.begin[idx(column)],
               last = s.rows.begin() + s.begin[idx(column + 1)];
    return static_cast<std::size_t>(std::lower_bound(first, last, row) - s.rows.begin());
  };
  for (int j = 0; j < s.size; ++j) {
    const int row = s.order[idx(j)];
    for (int e = p.outerIndexPtr()[row]; e < p.outerIndexPtr()[row + 1]; ++e) {
      const int i = place[idx(p.innerIndexPtr()[e])];
      if (i == j) s.diagonal[idx(j)] = e;
      if (i > j) s.slot[entry(i, j)] = e;
    }
    for (int a = s.begin[idx(j)]; a < s.begin[idx(j + 1)]; ++a)
      for (int b = a + 1; b < s.begin[idx(j + 1)]; ++b)
        s.target.push_back(static_cast<int>(entry(s.rows[idx(b)], s.rows[idx(a)])));
  }
}

void find_runs(LowFillPattern& s) {
  const auto stride = [&](int j) {
    const int count = s.begin[idx(j + 1)] - s.begin[idx(j)];
    const int step = count == 1 ? s.rows[idx(s.begin[idx(j)])] - j : 0;
    return step <= 2 ? step : 0;
  };
  int target = 0;
  const auto append = [&](int begin, int end, int step) {
    if (step > 0 && end - begin < kShortestRun) step = 0;
    if (!s.runs.empty() && s.runs.back().stride == 0 && step == 0 && end - s.runs.back().begin <= kLongestRun)
      s.runs.back().end = end;
    else
      s.runs.push_back({begin, end, step, target, end});
    int& reach = s.runs.back().reach;
    for (int j = begin; j < end; ++j) {
      const int count = s.begin[idx(j + 1)] - s.begin[idx(j)];
      target += count * (count - 1) / 2;
      if (count > 0) reach = std::max(reach, s.rows[idx(s.begin[idx(j + 1)] - 1)] + 1);
    }
    reach = std::max(reach, end);
  };
  for (int j = 0; j < s.size;) {
    int end = j + 1;
    while (end < s.size && end < j + kLongestRun && stride(end) == stride(j)) ++end;
    append(j, end, stride(j));
    j = end;
  }
}

/// A forest from its leaves inwards; empty where the pattern has a loop.
std::vector<int> from_leaves(const SparseMatrix& p) {
  const int n = static_cast<int>(p.rows());
  std::vector<int> degree(idx(n)), order;
  std::vector<bool> done(idx(n), false);
  order.reserve(idx(n));
  const auto neighbours = [&](int i, auto&& visit) {
    for (int s = p.outerIndexPtr()[i]; s < p.outerIndexPtr()[i + 1]; ++s)
      if (p.innerIndexPtr()[s] != i) visit(p.innerIndexPtr()[s]);
  };
  for (int i = 0; i < n; ++i) {
    neighbours(i, [&](int) { ++degree[idx(i)]; });
    if (degree[idx(i)] <= 1) order.push_back(i), done[idx(i)] = true;
  }
  for (std::size_t next = 0; next < order.size(); ++next)
    neighbours(order[next], [&](int i) {
      if (!done[idx(i)] && --degree[idx(i)] <= 1) order.push_back(i), done[idx(i)] = true;
    });
  if (static_cast<int>(order.size()) < n) order.clear();
  return order;
}

std::shared_ptr<const LowFillPattern> finish(const SparseMatrix& p, std::vector<int> order,
                                             Ordering ordering) {
  auto s = std::make_shared<LowFillPattern>();
  s->size = static_cast<int>(p.rows());
  s->ordering = ordering;
  s->order = std::move(order);
  const std::vector<int> place = inverse(s->order);
  if (!find_columns(p, place, *s)) return nullptr;
  find_slots(p, place, *s);
  if (std::count(s->diagonal.begin(), s->diagonal.end(), -1) > 0) return nullptr;
  find_runs(*s);
  s->outer.assign(p.outerIndexPtr(), p.outerIndexPtr() + s->size + 1);
  s->inner.assign(p.innerIndexPtr(), p.innerIndexPtr() + p.nonZeros());
  return s;
}

}  // namespace

bool LowFillPattern::same(const SparseMatrix& pattern) const {
  return pattern.rows() == size && pattern.isCompressed() &&
         static_cast<std::size_t>(pattern.nonZeros()) == inner.size() &&
         std::equal(outer.begin(), outer.end(), pattern.outerIndexPtr()) &&
         std::equal(inner.begin(), inner.end(), pattern.innerIndexPtr());
}

std::shared_ptr<const LowFillPattern> analyse_low_fill(const SparseMatrix& pattern) {
  std::vector<int> order = from_leaves(pattern);
  if (!order.empty()) return finish(pattern, std::move(order), Ordering::from_leaves);
  Ordering ordering = Ordering::natural;
  {
    CholmodFactor cholmod(true);  // gone before finish(): it holds several times what is asked of it
    if (cholmod.analyse(pattern) != FactorStatus::success) return nullptr;
    if (cholmod.factor().ordering != CHOLMOD_NATURAL) ordering = Ordering::amd;
    order = cholmod.order();
  }
  return finish(pattern, by_height(pattern, order), ordering);
}

namespace {

/// The arrays, bare.
struct View {
  const int *order, *begin, *rows, *target;
  double *d, *l, *y;
};

/// d and l hold A; after it 1/D and L. The first column that fails, whose pivot stays in d, or -1. On a chain
/// only D's recurrence is waited for: subtract, divide, multiply.
DREV_WIDEST int eliminate(const View& v, const Run& run, bool definite) {
  const auto fails = [definite](double d) { return definite ? !(d > 0.0) : !(d < 0.0 || d > 0.0); };
  if (run.stride == 0) {
    const int* target = v.target + run.first_target;
    for (int j = run.begin; j < run.end; ++j) {
      if (fails(v.d[j])) return j;
      const double inverse = v.d[j] = 1.0 / v.d[j];
      for (int a = v.begin[j]; a < v.begin[j + 1]; ++a) {
        const double whole = v.l[a], part = whole * inverse;
        v.d[v.rows[a]] -= part * whole;
        for (int b = a + 1; b < v.begin[j + 1]; ++b) v.l[*target++] -= part * v.l[b];
        v.l[a] = part;
      }
    }
    return -1;
  }
  double* l = v.l + v.begin[run.begin] - run.begin;
  int failed = -1;
  if (run.stride == 1) {
    double passed = 0.0;
    for (int j = run.begin; j < run.end; ++j) {
      const double d = v.d[j] -= passed;
      if (fails(d)) return j;
      const double inverse = v.d[j] = 1.0 / d;
      passed = l[j] * l[j] * inverse;
      l[j] *= inverse;
    }
    v.d[run.end] -= passed;
    return failed;
  }
  double passed[2] = {0.0, 0.0};
  int j = run.begin;
  for (; j + 1 < run.end; j += 2)
    for (int arm = 0; arm < 2; ++arm) {
      const double d = v.d[j + arm] -= passed[arm];
      if (fails(d)) return j + arm;
      const double inverse = v.d[j + arm] = 1.0 / d;
      passed[arm] = l[j + arm] * l[j + arm] * inverse;
      l[j + arm] *= inverse;
    }
  if (j < run.end) {
    const double d = v.d[j] -= passed[0];
    if (fails(d)) return j;
    const double inverse = v.d[j] = 1.0 / d;
    const double last = l[j] * l[j] * inverse;
    l[j] *= inverse;
    v.d[j + 1] -= passed[1];
    v.d[j + 2] -= last;
  } else {
    v.d[j] -= passed[0];
    v.d[j + 1] -= passed[1];
  }
  return failed;
}

DREV_WIDEST void solve_down(const View& v, const Run& run) {
  if (run.stride == 0) {
    for (int j = run.begin; j < run.end; ++j)
      for (int e = v.begin[j]; e < v.begin[j + 1]; ++e) v.y[v.rows[e]] -= v.l[e] * v.y[j];
    return;
  }
  const double* l = v.l + v.begin[run.begin] - run.begin;
  double* y = v.y;
  if (run.stride == 1) {
    double last = y[run.begin];
    for (int j = run.begin; j < run.end; ++j) y[j + 1] = last = y[j + 1] - l[j] * last;
    return;
  }
  double a = y[run.begin], b = y[run.begin + 1];
  int j = run.begin;
  for (; j + 1 < run.end; j += 2) {
    y[j + 2] = a = y[j + 2] - l[j] * a;
    y[j + 3] = b = y[j + 3] - l[j + 1] * b;
  }
  if (j < run.end) y[j + 2] -= l[j] * a;
}

/// x: null, or where the result goes in the order of the matrix.
DREV_WIDEST void solve_up(const View& v, const Run& run, double* x) {
  const double* l = v.l + v.begin[run.begin] - run.begin;
  double* y = v.y;
  const auto sweep = [&](auto&& put) {
    if (run.stride == 0) {
      for (int j = run.end - 1; j >= run.begin; --j) {
        double sum = y[j] * v.d[j];
        for (int e = v.begin[j]; e < v.begin[j + 1]; ++e) sum -= v.l[e] * y[v.rows[e]];
        put(j, sum);
      }
      return;
    }
    if (run.stride == 1) {
      double last = y[run.end];
      for (int j = run.end - 1; j >= run.begin; --j) put(j, last = y[j] * v.d[j] - l[j] * last);
      return;
    }
    double a = y[run.end + 1], b = y[run.end];
    int j = run.end - 1;
    for (; j > run.begin; j -= 2) {
      put(j, a = y[j] * v.d[j] - l[j] * a);
      put(j - 1, b = y[j - 1] * v.d[j - 1] - l[j - 1] * b);
    }
    if (j == run.begin) put(j, y[j] * v.d[j] - l[j] * a);
  };
  if (x)
    sweep([&](int j, double value) { y[j] = x[v.order[j]] = value; });
  else
    sweep([&](int j, double value) { y[j] = value; });
}

DREV_WIDEST void gather(const double* from, const int* index, std::size_t count, double* to) {
  for (std::size_t i = 0; i < count; ++i) to[i] = from[index[i]];
}

}  // namespace

LowFillFactor::LowFillFactor(std::shared_ptr<const LowFillPattern> pattern)
    : pattern_(std::move(pattern)), d_(pattern_->size), l_(static_cast<Eigen::Index>(pattern_->rows.size())) {
  prefer_huge_pages(d_);
  prefer_huge_pages(l_);
}

bool LowFillFactor::factorize(const Vector& values, bool definite) {
  const LowFillPattern& s = *pattern_;
  gather(values.data(), s.diagonal.data(), s.diagonal.size(), d_.data());
  for (std::size_t e = 0; e < s.slot.size(); ++e) l_.data()[e] = s.slot[e] < 0 ? 0.0 : values[s.slot[e]];
  const View v{s.order.data(), s.begin.data(), s.rows.data(), s.target.data(),
               d_.data(),      l_.data(),      y_.data()};
  failed_ = -1;
  for (const Run& run : s.runs)
    if (failed_ = eliminate(v, run, definite); failed_ >= 0) return false;
  if (!definite) return true;
  ratio_ = 1.0;
  worst_ = -1;
  for (int j = 0; j < s.size; ++j) {
    const double lost = d_[j] * values[s.diagonal[idx(j)]];  // A_jj / D_jj
    if (!(ratio_ * lost <= 1.0)) ratio_ = 1.0 / lost, worst_ = j;
  }
  return true;
}

void LowFillFactor::solve(const Vector& b, Vector& x) {
  const LowFillPattern& s = *pattern_;
  x.resize(s.size);
  y_.resize(s.size);
  const View v{s.order.data(), s.begin.data(), s.rows.data(), s.target.data(),
               d_.data(),      l_.data(),      y_.data()};
  int taken = 0;  // not further ahead than needed: it is still in the cache then
  for (const Run& run : s.runs) {
    if (run.reach > taken)
      gather(b.data(), s.order.data() + taken, idx(run.reach - taken), y_.data() + taken);
    taken = std::max(taken, run.reach);
    solve_down(v, run);
  }
  for (auto run = s.runs.rbegin(); run != s.runs.rend(); ++run) solve_up(v, *run, x.data());
}

void LowFillFactor::solve_in_order(const double* b, double* x) {
  const LowFillPattern& s = *pattern_;
  const View v{s.order.data(), s.begin.data(), s.rows.data(), s.target.data(), d_.data(), l_.data(), x};
  int taken = b == x ? s.size : 0;
  for (const Run& run : s.runs) {
    if (run.reach > taken) std::copy(b + taken, b + run.reach, x + taken);
    taken = std::max(taken, run.reach);
    solve_down(v, run);
  }
  for (auto run = s.runs.rbegin(); run != s.runs.rend(); ++run) solve_up(v, *run, nullptr);
}

void LowFillFactor::weigh(const Vector& weight) {
  const LowFillPattern& s = *pattern_;
  for (int j = 0; j < s.size; ++j) {
    const double w = weight[j];
    d_[j] /= w * w;
    for (int e = s.begin[idx(j)]; e < s.begin[idx(j + 1)]; ++e) l_[e] *= weight[s.rows[idx(e)]] / w;
  }
}

}  // namespace drev
