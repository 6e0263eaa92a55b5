#include "solvers/exact/series_kernels.hpp"

#include <drev/core/ids.hpp>

#include <algorithm>
#include <array>
#include <cstddef>

#include "solvers/exact/lane_pair.hpp"

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

struct Terms {
  template <class L>
  [[gnu::always_inline]] static void run(const SeriesRecursion* r, int first, int last, double* sizes) {
    const int stride = r->stride;
    const double *c_main = r->c_main, *w = r->inverse_mass;
    const DiagonalView *k = r->k.views, *c = r->c.views;
    for (int m = first; m <= last; ++m) {
      const double factor = r->factor(m), c_factor = r->damping_factor(m);
      const double* p = m - 2 <= r->p_degree ? column(r->p, stride, m - 2 - r->p_first) : r->zeros;
      const double *x_0 = column(r->z, stride, m - 2), *x_1 = column(r->z, stride, m - 1);
      double* next = r->z + static_cast<std::ptrdiff_t>(m) * stride;
      L largest{}, not_finite{};
      for (int i = 0, block = 0; i < stride; i += kLanes, ++block) {
        L sum, damping{}, a, b;
        load(p + i, sum);
        for (int d = r->k.begin[block]; d < r->k.begin[block + 1]; ++d) {
          load(k[d].values + i, a);
          load(x_0 + i + k[d].offset, b);
          sum -= a * b;
        }
        if (c_main != nullptr) {
          load(c_main + i, a);
          load(x_1 + i, b);
          damping = a * b;
        } else if (c != nullptr) {
          for (int d = r->c.begin[block]; d < r->c.begin[block + 1]; ++d) {
            load(c[d].values + i, a);
            load(x_1 + i + c[d].offset, b);
            damping += a * b;
          }
        }
        load(w + i, a);
        sum = (sum - c_factor * damping) * (factor * a);
        store(sum, next + i);
        not_finite += 0.0 * sum;  // comparisons drop a NaN
        magnitude(sum);
        raise(largest, sum);
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
  /// kBlocks: of lanes in a column, where that is known, so that loops over them are unrolled; 0: any number.
  template <class L, int kBlocks>
  [[gnu::always_inline]] static void terms(const SeriesRecursion* r, int first, int last, double* sizes) {
    const int stride = kBlocks > 0 ? kBlocks * kLanes : r->stride;
    const double *w = r->inverse_mass, *c_main = r->c_main;
    const bool whole_c = r->c_chain[1] != nullptr;
    for (int m = first; m <= last; ++m) {
      const double factor = r->factor(m), c_factor = r->damping_factor(m);
      const double* p = m - 2 <= r->p_degree ? column(r->p, stride, m - 2 - r->p_first) : r->zeros;
      const double *x_0 = column(r->z, stride, m - 2), *x_1 = column(r->z, stride, m - 1);
      double* next = r->z + static_cast<std::ptrdiff_t>(m) * stride;
      L largest{}, not_finite{}, before{}, x, behind{}, rate_before{}, rate, rate_behind{};
      load(x_0, x);
      load(x_1, rate);
#pragma GCC unroll 6
      for (int i = 0, block = 0; i < stride; i += kLanes, ++block) {
        const bool more = i + kLanes < stride;
        L up, down, sum, force;
        behind = L{};
        if (more) load(x_0 + i + kLanes, behind);
        move_up(before, x, up);
        move_down(x, behind, down);
        multiply(r->k_chain, i, up, x, down, sum);
        add_far(r->k, block, x_0, sum);
        load(p + i, force);
        force -= sum;
        if (whole_c) {
          rate_behind = L{};
          if (more) load(x_1 + i + kLanes, rate_behind);
          move_up(rate_before, rate, up);
          move_down(rate, rate_behind, down);
          multiply(r->c_chain, i, up, rate, down, sum);
          add_far(r->c, block, x_1, sum);
          force -= c_factor * sum;
          rate_before = rate;
          rate = rate_behind;
        } else if (c_main != nullptr) {
          L value;
          load(c_main + i, value);
          load(x_1 + i, rate);
          force -= c_factor * (value * rate);
        }
        load(w + i, sum);
        force *= factor * sum;
        store(force, next + i);
        not_finite += 0.0 * force;  // comparisons drop a NaN
        magnitude(force);
        raise(largest, force);
        before = x;
        x = behind;
      }
      sizes[m - first] = largest_of(largest) + sum_of(not_finite);
    }
  }
  template <class L>
  [[gnu::always_inline]] static void run(const SeriesRecursion* r, int first, int last, double* sizes) {
    switch (r->stride / kLanes) {
      case 1:
        return terms<L, 1>(r, first, last, sizes);
      case 2:
        return terms<L, 2>(r, first, last, sizes);
      case 3:
        return terms<L, 3>(r, first, last, sizes);
      case 4:
        return terms<L, 4>(r, first, last, sizes);
      case 5:
        return terms<L, 5>(r, first, last, sizes);
      case 6:
        return terms<L, 6>(r, first, last, sizes);
      default:
        return terms<L, 0>(r, first, last, sizes);
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
        L sum[kTogether] = {}, rate[kTogether] = {}, c;
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
  static constexpr int kTogether = 4;
  template <class L, int kCount>
  [[gnu::always_inline]] static void add(int stride, int count, const double* weight, const double* f,
                                         double* out) {
    L sum[kCount], x;
    for (int j = 0; j < kCount; ++j) load(out + j * stride, sum[j]);
    for (int q = 0; q < count; ++q) {
      load(column(f, stride, q), x);
      for (int j = 0; j < kCount; ++j) sum[j] += weight[j * count + q] * x;
    }
    for (int j = 0; j < kCount; ++j) store(sum[j], out + j * stride);
  }
  template <class L>
  [[gnu::always_inline]] static void run(int stride, int terms, int count, const double* weight,
                                         const double* f, double* out) {
    for (int i = 0; i < stride; i += kLanes) {
      int j = 0;
      for (; j + kTogether <= terms; j += kTogether)
        add<L, kTogether>(stride, count, weight + j * count, f + i, out + j * stride + i);
      for (; j < terms; ++j) add<L, 1>(stride, count, weight + j * count, f + i, out + j * stride + i);
    }
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

struct Ranges {
  template <class L>
  [[gnu::always_inline]] static void run(int stride, int degree, const double* z_0, double* end, double* size,
                                         double* bend) {
    for (int i = 0; i < stride; i += kLanes) {
      L sum{}, sizes{}, bends{}, x;
      for (int k = 1; k <= degree; ++k) {
        load(column(z_0, stride, k) + i, x);
        sum += x;
        magnitude(x);
        sizes += x;
        if (k > 1) bends += static_cast<double>(k) * x;
      }
      store(sum, end + i);
      store(sizes, size + i);
      store(bends, bend + i);
    }
  }
};

struct BeyondCubic {
  template <class L>
  [[gnu::always_inline]] static void run(int stride, int degree, const double* z_0, double s, double* z,
                                         double* v) {
    double weight[kMostTerms];
    double power = s * s * s * s;
    for (int k = 4; k <= degree; ++k, power *= s)
      weight[k] = k * (k - 1.0) * (k - 2.0) * (k - 3.0) / 384.0 * power;
    for (int i = 0; i < stride; i += kLanes) {
      L z_sum{}, v_sum{}, x;
      for (int k = 4; k <= degree; ++k) {
        load(column(z_0, stride, k) + i, x);
        magnitude(x);
        z_sum += weight[k] * x;
        v_sum += ((k - 4.0) * weight[k]) * x;
      }
      store(z_sum, z + i);
      store((1.0 / s) * v_sum, v + i);
    }
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
        L sum[kTogether] = {}, x;
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
        L row[kTogether] = {}, x;
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

void weighted_sums(int stride, int terms, int count, const double* weight, const double* f, double* out) {
  run_widest<Sums>(stride, terms, count, weight, f, out);
}

double weighted_squares(int stride, int terms, const double* factor, const double* c, const double* x,
                        int y_terms, const double* y) {
  return run_widest<Squares>(stride, terms, factor, c, x, y_terms, y);
}

void series_ranges(int stride, int degree, const double* z_0, double* end, double* size, double* bend) {
  run_widest<Ranges>(stride, degree, z_0, end, size, bend);
}

void series_beyond_cubic(int stride, int degree, const double* z_0, double s, double* z, double* v) {
  run_widest<BeyondCubic>(stride, degree, z_0, s, z, v);
}

double series_work(int stride, int degree, const double* z_0, int p_degree, const double* p, double s) {
  return run_widest<Work>(stride, degree, z_0, p_degree, p, s);
}

double series_product(int stride, int degree, const double* rates, const double* forces, const double* c_main,
                      double s) {
  return run_widest<Product>(stride, degree, rates, c_main != nullptr ? rates : forces, c_main, s);
}

}  // namespace drev
