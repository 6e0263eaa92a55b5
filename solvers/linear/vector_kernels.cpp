#include "solvers/linear/vector_kernels.hpp"

#include <drev/core/lanes.hpp>

namespace drev {

namespace {

[[gnu::always_inline]] inline double sum_of(const Lanes& x) {
  return ((x[0] + x[4]) + (x[2] + x[6])) + ((x[1] + x[5]) + (x[3] + x[7]));
}

/// body(i) for every kLanes entries from i, n >= kLanes; the last begin at n - kLanes and may be taken twice.
template <class Body>
[[gnu::always_inline]] inline void for_blocks(int n, const Body& body) {
  int i = 0;
  for (; i + kLanes < n; i += kLanes) body(i);
  body(n - kLanes);
}

/// The largest size of entries; infinities and NaN are carried by 0 x, since comparisons drop a NaN.
struct Largest {
  Lanes most{}, bad{};
  [[gnu::always_inline]] void note(const Lanes& x) {
    larger(most, x);
    bad += 0.0 * x;
  }
  [[gnu::always_inline]] double result() const {
    double largest = most[0];
    for (int l = 1; l < kLanes; ++l) largest = most[l] > largest ? most[l] : largest;
    return largest + sum_of(bad);
  }
};

template <class Value>
[[gnu::always_inline]] inline double largest_of(int n, const Value& value) {
  Largest largest;
  for_blocks(
      n, [&](int i) __attribute__((always_inline)) {
        Lanes x;
        value(i, x);
        largest.note(x);
      });
  return largest.result();
}

struct Itself {
  const double* x;
  [[gnu::always_inline]] void operator()(int i, Lanes& out) const { load(x + i, out); }
};
struct Difference {
  const double *x, *y;
  [[gnu::always_inline]] void operator()(int i, Lanes& out) const {
    Lanes b;
    load(x + i, out);
    load(y + i, b);
    out -= b;
  }
};

/// The sums of a product stay in registers.
template <int kBlocks>
[[gnu::always_inline]] inline void product_blocks(int n, int stride, const double* columns, const double* x,
                                                  double* out) {
  Lanes sum[kBlocks] = {}, a;
  for (int j = 0; j < n; ++j, columns += stride)
    for (int b = 0; b < kBlocks; ++b) {
      load(columns + b * kLanes, a);
      sum[b] += a * x[j];
    }
  for (int b = 0; b + 1 < kBlocks; ++b) store(sum[b], out + b * kLanes);
  const int rest = n - (kBlocks - 1) * kLanes;
  for (int l = 0; l < rest; ++l) out[(kBlocks - 1) * kLanes + l] = sum[kBlocks - 1][l];
}

/// Rows that stay in the nearest cache while band after band is added.
constexpr int kBlock = 512;

[[gnu::always_inline]] inline void diagonal_product(int n, const double* __restrict d, double factor,
                                                    const double* __restrict x, const double* __restrict y,
                                                    double* __restrict out) {
  if (y)
    for (int i = 0; i < n; ++i) out[i] = y[i] + factor * d[i] * x[i];
  else
    for (int i = 0; i < n; ++i) out[i] = factor * d[i] * x[i];
}

/// The main diagonal and one band, in one pass.
template <bool kAdds>
[[gnu::always_inline]] inline void two_bands(int n, const Band* bands, double factor, const double* x,
                                             const double* y, double* out) {
  const int k = bands[1].offset;
  const double *d = bands[0].values.data(), *e = bands[1].values.data();
  const auto one = [&](int i, bool has_before, bool has_after) __attribute__((always_inline)) {
    double sum = d[i] * x[i];
    if (has_after) sum += e[i] * x[i + k];
    if (has_before) sum += e[i - k] * x[i - k];
    out[i] = (kAdds ? y[i] : 0.0) + factor * sum;
  };
  const int low = k < n ? k : n, high = n - k > low ? n - k : low;
  for (int i = 0; i < low; ++i) one(i, false, i + k < n);
  for (int i = high; i < n; ++i) one(i, true, false);
  if (high - low < kLanes) {
    for (int i = low; i < high; ++i) one(i, true, true);
    return;
  }
  for_blocks(
      high - low, [&](int j) __attribute__((always_inline)) {
        const int i = low + j;
        Lanes sum, a, b;
        load(d + i, a);
        load(x + i, b);
        sum = a * b;
        load(e + i, a);
        load(x + i + k, b);
        sum += a * b;
        load(e + i - k, a);
        load(x + i - k, b);
        sum += a * b;
        sum *= factor;
        if (kAdds) {
          load(y + i, a);
          sum += a;
        }
        store(sum, out + i);
      });
}

[[gnu::always_inline]] inline void add_band(int first, int last, double factor, const double* __restrict d,
                                            const double* __restrict x, double* __restrict out) {
  for (int i = first; i < last; ++i) out[i] += factor * d[i] * x[i];
}

template <bool kDamped>
[[gnu::always_inline]] inline StepWork work_of(int n, const double* z_0, const double* z_1, const double* p_0,
                                               const double* p_1, const double* cv_0, const double* cv_1,
                                               const double* kz_1) {
  Lanes input{}, dissipated{}, stored{}, a, b, dz;
  int i = 0;
  for (; i + kLanes <= n; i += kLanes) {
    load(z_1 + i, dz);
    load(kz_1 + i, a);
    stored += dz * a;
    load(z_0 + i, a);
    dz -= a;
    load(p_0 + i, a);
    load(p_1 + i, b);
    input += dz * (a + b);
    if (kDamped) {
      load(cv_0 + i, a);
      load(cv_1 + i, b);
      dissipated += dz * (a + b);
    }
  }
  StepWork work{sum_of(input), sum_of(dissipated), sum_of(stored)};
  for (; i < n; ++i) {
    const double d = z_1[i] - z_0[i];
    work.stored += z_1[i] * kz_1[i];
    work.input += d * (p_0[i] + p_1[i]);
    if (kDamped) work.dissipated += d * (cv_0[i] + cv_1[i]);
  }
  work.input *= 0.5;
  work.dissipated *= 0.5;
  work.stored *= 0.5;
  return work;
}

}  // namespace

namespace wide {

DREV_WIDEST
void predict_motion(int n, double h, double c_z, double c_v, const double* __restrict z,
                    const double* __restrict v, const double* __restrict a, double* __restrict z_0,
                    double* __restrict v_0) {
  for (int i = 0; i < n; ++i) {
    z_0[i] = z[i] + h * v[i] + c_z * a[i];
    v_0[i] = v[i] + c_v * a[i];
  }
}

DREV_WIDEST
double correct_motion(int n, double c_z, double c_v, const double* z_0, const double* v_0, const double* a,
                      double* z, double* v) {
  Largest change;
  for_blocks(
      n, [&](int i) __attribute__((always_inline)) {
        Lanes rate, start, old;
        load(a + i, rate);
        load(z_0 + i, start);
        start += c_z * rate;
        load(z + i, old);
        change.note(start - old);
        store(start, z + i);
        load(v_0 + i, start);
        start += c_v * rate;
        store(start, v + i);
      });
  return change.result();
}

DREV_WIDEST
void sum_with(int n, const double* __restrict y, double factor, const double* __restrict x,
              double* __restrict out) {
  for (int i = 0; i < n; ++i) out[i] = y[i] + factor * x[i];
}

DREV_WIDEST
void elastic_forces(int n, const double* __restrict total, const double* __restrict p,
                    const double* __restrict cv, double* __restrict out) {
  if (cv)
    for (int i = 0; i < n; ++i) out[i] = total[i] + p[i] - cv[i];
  else
    for (int i = 0; i < n; ++i) out[i] = total[i] + p[i];
}

DREV_WIDEST
void add_multiple(int n, double factor, const double* __restrict x, double* __restrict out) {
  for (int i = 0; i < n; ++i) out[i] += factor * x[i];
}

DREV_WIDEST
double largest_size(int n, const double* x) { return largest_of(n, Itself{x}); }

DREV_WIDEST
double largest_of_both(int n, const double* x, const double* y) {
  Largest largest;
  for_blocks(
      n, [&](int i) __attribute__((always_inline)) {
        Lanes a;
        load(x + i, a);
        largest.note(a);
        load(y + i, a);
        largest.note(a);
      });
  return largest.result();
}

DREV_WIDEST
double largest_difference(int n, const double* x, const double* y) { return largest_of(n, Difference{x, y}); }

DREV_WIDEST
void dense_product(int n, int stride, const double* columns, const double* x, double* out) {
  switch (stride / kLanes) {
    case 1:
      return product_blocks<1>(n, stride, columns, x, out);
    case 2:
      return product_blocks<2>(n, stride, columns, x, out);
    case 3:
      return product_blocks<3>(n, stride, columns, x, out);
    case 4:
      return product_blocks<4>(n, stride, columns, x, out);
    case 5:
      return product_blocks<5>(n, stride, columns, x, out);
    case 6:
      return product_blocks<6>(n, stride, columns, x, out);
    case 7:
      return product_blocks<7>(n, stride, columns, x, out);
    case 8:
      return product_blocks<8>(n, stride, columns, x, out);
    default:
      return;
  }
}

DREV_WIDEST
void band_product(int n, const std::vector<Band>& bands, double factor, const double* x, const double* y,
                  double* out) {
  if (bands.size() == 1 && bands[0].offset == 0)
    return diagonal_product(n, bands[0].values.data(), factor, x, y, out);
  if (bands.size() == 2 && bands[0].offset == 0)
    return y ? two_bands<true>(n, bands.data(), factor, x, y, out)
             : two_bands<false>(n, bands.data(), factor, x, y, out);
  for (int first = 0; first < n; first += kBlock) {
    const int last = first + kBlock < n ? first + kBlock : n;
    for (int i = first; i < last; ++i) out[i] = y ? y[i] : 0.0;
    for (const Band& band : bands) {
      const int k = band.offset, end = last < n - k ? last : n - k;
      const double* d = band.values.data();
      add_band(first, end, factor, d, x + k, out);
      if (k > 0) add_band(first > k ? first : k, last, factor, d - k, x - k, out);
    }
  }
}

DREV_WIDEST
double band_energy(int n, const std::vector<Band>& bands, const double* x) {
  double energy = 0.0;
  for (const Band& band : bands) {
    const int k = band.offset, m = n - k;
    const double *d = band.values.data(), *other = x + k;
    Lanes sum{}, a, b, c;
    int i = 0;
    for (; i + kLanes <= m; i += kLanes) {
      load(d + i, a);
      load(x + i, b);
      load(other + i, c);
      sum += a * b * c;
    }
    double part = sum_of(sum);
    for (; i < m; ++i) part += d[i] * x[i] * other[i];
    energy += k > 0 ? 2.0 * part : part;
  }
  return energy;
}

DREV_WIDEST
StepWork step_work(int n, const double* z_0, const double* z_1, const double* p_0, const double* p_1,
                   const double* cv_0, const double* cv_1, const double* kz_1) {
  return cv_0 ? work_of<true>(n, z_0, z_1, p_0, p_1, cv_0, cv_1, kz_1)
              : work_of<false>(n, z_0, z_1, p_0, p_1, cv_0, cv_1, kz_1);
}

DREV_WIDEST
double dot(int n, const double* x, const double* y) {
  Lanes sum{}, a, b;
  int i = 0;
  for (; i + kLanes <= n; i += kLanes) {
    load(x + i, a);
    load(y + i, b);
    sum += a * b;
  }
  double result = sum_of(sum);
  for (; i < n; ++i) result += x[i] * y[i];
  return result;
}

}  // namespace wide

}  // namespace drev
