#pragma once
/// The inner loops of a step over all unknowns, for a processor's widest vectors (core/lanes.hpp). Fewer
/// unknowns than a vector holds are not worth the call: their loops stand here, those of more in wide.
#include <drev/core/lanes.hpp>
#include <drev/core/system.hpp>

#include <vector>

namespace drev {

/// A diagonal of a symmetric matrix and its mirror image: values_i stands at (i, i + offset) and
/// (i + offset, i).
struct Band {
  int offset = 0;  ///< >= 0
  Vector values;
};
/// out += row i of A x, A by rows on a pattern. Values and numbers: double, or LaneRow for kLanes of each.
template <class Value, class Number, class Sum>
[[gnu::always_inline]] inline void add_row_product(const int* outer, const int* inner, const Value* values,
                                                   const Number* x, int i, Sum& out) {
  for (int s = outer[i]; s < outer[i + 1]; ++s) out += each(values[s]) * each(x[inner[s]]);
}
/// What a step adds to the energy balance, and what is stored at its end [J].
struct StepWork {
  double input = 0.0;       ///< sum (z_1 - z_0) (p_0 + p_1)/2
  double dissipated = 0.0;  ///< sum (z_1 - z_0) (cv_0 + cv_1)/2; 0 where the cv are null
  double stored = 0.0;      ///< sum z_1 kz_1/2
};
inline constexpr int kLargestDense = 64;  ///< rows of a dense product

namespace wide {
void predict_motion(int n, double h, double c_z, double c_v, const double* z, const double* v,
                    const double* a, double* z_0, double* v_0);
double correct_motion(int n, double c_z, double c_v, const double* z_0, const double* v_0, const double* a,
                      double* z, double* v);
void sum_with(int n, const double* y, double factor, const double* x, double* out);
void elastic_forces(int n, const double* total, const double* p, const double* cv, double* out);
void add_multiple(int n, double factor, const double* x, double* out);
double largest_size(int n, const double* x);
double largest_of_both(int n, const double* x, const double* y);
double largest_difference(int n, const double* x, const double* y);
void dense_product(int n, int stride, const double* columns, const double* x, double* out);
void band_product(int n, const std::vector<Band>& bands, double factor, const double* x, const double* y,
                  double* out);
double band_energy(int n, const std::vector<Band>& bands, const double* x);
StepWork step_work(int n, const double* z_0, const double* z_1, const double* p_0, const double* p_1,
                   const double* cv_0, const double* cv_1, const double* kz_1);
double dot(int n, const double* x, const double* y);
}  // namespace wide

/// z_0 = z + h v + c_z a, v_0 = v + c_v a.
inline void predict_motion(int n, double h, double c_z, double c_v, const double* z, const double* v,
                           const double* a, double* z_0, double* v_0) {
  if (n >= kLanes) return wide::predict_motion(n, h, c_z, c_v, z, v, a, z_0, v_0);
  for (int i = 0; i < n; ++i) {
    z_0[i] = z[i] + h * v[i] + c_z * a[i];
    v_0[i] = v[i] + c_v * a[i];
  }
}

/// The largest of sizes; NaN once one is not finite, which a comparison alone would drop.
struct LargestSize {
  double most = 0.0, bad = 0.0;
  void note(double x) {
    const double size = x < 0.0 ? -x : x;
    most = size > most ? size : most;
    bad += 0.0 * x;
  }
  double result() const { return most + bad; }
};

/// z = z_0 + c_z a, v = v_0 + c_v a; returns the largest change of z, NaN if z is or was not finite.
inline double correct_motion(int n, double c_z, double c_v, const double* z_0, const double* v_0,
                             const double* a, double* z, double* v) {
  if (n >= kLanes) return wide::correct_motion(n, c_z, c_v, z_0, v_0, a, z, v);
  LargestSize change;
  for (int i = 0; i < n; ++i) {
    const double z_new = z_0[i] + c_z * a[i];
    change.note(z_new - z[i]);
    z[i] = z_new;
    v[i] = v_0[i] + c_v * a[i];
  }
  return change.result();
}

/// out = y + factor x.
inline void sum_with(int n, const double* y, double factor, const double* x, double* out) {
  if (n >= kLanes) return wide::sum_with(n, y, factor, x, out);
  for (int i = 0; i < n; ++i) out[i] = y[i] + factor * x[i];
}

/// total + p - cv, which is what the springs and laws give; cv null: 0.
inline void elastic_forces(int n, const double* total, const double* p, const double* cv, double* out) {
  if (n >= kLanes) return wide::elastic_forces(n, total, p, cv, out);
  for (int i = 0; i < n; ++i) out[i] = total[i] + p[i] - (cv ? cv[i] : 0.0);
}

/// out_i += factor x_i.
inline void add_multiple(int n, double factor, const double* x, double* out) {
  if (n >= kLanes) return wide::add_multiple(n, factor, x, out);
  for (int i = 0; i < n; ++i) out[i] += factor * x[i];
}

/// Largest |x_i|; NaN if any x_i is not finite.
inline double largest_size(int n, const double* x) {
  if (n >= kLanes) return wide::largest_size(n, x);
  LargestSize largest;
  for (int i = 0; i < n; ++i) largest.note(x[i]);
  return largest.result();
}

/// Largest |x_i| and |y_i|; NaN if any is not finite.
inline double largest_of_both(int n, const double* x, const double* y) {
  if (n >= kLanes) return wide::largest_of_both(n, x, y);
  LargestSize largest;
  for (int i = 0; i < n; ++i) {
    largest.note(x[i]);
    largest.note(y[i]);
  }
  return largest.result();
}

/// Largest |x_i - y_i|; NaN if any is not finite.
inline double largest_difference(int n, const double* x, const double* y) {
  if (n >= kLanes) return wide::largest_difference(n, x, y);
  LargestSize largest;
  for (int i = 0; i < n; ++i) largest.note(x[i] - y[i]);
  return largest.result();
}

/// out = A x for a dense A of n columns that begin `stride` apart, a multiple of kLanes not less than n;
/// n at most kLargestDense.
inline void dense_product(int n, int stride, const double* columns, const double* x, double* out) {
  if (n >= kLanes) return wide::dense_product(n, stride, columns, x, out);
  for (int i = 0; i < n; ++i) {
    out[i] = 0.0;
    for (int j = 0; j < n; ++j) out[i] += columns[j * stride + i] * x[j];
  }
}

/// out = y + factor A x for the bands of A, by growing offsets; y null: 0. x, y and out are different.
inline void band_product(int n, const std::vector<Band>& bands, double factor, const double* x,
                         const double* y, double* out) {
  if (n >= kLanes) return wide::band_product(n, bands, factor, x, y, out);
  for (int i = 0; i < n; ++i) out[i] = y ? y[i] : 0.0;
  for (const Band& band : bands) {
    const double* values = band.values.data();
    if (band.offset == 0)
      for (int i = 0; i < n; ++i) out[i] += factor * values[i] * x[i];
    else
      for (int i = 0, k = band.offset; k < n; ++i, ++k) {
        const double value = factor * values[i];
        out[i] += value * x[k];
        out[k] += value * x[i];
      }
  }
}

/// x' A x.
inline double band_energy(int n, const std::vector<Band>& bands, const double* x) {
  if (n >= kLanes) return wide::band_energy(n, bands, x);
  double energy = 0.0;
  for (const Band& band : bands) {
    const double* values = band.values.data();
    double sum = 0.0;
    for (int i = 0, k = band.offset; k < n; ++i, ++k) sum += values[i] * x[i] * x[k];
    energy += band.offset == 0 ? sum : 2.0 * sum;
  }
  return energy;
}

inline StepWork step_work(int n, const double* z_0, const double* z_1, const double* p_0, const double* p_1,
                          const double* cv_0, const double* cv_1, const double* kz_1) {
  if (n >= kLanes) return wide::step_work(n, z_0, z_1, p_0, p_1, cv_0, cv_1, kz_1);
  StepWork work;
  for (int i = 0; i < n; ++i) {
    const double half = 0.5 * (z_1[i] - z_0[i]);
    work.input += half * (p_0[i] + p_1[i]);
    if (cv_0) work.dissipated += half * (cv_0[i] + cv_1[i]);
    work.stored += 0.5 * z_1[i] * kz_1[i];
  }
  return work;
}

/// sum x_i y_i.
inline double dot(int n, const double* x, const double* y) {
  if (n >= kLanes) return wide::dot(n, x, y);
  double sum = 0.0;
  for (int i = 0; i < n; ++i) sum += x[i] * y[i];
  return sum;
}

}  // namespace drev
