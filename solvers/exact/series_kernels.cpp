#include "solvers/exact/series_kernels.hpp"

#include <cstddef>

#include "solvers/exact/lane_pair.hpp"

namespace drev {

namespace {
constexpr int kMostTerms = 128;  // of a product of two series

[[gnu::always_inline]] inline const double* column(const double* first, int stride, int k) {
  return first + static_cast<std::ptrdiff_t>(k) * stride;
}

struct Term {
  template <class L>
  [[gnu::always_inline]] static double run(int stride, const int* k_begin, const DiagonalView* k,
                                           const int* c_begin, const DiagonalView* c, const double* c_main,
                                           double c_factor, const double* p, const double* x_0,
                                           const double* x_1, const double* w, double factor, double* next) {
    L largest{}, not_finite{};
    for (int i = 0, block = 0; i < stride; i += kLanes, ++block) {
      L sum, damping{}, a, b;
      load(p + i, sum);
      for (int d = k_begin[block]; d < k_begin[block + 1]; ++d) {
        load(k[d].values + i, a);
        load(x_0 + i + k[d].offset, b);
        sum -= a * b;
      }
      if (c_main != nullptr) {
        load(c_main + i, a);
        load(x_1 + i, b);
        damping = a * b;
      } else if (c != nullptr) {
        for (int d = c_begin[block]; d < c_begin[block + 1]; ++d) {
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
    return largest_of(largest) + sum_of(not_finite);
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
  template <class L>
  [[gnu::always_inline]] static void run(int stride, int terms, int count, const double* weight,
                                         const double* f, double* out) {
    for (int i = 0; i < stride; i += kLanes)
      for (int j = 0; j < terms; ++j) {
        L sum, x;
        double* at = out + j * stride + i;
        load(at, sum);
        for (int q = 0; q < count; ++q) {
          load(column(f, stride, q) + i, x);
          sum += weight[j * count + q] * x;
        }
        store(sum, at);
      }
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

struct Work {
  template <class L>
  [[gnu::always_inline]] static double run(int stride, int degree, const double* z_0, int p_degree,
                                           const double* p, double s) {
    double inverse[kMostTerms], power[kMostTerms];
    power[0] = 1.0;
    for (int k = 1; k <= degree + p_degree; ++k) {
      inverse[k] = 1.0 / k;
      power[k] = power[k - 1] * s;
    }
    L total{};
    for (int i = 0; i < stride; i += kLanes)
      for (int k = 0; k <= p_degree; ++k) {
        L sum{}, x;
        for (int m = 1; m <= degree; ++m) {
          load(column(z_0, stride, m) + i, x);
          sum += (m * inverse[k + m] * power[k + m]) * x;
        }
        load(column(p, stride, k) + i, x);
        total += sum * x;
      }
    return sum_of(total);
  }
};

struct Product {
  template <class L>
  [[gnu::always_inline]] static double run(int stride, int degree, const double* rates, const double* forces,
                                           const double* c_main, double s) {
    double weight[kMostTerms];
    double power = s;
    for (int k = 0; k < 2 * degree; ++k, power *= s) weight[k] = power / (k + 1);
    L total{};
    for (int i = 0; i < stride; i += kLanes) {
      L block{};
      for (int j = 0; j < degree; ++j) {
        L row{}, x;
        const double* f = forces + i;
        // C is symmetric: each pair once.
        for (int k = 0; k < j; ++k, f += stride) {
          load(f, x);
          row += weight[j + k] * x;
        }
        load(f, x);
        row = 2.0 * row + weight[2 * j] * x;
        load(column(rates, stride, j) + i, x);
        block += row * x;
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

double series_term(int stride, const BlockDiagonals& k, const BlockDiagonals& c, const double* c_main,
                   double c_factor, const double* p, const double* x_0, const double* x_1, const double* w,
                   double factor, double* next) {
  return run_widest<Term>(stride, k.begin, k.views, c.begin, c.views, c_main, c_factor, p, x_0, x_1, w,
                          factor, next);
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

void series_ranges(int stride, int degree, const double* z_0, double* end, double* size, double* bend) {
  run_widest<Ranges>(stride, degree, z_0, end, size, bend);
}

double series_work(int stride, int degree, const double* z_0, int p_degree, const double* p, double s) {
  return run_widest<Work>(stride, degree, z_0, p_degree, p, s);
}

double series_product(int stride, int degree, const double* rates, const double* forces, const double* c_main,
                      double s) {
  return run_widest<Product>(stride, degree, rates, c_main != nullptr ? rates : forces, c_main, s);
}

}  // namespace drev
