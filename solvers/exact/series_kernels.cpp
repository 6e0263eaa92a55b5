#include "solvers/exact/series_kernels.hpp"

#include <drev/core/lanes.hpp>

#include <algorithm>

namespace drev {

namespace {
constexpr int kMostTerms = 128;  // of a product of two series
}

DREV_WIDEST
double series_term(int stride, std::span<const DiagonalView> k, std::span<const DiagonalView> c,
                   double c_factor, const double* p, const double* x_0, const double* x_1, const double* w,
                   double factor, double* next) {
  Lanes largest{}, not_finite{};
  for (int i = 0; i < stride; i += kLanes) {
    Lanes sum, a, b;
    load(p + i, sum);
    for (const DiagonalView& d : k) {
      load(d.values + i, a);
      load(x_0 + i + d.offset, b);
      sum -= a * b;
    }
    for (const DiagonalView& d : c) {
      load(d.values + i, a);
      load(x_1 + i + d.offset, b);
      sum -= c_factor * a * b;
    }
    load(w + i, a);
    sum *= factor * a;
    store(sum, next + i);
    const Lanes size = sum < 0.0 ? -sum : sum;
    largest = size < largest ? largest : size;
    not_finite += 0.0 * sum;  // comparisons drop a NaN
  }
  double result = 0.0;
  for (int l = 0; l < kLanes; ++l) {
    result = largest[l] < result ? result : largest[l];
    not_finite[0] += not_finite[l];
  }
  return result + not_finite[0];
}

DREV_WIDEST
void series_values(int stride, int degree, const double* z_0, double s, double* z, double* v) {
  for (int i = 0; i < stride; i += kLanes) {
    Lanes z_sum{}, v_sum{}, c;
    for (int k = degree; k >= 0; --k) {
      load(z_0 + static_cast<std::ptrdiff_t>(k) * stride + i, c);
      v_sum = v_sum * s + z_sum;
      z_sum = z_sum * s + c;
    }
    store(z_sum, z + i);
    store(v_sum, v + i);
  }
}

DREV_WIDEST
void series_ranges(int stride, int degree, const double* z_0, double* end, double* size, double* bend) {
  for (int i = 0; i < stride; i += kLanes) {
    Lanes sum{}, sizes{}, bends{}, x;
    for (int k = 1; k <= degree; ++k) {
      load(z_0 + static_cast<std::ptrdiff_t>(k) * stride + i, x);
      sum += x;
      x = x < 0.0 ? -x : x;
      sizes += x;
      if (k > 1) bends += static_cast<double>(k) * x;
    }
    store(sum, end + i);
    store(sizes, size + i);
    store(bends, bend + i);
  }
}

DREV_WIDEST
double series_work(int stride, int degree, const double* z_0, int p_degree, const double* p, double s) {
  double inverse[kMostTerms], power[kMostTerms];
  power[0] = 1.0;
  for (int k = 1; k <= degree + p_degree; ++k) {
    inverse[k] = 1.0 / k;
    power[k] = power[k - 1] * s;
  }
  Lanes total{};
  for (int i = 0; i < stride; i += kLanes)
    for (int k = 0; k <= p_degree; ++k) {
      Lanes sum{}, x;
      for (int m = 1; m <= degree; ++m) {
        load(z_0 + static_cast<std::ptrdiff_t>(m) * stride + i, x);
        sum += (m * inverse[k + m] * power[k + m]) * x;
      }
      load(p + static_cast<std::ptrdiff_t>(k) * stride + i, x);
      total += sum * x;
    }
  double result = 0.0;
  for (int l = 0; l < kLanes; ++l) result += total[l];
  return result;
}

DREV_WIDEST
double series_product(int stride, int degree, const double* rates, const double* forces, double s) {
  double inverse[kMostTerms], power[kMostTerms];
  power[0] = s;
  for (int k = 0; k < 2 * degree; ++k) {
    inverse[k] = 1.0 / (k + 1);
    power[k + 1] = power[k] * s;
  }
  Lanes total{};
  for (int i = 0; i < stride; i += kLanes) {
    for (int j = 0; j < degree; ++j) {
      Lanes row{}, x;
      const double* f = forces + i;
      // C is symmetric: each pair once.
      for (int k = 0; k < j; ++k, f += stride) {
        load(f, x);
        row += (2.0 * inverse[j + k] * power[j + k]) * x;
      }
      load(f, x);
      row += (inverse[2 * j] * power[2 * j]) * x;
      load(rates + static_cast<std::ptrdiff_t>(j) * stride + i, x);
      total += row * x;
    }
  }
  double sum = 0.0;
  for (int l = 0; l < kLanes; ++l) sum += total[l];
  return sum;
}

}  // namespace drev
