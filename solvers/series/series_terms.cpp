// The terms of a series, degree by degree.
#include <drev/core/ids.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstring>
#include <type_traits>

#include "solvers/linear/lane_pair.hpp"
#include "solvers/series/series_kernels.hpp"

namespace drev {

namespace {

template <class Double>
[[gnu::always_inline]] inline Double* term_of(Double* first, int stride, int k) {
  return first + static_cast<std::ptrdiff_t>(k) * stride;
}

/// The next term is loaded from memory: a whole one has no room in registers, and GCC 12 would write it to its stack a second time.
[[gnu::always_inline]] inline void end_term() { std::atomic_signal_fence(std::memory_order_seq_cst); }

/// Runs Body::term<L, kForces>(m, p, largest) for the terms first ... last, where p is P_{m-2} if there is one (kForces). Of a
/// series with their sizes; of a sweep (derivatives), whose terms tell nothing by their sizes, without.
template <class L, class Body>
[[gnu::always_inline]] inline void all_terms(Body&& body, int first, int last, double* sizes) {
  constexpr bool kSweep = std::remove_reference_t<Body>::kSweep;
  const SeriesRecursion& r = body.r;
  const auto size = [&](int m) -> double& { return sizes[m - first]; };
  bool changed = false;
  const auto finish = [&](int m, L& largest) __attribute__((always_inline)) {
    end_term();
    if constexpr (kSweep) return;
    if (r.hook.add != nullptr && r.hook.add(r.hook.of, m, term_of(r.z, r.stride, m))) {
      body.take_back(m);
      changed = true;
    }
    size(m) = largest_of(largest);
  };
  int m = first;
  for (const int with = std::min(last, r.p_degree + 2); m <= with; ++m) {
    L largest{};
    body.template term<L, true>(m, term_of(r.p, r.stride, m - 2 - r.p_first), largest);
    finish(m, largest);
  }
  for (; m <= last; ++m) {
    L largest{};
    body.template term<L, false>(m, nullptr, largest);
    finish(m, largest);
  }
  if constexpr (!kSweep) {
    // Only now: a load of lanes of which one was just stored would have to wait for it.
    for (m = first; changed && m <= last; ++m) {
      L largest{}, x;
      for (int i = 0; i < r.stride; i += kLanes) {
        load(term_of(r.z, r.stride, m) + i, x);
        magnitude(x);
        raise(largest, x);
      }
      size(m) = largest_of(largest);
    }
    // Comparisons drop a NaN, but what is not finite in one term stays so in those behind it.
    for (m = last > first ? last - 1 : last; m <= last; ++m) {
      L not_finite{}, x;
      for (int i = 0; i < r.stride; i += kLanes) {
        load(term_of(r.z, r.stride, m) + i, x);
        not_finite += 0.0 * x;
      }
      size(m) += sum_of(not_finite);
    }
  }
}

/// Stores a term and notes its size.
template <bool kSweep, class L>
[[gnu::always_inline]] inline void finish_term(L& term, double* to, L& largest) {
  store(term, to);
  if constexpr (!kSweep) {
    magnitude(term);
    raise(largest, term);
  }
}

/// sum += mobility p; a sweep leaves p zero.
template <bool kSweep, class L>
[[gnu::always_inline]] inline void add_right_side(const double* mobility, double* p, int i, L& sum) {
  L force, w;
  load(p + i, force);
  load(mobility + i, w);
  sum += w * force;
  if constexpr (kSweep) store(L{}, p + i);
}

/// Terms where K and C have any diagonals.
template <bool kOfSweep>
struct Diagonals {
  static constexpr bool kSweep = kOfSweep;
  const SeriesRecursion r;  // a copy, which stores to columns cannot change
  static void take_back(int) {}
  template <class L, bool kForces>
  [[gnu::always_inline]] void term(int m, double* p, L& largest) const {
    const double factor = r.factor(m), c_factor = r.damping_factor(m);
    const double *x_0 = term_of(r.z, r.stride, m - 2), *x_1 = term_of(r.z, r.stride, m - 1);
    double* next = r.z + static_cast<std::ptrdiff_t>(m) * r.stride;
    const DiagonalView *k = r.k.views, *c = r.c.views;
    for (int i = 0, block = 0; i < r.stride; i += kLanes, ++block) {
      L sum{}, damping{}, a, b;
      for (int d = r.k.begin[block]; d < r.k.begin[block + 1]; ++d) {
        load(k[d].values + i, a);
        load(x_0 + i + k[d].offset, b);
        sum += a * b;
      }
      if (r.c_main != nullptr) {
        load(r.c_main + i, a);
        load(x_1 + i, b);
        damping = a * b;
      } else if (c != nullptr) {
        for (int d = r.c.begin[block]; d < r.c.begin[block + 1]; ++d) {
          load(c[d].values + i, a);
          load(x_1 + i + c[d].offset, b);
          damping += a * b;
        }
      }
      if constexpr (kForces) add_right_side<kSweep>(r.mobility, p, i, sum);
      sum = factor * (sum + c_factor * damping);
      finish_term<kSweep>(sum, next + i, largest);
    }
  }
  template <class L>
  [[gnu::always_inline]] static void run(const SeriesRecursion* recursion, int first, int last,
                                         double* sizes) {
    all_terms<L>(Diagonals{*recursion}, first, last, sizes);
  }
};

/// sum = a x, a's diagonals below, on and above the main one.
template <class L>
[[gnu::always_inline]] inline void multiply_chain(const std::array<const double*, 3>& a, int i, const L& up,
                                                  const L& x, const L& down, L& sum) {
  L value;
  load(a[1] + i, value);
  sum = value * x;
  load(a[0] + i, value);
  sum += value * up;
  load(a[2] + i, value);
  sum += value * down;
}

/// What a chain has beside its neighbours' entries: nothing, and C has its main diagonal alone; the same with one entry in a block of
/// lanes at most; or any.
enum class Beside { nothing, single_entries, any };

/// Terms where K and C have their entries on the main diagonal and beside it, with a few elsewhere (k.views, c.views): the
/// neighbours come from the lanes beside, so that no load overlaps what was stored just before. kBlocks: of lanes in a column,
/// where that is known, so that loops over them are unrolled; 0: any number.
template <bool kOfSweep, int kBlocks, Beside kBeside>
struct Chain {
  static constexpr bool kSweep = kOfSweep;
  static constexpr bool kMainDamping = kBeside != Beside::any;
  const SeriesRecursion r;                        // a copy, which stores to columns cannot change
  std::array<DiagonalView, kBlocks> single = {};  // values null: none in the block
  explicit Chain(const SeriesRecursion& recursion) : r(recursion) {
    if constexpr (kBeside == Beside::single_entries)
      for (int b = 0; b < kBlocks; ++b)
        if (const DiagonalView* view = r.k.views + r.k.begin[b]; r.k.begin[b + 1] > r.k.begin[b])
          single[idx(b)] = {b * kLanes + view->offset, view->values + b * kLanes, view->only};
  }
  static void take_back(int) {}
  /// sum += the entries elsewhere.
  template <class L>
  [[gnu::always_inline]] static void add_far(const BlockDiagonals& far, int block, const double* x, L& sum) {
    for (int d = far.begin[block]; d < far.begin[block + 1]; ++d) {
      L a, b;
      load(far.views[d].values + block * kLanes, a);
      load(x + block * kLanes + far.views[d].offset, b);
      sum += a * b;
    }
  }
  template <class L, bool kForces>
  [[gnu::always_inline]] void term(int m, double* p, L& largest) const {
    const int stride = kBlocks > 0 ? kBlocks * kLanes : r.stride;
    const double factor = kSweep ? 1.0 : r.factor(m), c_factor = kSweep ? 1.0 : r.damping_factor(m);
    const double *x_0 = term_of(r.z, stride, m - 2), *x_1 = term_of(r.z, stride, m - 1);
    double* next = r.z + static_cast<std::ptrdiff_t>(m) * stride;
    const bool whole_c = !kMainDamping && r.c_chain[1] != nullptr;
    L before{}, x, behind{}, rate_before{}, rate, rate_behind{};
    load(x_0, x);
    load(x_1, rate);
#pragma GCC unroll 6
    for (int i = 0, block = 0; i < stride; i += kLanes, ++block) {
      const bool more = i + kLanes < stride;
      L up, down, sum;
      behind = L{};
      if (more) load(x_0 + i + kLanes, behind);
      move_up(before, x, up);
      move_down(x, behind, down);
      multiply_chain(r.k_chain, i, up, x, down, sum);
      if constexpr (kBeside == Beside::any) add_far(r.k, block, x_0, sum);
      if constexpr (kBeside == Beside::single_entries)
        if (const DiagonalView& view = single[idx(block)]; view.values != nullptr) {
          L a, b;
          load(view.values, a);
          load(x_0 + view.offset, b);
          sum += a * b;
        }
      if (whole_c) {
        L damping;
        rate_behind = L{};
        if (more) load(x_1 + i + kLanes, rate_behind);
        move_up(rate_before, rate, up);
        move_down(rate, rate_behind, down);
        multiply_chain(r.c_chain, i, up, rate, down, damping);
        add_far(r.c, block, x_1, damping);
        sum += c_factor * damping;
        rate_before = rate;
        rate = rate_behind;
      } else if (kMainDamping || r.c_main != nullptr) {
        L value;
        load(r.c_main + i, value);
        load(x_1 + i, rate);
        if constexpr (!kSweep) value = c_factor * value;
        sum += value * rate;
      }
      if constexpr (kForces) add_right_side<kSweep>(r.mobility, p, i, sum);
      if constexpr (!kSweep) sum = factor * sum;
      finish_term<kSweep>(sum, next + i, largest);
      before = x;
      x = behind;
    }
  }
};

/// The same of so few blocks that two terms stay in registers of 64 bytes: to load all that a term needs would take longer than its
/// sums. Of a sweep with packed forces, whose first terms nobody wants to keep.
template <bool kOfSweep, int kBlocks, Beside kBeside, class L>
struct ShortChain {
  static constexpr bool kSweep = kOfSweep;
  const SeriesRecursion r;           // a copy, which stores to columns cannot change
  L older[kBlocks], newer[kBlocks];  // the last two terms
  ShortChain(const SeriesRecursion& recursion, int first) : r(recursion) {
    take(first - 2, older);
    take(first - 1, newer);
  }
  /// Where term m is put: those that are not kept into kTurns columns in turn, where these lie ahead of all that are.
  static constexpr int kTurns = 4;
  [[gnu::always_inline]] double* place(int m) const {
    if constexpr (kSweep)
      if (m >= 2 && m < r.first_kept && r.first_kept >= 2 + kTurns) m = 2 + m % kTurns;
    return term_of(r.z, kBlocks * kLanes, m);
  }
  [[gnu::always_inline]] void take(int m, L (&term)[kBlocks]) const {
#pragma GCC unroll 6
    for (int b = 0; b < kBlocks; ++b) load(place(m) + b * kLanes, term[b]);
  }
  /// Term m, the last one, was changed in memory.
  [[gnu::always_inline]] void take_back(int m) { take(m, newer); }
  /// sum += mobility P_{m-2}.
  [[gnu::always_inline]] void add_forces(int i, const double* p, const L& low, const L& high, L& sum) const {
    L force, w;
    if constexpr (kSweep) {
      LaneMask from;
      std::memcpy(&from, r.packed.from + i, sizeof from);
      pick(low, high, from, force);
    } else {
      load(p + i, force);
    }
    load(r.mobility + i, w);
    sum += w * force;
  }
  template <class, bool kForces>
  [[gnu::always_inline]] void term(int m, const double* p, L& largest) {
    const double factor = kSweep ? 1.0 : r.factor(m), c_factor = kSweep ? 1.0 : r.damping_factor(m);
    double* next = place(m);
    const double* x_0 = place(m - 2);
    L low{}, high{};
    if constexpr (kForces && kSweep) {
      load(r.packed.values - (m - 2) * r.packed.step, low);
      if (r.packed.step > kLanes) load(r.packed.values - (m - 2) * r.packed.step + kLanes, high);
    }
    L before{};
#pragma GCC unroll 6
    for (int b = 0; b < kBlocks; ++b) {
      const int i = b * kLanes;
      L up, down, sum, value;
      move_up(before, older[b], up);
      move_down(older[b], b + 1 < kBlocks ? older[(b + 1) % kBlocks] : L{}, down);
      multiply_chain(r.k_chain, i, up, older[b], down, sum);
      // One by one: a load of lanes would overlap what was stored just before.
      if constexpr (kBeside == Beside::single_entries)
        for (int d = r.k.begin[b]; d < r.k.begin[b + 1]; ++d) {
          load(r.k.views[d].values + i, value);
          sum += x_0[r.k.views[d].only] * value;
        }
      load(r.c_main + i, value);
      if constexpr (!kSweep) value = c_factor * value;
      sum += value * newer[b];
      if constexpr (kForces) add_forces(i, p, low, high, sum);
      if constexpr (!kSweep) sum = factor * sum;
      before = older[b];
      older[b] = newer[b];
      newer[b] = sum;
      finish_term<kSweep>(sum, next + i, largest);
    }
  }
};
template <bool kSweep, int kBlocks, Beside kBeside>
struct ChainTerms {
  template <class L>
  [[gnu::always_inline]] static void run(const SeriesRecursion* recursion, int first, int last,
                                         double* sizes) {
    if constexpr (kBlocks > 0 && kBeside != Beside::any && !std::is_same_v<L, LanePair>)
      if (!kSweep || recursion->packed.values != nullptr)
        return all_terms<L>(ShortChain<kSweep, kBlocks, kBeside, L>(*recursion, first), first, last, sizes);
    all_terms<L>(Chain<kSweep, kBlocks, kBeside>(*recursion), first, last, sizes);
  }
};

constexpr int kMostBlocks = 6;  // of lanes in a column, over which loops are unrolled

Beside beside_chain(const SeriesRecursion& r) {
  if (r.c_main == nullptr) return Beside::any;
  if (r.k.begin[r.stride / kLanes] == 0) return Beside::nothing;
  return r.k.single && r.stride <= kMostBlocks * kLanes ? Beside::single_entries : Beside::any;
}

template <bool kSweep, int kBlocks>
void run_chain(const SeriesRecursion* r, int first, int last, double* sizes) {
  switch (beside_chain(*r)) {
    case Beside::nothing:
      return run_widest<ChainTerms<kSweep, kBlocks, Beside::nothing>>(r, first, last, sizes);
    case Beside::single_entries:
      if constexpr (kBlocks > 0)
        return run_widest<ChainTerms<kSweep, kBlocks, Beside::single_entries>>(r, first, last, sizes);
      [[fallthrough]];
    case Beside::any:
      run_widest<ChainTerms<kSweep, kBlocks, Beside::any>>(r, first, last, sizes);
  }
}

template <bool kSweep>
void run_terms(const SeriesRecursion* r, int first, int last, double* sizes) {
  if (r->k_chain[1] == nullptr) return run_widest<Diagonals<kSweep>>(r, first, last, sizes);
  switch (r->stride / kLanes) {
    case 1:
      return run_chain<kSweep, 1>(r, first, last, sizes);
    case 2:
      return run_chain<kSweep, 2>(r, first, last, sizes);
    case 3:
      return run_chain<kSweep, 3>(r, first, last, sizes);
    case 4:
      return run_chain<kSweep, 4>(r, first, last, sizes);
    case 5:
      return run_chain<kSweep, 5>(r, first, last, sizes);
    case kMostBlocks:
      return run_chain<kSweep, kMostBlocks>(r, first, last, sizes);
    default:
      return run_chain<kSweep, 0>(r, first, last, sizes);
  }
}

}  // namespace

bool takes_packed_forces(const SeriesRecursion& r) {
  return lanes_fill_a_register() && r.k_chain[1] != nullptr && r.stride <= kMostBlocks * kLanes &&
         beside_chain(r) != Beside::any;
}

void series_terms(const SeriesRecursion& recursion, int first, int last, double* sizes) {
  if (recursion.derivatives)
    run_terms<true>(&recursion, first, last, nullptr);
  else
    run_terms<false>(&recursion, first, last, sizes);
}

}  // namespace drev
