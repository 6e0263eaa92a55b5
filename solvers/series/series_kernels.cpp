#include "solvers/series/series_kernels.hpp"

#include <drev/core/ids.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "solvers/linear/lane_pair.hpp"

namespace drev {

namespace {
constexpr int kMostTerms =
    static_cast<int>(kInverse.size()) - 1;  // of a series, and of what it is multiplied with

[[gnu::always_inline]] inline const double* column(const double* first, int stride, int k) {
  return first + static_cast<std::ptrdiff_t>(k) * stride;
}

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

struct Slopes {
  template <class L>
  [[gnu::always_inline]] static double run(int stride, const double* slope, const double* mobility,
                                           double* main) {
    L most{};
    for (int i = 0; i < stride; i += kLanes) {
      L x, y;
      load(slope + i, x);
      load(main + i, y);
      store(y - x, main + i);
      load(mobility + i, y);
      magnitude(x);
      raise(most, x * y);
    }
    return largest_of(most);
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

/// 0, 1, 1, 1, ... and 0, 0, 2, 3, ..., in whole lanes.
constexpr int kRowTerms = 64;
constexpr auto kFromFirst = [] {
  std::array<std::array<double, kRowTerms>, 2> weight{};
  for (std::size_t k = 1; k < kRowTerms; ++k) weight[0][k] = 1.0;
  for (std::size_t k = 2; k < kRowTerms; ++k) weight[1][k] = static_cast<double>(k);
  return weight;
}();

struct RowTerms {
  template <class L>
  [[gnu::always_inline]] static void run(int stride, int terms, const double* z_0, const Entry* row,
                                         int entries, double* x, double* sums) {
    for (int e = 0; e < entries; ++e) {
      const double coeff = row[e].coeff, *__restrict term = z_0 + row[e].index;
      double* __restrict sum = x;
      for (int k = 0; k < terms; ++k, term += stride) sum[k] += coeff * *term;
    }
    L reach{}, rate_reach{}, term, weight;
    for (int k = 0; k < terms; k += kLanes) {
      load(x + k, term);
      magnitude(term);
      load(kFromFirst[0].data() + k, weight);
      reach += weight * term;
      load(kFromFirst[1].data() + k, weight);
      rate_reach += weight * term;
    }
    sums[0] = sum_of(reach);
    sums[1] = sum_of(rate_reach);
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

/// k!/(k - i)! by k, then by i <= kDerivatives.
constexpr auto kFallingFactorial = [] {
  std::array<std::array<double, kLanes>, kRowTerms> factor{};
  for (std::size_t k = 0; k < kRowTerms; ++k) {
    factor[k][0] = 1.0;
    for (std::size_t i = 1; i <= kDerivatives && i <= k; ++i)
      factor[k][i] = factor[k][i - 1] * static_cast<double>(k - i + 1);
  }
  return factor;
}();

struct Derivatives {
  template <class L>
  [[gnu::always_inline]] static void run(int terms, const double* c, double x, PolynomialDerivatives* out) {
    L value{}, bound{}, value_odd{}, bound_odd{};  // two sums each, that do not wait for each other
    const auto add = [&](int k, double power, L& to, L& to_bound) __attribute__((always_inline)) {
      L factor;
      load(kFallingFactorial[idx(k)].data(), factor);
      to += (c[k] * power) * factor;
      to_bound += __builtin_fabs(c[k]) * factor;
    };
    double power = 1.0;
    int k = 0;
    for (; k + 1 < terms; k += 2, power *= x * x) {
      add(k, power, value, bound);
      add(k + 1, power * x, value_odd, bound_odd);
    }
    if (k < terms) add(k, power, value, bound);
    value += value_odd;
    bound += bound_odd;
    store(value, out->value.data());
    store(bound, out->bound.data());
  }
};

struct Sums {
  static constexpr int kTogether = 6;  // blocks of lanes whose sums stay in registers together
  /// Sums first ... last - 1 of the blocks b = 0, 1, ... from here on. Written out for each of them, since GCC 12 keeps an array
  /// that a loop walks over in memory.
  template <class L, bool kSizes, bool kAdd, int... b>
  [[gnu::always_inline]] static void some(std::integer_sequence<int, b...>, int stride, int first, int last,
                                          int count, int per_column, const double* weights, const int* begin,
                                          const double* tails, const double* f, double* out) {
    for (int j = first; j < last; ++j) {
      double* to = out + j * stride;
      L sum[sizeof...(b)];
      if constexpr (kAdd) {
        (load(to + b * kLanes, sum[b]), ...);
      } else {
        const double start = tails != nullptr ? tails[j - first] : 0.0;
        ((sum[b] = L{} + start), ...);
      }
      const int from = begin != nullptr ? begin[j] : 0;
      const double *weight = weights + from * per_column + j, *x = f + from * stride;
      for (int q = from; q < count; ++q, weight += per_column, x += stride) {
        const auto add = [&](int block, L& to_block) __attribute__((always_inline)) {
          L term;
          load(x + block * kLanes, term);
          if constexpr (kSizes) magnitude(term);
          to_block += *weight * term;
        };
        (add(b, sum[b]), ...);
      }
      (store(sum[b], to + b * kLanes), ...);
    }
  }
  template <class L, bool kSizes, bool kAdd>
  [[gnu::always_inline]] static void all(int stride, int first, int last, int count, int per_column,
                                         const double* weights, const int* begin, const double* tails,
                                         const double* f, double* out) {
    if (first == last) return;
    for (int i = 0; i < stride; i += kTogether * kLanes) {
      const auto take = [&]<int kBlocks>() __attribute__((always_inline)) {
        some<L, kSizes, kAdd>(std::make_integer_sequence<int, kBlocks>(), stride, first, last, count,
                              per_column, weights, begin, tails, f + i, out + i);
      };
      switch (std::min(kTogether, (stride - i) / kLanes)) {
        case 1:
          take.template operator()<1>();
          break;
        case 2:
          take.template operator()<2>();
          break;
        case 3:
          take.template operator()<3>();
          break;
        case 4:
          take.template operator()<4>();
          break;
        case 5:
          take.template operator()<5>();
          break;
        default:
          take.template operator()<kTogether>();
      }
    }
  }
  template <class L>
  [[gnu::always_inline]] static void run(int stride, int terms, int sizes, int count, const double* weight,
                                         int per_column, const int* begin, const double* f, double* out,
                                         bool add, const double* tails) {
    const auto both = [&]<bool kAdd>() __attribute__((always_inline)) {
      all<L, false, kAdd>(stride, 0, terms, count, per_column, weight, begin, nullptr, f, out);
      all<L, true, kAdd>(stride, terms, terms + sizes, count, per_column, weight, begin, tails, f, out);
    };
    add ? both.template operator()<true>() : both.template operator()<false>();
  }
};

/// The plain sum beside the weighted one: additions and products go through different parts of the processor, and both want the same
/// loads.
struct EndSums {
  template <class L, int kBlocks>
  [[gnu::always_inline]] static void some(int stride, int degree, const double* z, double* rate_sum,
                                          double* sum) {
    L total[kBlocks], rate[kBlocks], x;
#pragma GCC unroll 6
    for (int b = 0; b < kBlocks; ++b) {
      load(z + b * kLanes, total[b]);
      rate[b] = total[b];
    }
    for (int k = 2; k <= degree; ++k) {
      z += stride;
      const double weight = k;
#pragma GCC unroll 6
      for (int b = 0; b < kBlocks; ++b) {
        load(z + b * kLanes, x);
        total[b] += x;
        rate[b] += weight * x;
      }
    }
#pragma GCC unroll 6
    for (int b = 0; b < kBlocks; ++b) {
      store(total[b], sum + b * kLanes);
      store(rate[b], rate_sum + b * kLanes);
    }
  }
  template <class L>
  [[gnu::always_inline]] static void run(int stride, int degree, const double* z, double* rate_sum,
                                         double* sum) {
    constexpr int kTogether = std::is_same_v<L, LanePair> ? 2 : 5;  // whose sums stay in registers
    int i = 0;
    for (; i + kTogether * kLanes <= stride; i += kTogether * kLanes)
      some<L, kTogether>(stride, degree, z + i, rate_sum + i, sum + i);
    for (; i < stride; i += kLanes) some<L, 1>(stride, degree, z + i, rate_sum + i, sum + i);
  }
};

/// z = z_0 + sum + y, v = per_time (rate + y_rate); the last lanes may be taken twice. kSwept: there is y.
template <bool kSwept>
struct EndMotion {
  template <class L>
  [[gnu::always_inline]] static void run(int n, const double* z_0, const double* sum, const double* rate,
                                         double per_time, const double* y, const double* y_rate, double* z,
                                         double* v) {
    const auto block = [&](int i) __attribute__((always_inline)) {
      L a, b;
      load(z_0 + i, a);
      load(sum + i, b);
      a += b;
      if constexpr (kSwept) {
        load(y + i, b);
        a += b;
      }
      store(a, z + i);
      load(rate + i, a);
      if constexpr (kSwept) {
        load(y_rate + i, b);
        a += b;
      }
      store(per_time * a, v + i);
    };
    int i = 0;
    for (; i + kLanes < n; i += kLanes) block(i);
    block(n - kLanes);
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

struct WorkByParts {
  template <class L>
  [[gnu::always_inline]] static double run(int stride, const double* p, double s, const double* y,
                                           const double* y_sum, const double* y_sum_2) {
    L total{};
    for (int i = 0; i < stride; i += kLanes) {
      L p_0, p_1, p_2, x, sum, sum_2;
      load(p + i, p_0);
      load(p + stride + i, p_1);
      load(p + 2 * stride + i, p_2);
      load(y + i, x);
      load(y_sum + i, sum);
      load(y_sum_2 + i, sum_2);
      total += (p_0 + s * (p_1 + s * p_2)) * x - p_1 * sum - 2.0 * p_2 * (s * sum - sum_2);
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

}  // namespace

void scaled_product(int stride, double factor, const double* a, const double* b, double* out) {
  run_widest<ScaledProduct>(stride, factor, a, b, out);
}

double subtract_slopes(int stride, const double* slope, const double* mobility, double* main) {
  return run_widest<Slopes>(stride, slope, mobility, main);
}

void series_values(int stride, int degree, const double* z_0, double s, double* z, double* v) {
  run_widest<Values>(stride, degree, z_0, s, z, v);
}

void series_at_nodes(int stride, int degree, const double* z_0, const double* s, int count, double* z,
                     double* v) {
  run_widest<AtNodes>(stride, degree, z_0, s, count, z, v);
}

std::array<double, 2> add_row_terms(int stride, int terms, const double* z_0, const std::vector<Entry>& row,
                                    double* x) {
  std::array<double, 2> sums;
  run_widest<RowTerms>(stride, terms, z_0, row.data(), static_cast<int>(row.size()), x, sums.data());
  return sums;
}

void polynomial_values(int count, int terms, const double* c, const double* x, double* value, double* slope) {
  run_widest<Polynomial>(count, terms, c, x, value, slope);
}

void find_derivatives(int terms, const double* c, double x, PolynomialDerivatives& out) {
  run_widest<Derivatives>(terms, c, x, &out);
  if (x == 1.0) return;
  double power = 1.0;
  for (double& value : out.value) {
    value /= power;
    power *= x;
  }
}

void weighted_sums(int stride, int terms, int sizes, int count, const double* weight, int per_column,
                   const int* begin, const double* f, double* out, bool add, const double* tails) {
  run_widest<Sums>(stride, terms, sizes, count, weight, per_column, begin, f, out, add, tails);
}

void sum_terms(int stride, int degree, const double* z_1, double* rate_sum, double* sum) {
  run_widest<EndSums>(stride, degree, z_1, rate_sum, sum);
}

void end_motion(int n, const double* z_0, const double* sum, const double* rate, double per_time,
                const double* y, const double* y_rate, double* z, double* v) {
  if (n >= kLanes && y != nullptr)
    return run_widest<EndMotion<true>>(n, z_0, sum, rate, per_time, y, y_rate, z, v);
  if (n >= kLanes) return run_widest<EndMotion<false>>(n, z_0, sum, rate, per_time, y, y_rate, z, v);
  for (int i = 0; i < n; ++i) {
    z[i] = z_0[i] + sum[i] + (y != nullptr ? y[i] : 0.0);
    v[i] = per_time * (rate[i] + (y != nullptr ? y_rate[i] : 0.0));
  }
}

double work_of_moments(int stride, const double* p, const double* b, double s) {
  return run_widest<MomentWork>(stride, p, b, s);
}

double work_by_parts(int stride, const double* p, double s, const double* y, const double* y_sum,
                     const double* y_sum_2) {
  return run_widest<WorkByParts>(stride, p, s, y, y_sum, y_sum_2);
}

double weighted_squares(int stride, int terms, const double* factor, const double* c, const double* x,
                        int y_terms, const double* y) {
  return run_widest<Squares>(stride, terms, factor, c, x, y_terms, y);
}

double series_work(int stride, int degree, const double* z_0, int p_degree, const double* p, double s) {
  return run_widest<Work>(stride, degree, z_0, p_degree, p, s);
}

}  // namespace drev
