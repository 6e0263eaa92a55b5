#include "solvers/exact/series_kernels.hpp"

#include <drev/core/ids.hpp>

#include <algorithm>
#include <array>
#include <cstddef>

#include "solvers/linear/lane_pair.hpp"

namespace drev {

namespace {
constexpr int kMostTerms = 128;  // of a product of two series

/// 1/k.
constexpr auto kInverse = [] {
  std::array<double, kMostTerms + 1> inverse{};
  for (std::size_t k = 1; k <= kMostTerms; ++k) inverse[k] = 1.0 / static_cast<double>(k);
  return inverse;
}();

[[gnu::always_inline]] inline const double* column(const double* first, int stride, int k) {
  return first + static_cast<std::ptrdiff_t>(k) * stride;
}

/// P_{m-2}; null: there is none.
[[gnu::always_inline]] inline const double* right_side(const SeriesRecursion& r, int m) {
  return m - 2 <= r.p_degree ? column(r.p, r.stride, m - 2 - r.p_first) : nullptr;
}

/// sum += mobility p.
template <class L>
[[gnu::always_inline]] inline void add_right_side(const double* mobility, const double* p, int i, L& sum) {
  if (p == nullptr) return;
  L force, w;
  load(p + i, force);
  load(mobility + i, w);
  sum += w * force;
}

/// Stores a term and notes its size.
template <class L>
[[gnu::always_inline]] inline void finish_term(L& term, double* to, L& largest, L& not_finite) {
  store(term, to);
  not_finite += 0.0 * term;  // comparisons drop a NaN
  magnitude(term);
  raise(largest, term);
}

struct Terms {
  template <class L>
  [[gnu::always_inline]] static void run(const SeriesRecursion* recursion, int first, int last,
                                         double* sizes) {
    const SeriesRecursion r = *recursion;  // a copy, which stores to columns cannot change
    const int stride = r.stride;
    const double* c_main = r.c_main;
    const DiagonalView *k = r.k.views, *c = r.c.views;
    for (int m = first; m <= last; ++m) {
      const double factor = r.factor(m), c_factor = r.damping_factor(m);
      const double *x_0 = column(r.z, stride, m - 2), *x_1 = column(r.z, stride, m - 1);
      double* next = r.z + static_cast<std::ptrdiff_t>(m) * stride;
      const double* p = right_side(r, m);
      L largest{}, not_finite{};
      for (int i = 0, block = 0; i < stride; i += kLanes, ++block) {
        L sum{}, damping{}, a, b;
        for (int d = r.k.begin[block]; d < r.k.begin[block + 1]; ++d) {
          load(k[d].values + i, a);
          load(x_0 + i + k[d].offset, b);
          sum += a * b;
        }
        if (c_main != nullptr) {
          load(c_main + i, a);
          load(x_1 + i, b);
          damping = a * b;
        } else if (c != nullptr) {
          for (int d = r.c.begin[block]; d < r.c.begin[block + 1]; ++d) {
            load(c[d].values + i, a);
            load(x_1 + i + c[d].offset, b);
            damping += a * b;
          }
        }
        add_right_side(r.mobility, p, i, sum);
        sum = factor * (sum + c_factor * damping);
        finish_term(sum, next + i, largest, not_finite);
      }
      sizes[m - first] = largest_of(largest) + sum_of(not_finite);
    }
  }
};

/// The same where K and C have their entries on the main diagonal and beside it, with a few elsewhere (k.views, c.views): the
/// neighbours come from the lanes beside, so that no load overlaps what was stored just before.
struct ChainTerms {
  /// sum = a x, a's diagonals below, on and above the main one.
  template <class L>
  [[gnu::always_inline]] static void multiply(const std::array<const double*, 3>& a, int i, const L& up,
                                              const L& x, const L& down, L& sum) {
    L value;
    load(a[1] + i, value);
    sum = value * x;
    load(a[0] + i, value);
    sum += value * up;
    load(a[2] + i, value);
    sum += value * down;
  }
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
  /// kBlocks: of lanes in a column, where that is known, so that loops over them are unrolled; 0: any number. kPlain: no
  /// entries are elsewhere, and C has its main diagonal alone.
  template <class L, int kBlocks, bool kPlain>
  [[gnu::always_inline]] static void terms(const SeriesRecursion* recursion, int first, int last,
                                           double* sizes) {
    const SeriesRecursion r = *recursion;  // a copy, which stores to columns cannot change
    const int stride = kBlocks > 0 ? kBlocks * kLanes : r.stride;
    const double* c_main = r.c_main;
    const bool whole_c = !kPlain && r.c_chain[1] != nullptr;
    for (int m = first; m <= last; ++m) {
      const double factor = r.factor(m), c_factor = r.damping_factor(m);
      const double *x_0 = column(r.z, stride, m - 2), *x_1 = column(r.z, stride, m - 1);
      double* next = r.z + static_cast<std::ptrdiff_t>(m) * stride;
      const double* p = right_side(r, m);
      L largest{}, not_finite{}, before{}, x, behind{}, rate_before{}, rate, rate_behind{};
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
        multiply(r.k_chain, i, up, x, down, sum);
        if constexpr (!kPlain) add_far(r.k, block, x_0, sum);
        if (whole_c) {
          L damping;
          rate_behind = L{};
          if (more) load(x_1 + i + kLanes, rate_behind);
          move_up(rate_before, rate, up);
          move_down(rate, rate_behind, down);
          multiply(r.c_chain, i, up, rate, down, damping);
          add_far(r.c, block, x_1, damping);
          sum += c_factor * damping;
          rate_before = rate;
          rate = rate_behind;
        } else if (kPlain || c_main != nullptr) {
          L value;
          load(c_main + i, value);
          load(x_1 + i, rate);
          sum += (c_factor * value) * rate;
        }
        add_right_side(r.mobility, p, i, sum);
        sum = factor * sum;
        finish_term(sum, next + i, largest, not_finite);
        before = x;
        x = behind;
      }
      sizes[m - first] = largest_of(largest) + sum_of(not_finite);
    }
  }
  template <class L, int kBlocks>
  [[gnu::always_inline]] static void of_size(const SeriesRecursion* r, int first, int last, double* sizes) {
    const bool plain = r->k.begin[r->stride / kLanes] == 0 && r->c_main != nullptr;
    if (plain)
      terms<L, kBlocks, true>(r, first, last, sizes);
    else
      terms<L, kBlocks, false>(r, first, last, sizes);
  }
  template <class L>
  [[gnu::always_inline]] static void run(const SeriesRecursion* r, int first, int last, double* sizes) {
    switch (r->stride / kLanes) {
      case 1:
        return of_size<L, 1>(r, first, last, sizes);
      case 2:
        return of_size<L, 2>(r, first, last, sizes);
      case 3:
        return of_size<L, 3>(r, first, last, sizes);
      case 4:
        return of_size<L, 4>(r, first, last, sizes);
      case 5:
        return of_size<L, 5>(r, first, last, sizes);
      case 6:
        return of_size<L, 6>(r, first, last, sizes);
      default:
        return of_size<L, 0>(r, first, last, sizes);
    }
  }
};

struct ScaledProduct {
  template <class L>
  [[gnu::always_inline]] static void run(int stride, double factor, const double* a, const double* b,
                                         double* out) {
    for (int i = 0; i < stride; i += kLanes) {
      L x, y;
      load(a + i, x);
      load(b + i, y);
      store((factor * x) * y, out + i);
    }
  }
};

struct Values {
  template <class L>
  [[gnu::always_inline]] static void run(int stride, int degree, const double* z_0, double s, double* z,
                                         double* v) {
    for (int i = 0; i < stride; i += kLanes) {
      L z_sum{}, v_sum{}, c;
      for (int k = degree; k >= 0; --k) {
        load(column(z_0, stride, k) + i, c);
        v_sum = v_sum * s + z_sum;
        z_sum = z_sum * s + c;
      }
      store(z_sum, z + i);
      store(v_sum, v + i);
    }
  }
};

struct AtNodes {
  static constexpr int kTogether = 4;
  template <class L>
  [[gnu::always_inline]] static void run(int stride, int degree, const double* z_0, const double* s,
                                         int count, double* z, double* v) {
    for (int i = 0; i < stride; i += kLanes)
      for (int q = 0; q < count; q += kTogether) {
        L sum[kTogether], rate[kTogether], c;
        clear(sum);
        clear(rate);
        for (int k = degree; k >= 0; --k) {
          load(column(z_0, stride, k) + i, c);
          for (int n = 0; n < kTogether; ++n) sum[n] = sum[n] * s[q + n] + c;
        }
        for (int n = 0; n < kTogether; ++n) store(sum[n], z + (q + n) * stride + i);
        if (v == nullptr) continue;
        for (int k = degree; k >= 1; --k) {
          load(column(z_0, stride, k) + i, c);
          c = static_cast<double>(k) * c;
          for (int n = 0; n < kTogether; ++n) rate[n] = rate[n] * s[q + n] + c;
        }
        for (int n = 0; n < kTogether; ++n) store(rate[n], v + (q + n) * stride + i);
      }
  }
};

struct Polynomial {
  template <class L>
  [[gnu::always_inline]] static void run(int count, int terms, const double* c, const double* x,
                                         double* value, double* slope) {
    for (int i = 0; i < count; i += kLanes) {
      L at, sum{}, rate{};
      load(x + i, at);
      for (int k = terms; k-- > 0;) {
        rate = rate * at + sum;
        sum = sum * at + c[k];
      }
      store(sum, value + i);
      store(rate, slope + i);
    }
  }
};

struct Sums {
  static constexpr int kTogether = 5;  // of sums, which stay in registers
  template <class L, int kCount, bool kSizes>
  [[gnu::always_inline]] static void some(int stride, int count, int per_column, const double* weight,
                                          const double* f, double* out, bool add) {
    L sum[kCount], x;
    clear(sum);
    if (add)
      for (int j = 0; j < kCount; ++j) load(out + j * stride, sum[j]);
    for (int q = 0; q < count; ++q, weight += per_column, f += stride) {
      load(f, x);
      if constexpr (kSizes) magnitude(x);
      for (int j = 0; j < kCount; ++j) sum[j] += weight[j] * x;
    }
    for (int j = 0; j < kCount; ++j) store(sum[j], out + j * stride);
  }
  template <class L, bool kSizes>
  [[gnu::always_inline]] static void all(int stride, int first, int last, int count, int per_column,
                                         const double* weight, const double* f, double* out, bool add) {
    for (int j = first; j < last; j += kTogether) {
      const double* w = weight + j;
      double* to = out + j * stride;
      switch (std::min(last - j, kTogether)) {
        case 1:
          some<L, 1, kSizes>(stride, count, per_column, w, f, to, add);
          break;
        case 2:
          some<L, 2, kSizes>(stride, count, per_column, w, f, to, add);
          break;
        case 3:
          some<L, 3, kSizes>(stride, count, per_column, w, f, to, add);
          break;
        case 4:
          some<L, 4, kSizes>(stride, count, per_column, w, f, to, add);
          break;
        default:
          some<L, kTogether, kSizes>(stride, count, per_column, w, f, to, add);
      }
    }
  }
  template <class L>
  [[gnu::always_inline]] static void run(int stride, int terms, int sizes, int count, const double* weight,
                                         const double* f, double* out, bool add) {
    const int together = terms + sizes;
    for (int i = 0; i < stride; i += kLanes) {
      all<L, false>(stride, 0, terms, count, together, weight, f + i, out + i, add);
      all<L, true>(stride, terms, together, count, together, weight, f + i, out + i, add);
    }
  }
};

struct MomentWork {
  template <class L>
  [[gnu::always_inline]] static double run(int stride, const double* p, const double* b, double s) {
    const double first = 0.5 * s, second = s * s / 6.0;
    L total{};
    for (int i = 0; i < stride; i += kLanes) {
      L b_0, b_1, b_2, x;
      load(b + i, b_0);
      load(b + stride + i, b_1);
      load(b + 2 * stride + i, b_2);
      load(p + i, x);
      total += x * b_0;
      load(p + stride + i, x);
      total += x * (first * (b_0 + b_1));
      load(p + 2 * stride + i, x);
      total += x * (second * (2.0 * b_0 + 3.0 * b_1 + b_2));
    }
    return sum_of(total);
  }
};

struct Squares {
  template <class L>
  [[gnu::always_inline]] static double run(int stride, int terms, const double* factor, const double* c,
                                           const double* x, int y_terms, const double* y) {
    L total{};
    for (int i = 0; i < stride; i += kLanes) {
      L sum{}, a, b;
      for (int k = 0; k < terms; ++k) {
        load(column(x, stride, k) + i, a);
        if (k < y_terms) {
          load(column(y, stride, k) + i, b);
          a += b;
        }
        sum += factor[k] * (a * a);
      }
      load(c + i, a);
      total += a * sum;
    }
    return sum_of(total);
  }
};

struct Work {
  /// So many degrees of P at once: sums that do not wait for each other.
  static constexpr int kTogether = 4;
  template <class L>
  [[gnu::always_inline]] static double run(int stride, int degree, const double* z_0, int p_degree,
                                           const double* p, double s) {
    double weight[kMostTerms];  // s^k/k
    double power = s;
    for (int k = 1; k < degree + p_degree + kTogether; ++k, power *= s) weight[k] = power * kInverse[idx(k)];
    L total{};
    for (int k = 0; k <= p_degree; k += kTogether) {
      const int together = std::min(kTogether, p_degree + 1 - k);
      double parts[kTogether * kMostTerms];
      for (int m = 1; m <= degree; ++m)
        for (int q = 0; q < kTogether; ++q) parts[m * kTogether + q] = m * weight[k + q + m];
      for (int i = 0; i < stride; i += kLanes) {
        L sum[kTogether], x;
        clear(sum);
        for (int m = 1; m <= degree; ++m) {
          load(column(z_0, stride, m) + i, x);
          for (int q = 0; q < kTogether; ++q) sum[q] += parts[m * kTogether + q] * x;
        }
        for (int q = 0; q < together; ++q) {
          load(column(p, stride, k + q) + i, x);
          total += sum[q] * x;
        }
      }
    }
    return sum_of(total);
  }
};

struct Product {
  static constexpr int kTogether = 4;  // as in Work
  template <class L>
  [[gnu::always_inline]] static double run(int stride, int degree, const double* rates, const double* forces,
                                           const double* c_main, double s) {
    double once[kMostTerms], twice[kMostTerms];
    double power = s;
    for (int k = 0; k < 2 * degree + kTogether; ++k, power *= s) {
      once[k] = power * kInverse[idx(k + 1)];
      twice[k] = 2.0 * once[k];
    }
    L total{};
    for (int i = 0; i < stride; i += kLanes) {
      L block{};
      for (int j = 0; j < degree; j += kTogether) {
        L row[kTogether], x;
        clear(row);
        const int together = std::min(kTogether, degree - j);
        // C is symmetric: each pair once.
        for (int k = 0; k < j; ++k) {
          load(column(forces, stride, k) + i, x);
          for (int q = 0; q < kTogether; ++q) row[q] += twice[j + q + k] * x;
        }
        for (int k = j; k < j + together; ++k) {
          load(column(forces, stride, k) + i, x);
          for (int q = 0; q < kTogether; ++q) row[q] += once[j + q + k] * x;
        }
        for (int q = 0; q < together; ++q) {
          load(column(rates, stride, j + q) + i, x);
          block += row[q] * x;
        }
      }
      L c;
      if (c_main != nullptr) {
        load(c_main + i, c);
        block *= c;
      }
      total += block;
    }
    return sum_of(total);
  }
};

}  // namespace

