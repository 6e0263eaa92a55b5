#pragma once
/// The inner loops of TaylorSeries, over columns padded to whole lanes.
#include <cstddef>
#include <span>

namespace drev {

/// One diagonal of a matrix: values[row] at column row + offset, padded with zeros.
struct DiagonalView {
  int offset;
  const double* values;
};

/// next = factor w (p - K x_0 - c_factor C x_1), row by row with the scaling w; returns the largest |next|,
/// or NaN if any is not finite.
double series_term(int stride, std::span<const DiagonalView> k, std::span<const DiagonalView> c,
                   double c_factor, const double* p, const double* x_0, const double* x_1, const double* w,
                   double factor, double* next);

/// z = sum Z_k s^k and v = sum k Z_k s^(k-1) from columns Z_k at z_0 + k stride.
void series_values(int stride, int degree, const double* z_0, double s, double* z, double* v);

/// Of the columns behind the first: end = sum Z_k, size = sum |Z_k|, bend = sum k |Z_k| without the first.
void series_ranges(int stride, int degree, const double* z_0, double* end, double* size, double* bend);

/// int_0^s (sum P_k s^k) . z' ds with the columns P_k, k = 0 ... p_degree.
double series_work(int stride, int degree, const double* z_0, int p_degree, const double* p, double s);

/// sum_jk 1/(j+k-1) s^(j+k-1) (j Z_j) . (C k Z_k), j, k = 1 ... degree; rates and forces hold j Z_j and
/// C j Z_j at column j - 1.
double series_product(int stride, int degree, const double* rates, const double* forces, double s);

}  // namespace drev