void series_terms(const SeriesRecursion& recursion, int first, int last, double* sizes) {
  if (recursion.k_chain[1] != nullptr)
    run_widest<ChainTerms>(&recursion, first, last, sizes);
  else
    run_widest<Terms>(&recursion, first, last, sizes);
}

void scaled_product(int stride, double factor, const double* a, const double* b, double* out) {
  run_widest<ScaledProduct>(stride, factor, a, b, out);
}

void series_values(int stride, int degree, const double* z_0, double s, double* z, double* v) {
  run_widest<Values>(stride, degree, z_0, s, z, v);
}

void series_at_nodes(int stride, int degree, const double* z_0, const double* s, int count, double* z,
                     double* v) {
  run_widest<AtNodes>(stride, degree, z_0, s, count, z, v);
}

void polynomial_values(int count, int terms, const double* c, const double* x, double* value, double* slope) {
  run_widest<Polynomial>(count, terms, c, x, value, slope);
}

void weighted_sums(int stride, int terms, int sizes, int count, const double* weight, const double* f,
                   double* out, bool add) {
  run_widest<Sums>(stride, terms, sizes, count, weight, f, out, add);
}

double work_of_moments(int stride, const double* p, const double* b, double s) {
  return run_widest<MomentWork>(stride, p, b, s);
}

double weighted_squares(int stride, int terms, const double* factor, const double* c, const double* x,
                        int y_terms, const double* y) {
  return run_widest<Squares>(stride, terms, factor, c, x, y_terms, y);
}

double series_work(int stride, int degree, const double* z_0, int p_degree, const double* p, double s) {
  return run_widest<Work>(stride, degree, z_0, p_degree, p, s);
}

double series_product(int stride, int degree, const double* rates, const double* forces, const double* c_main,
                      double s) {
  return run_widest<Product>(stride, degree, rates, c_main != nullptr ? rates : forces, c_main, s);
}

}  // namespace drev
