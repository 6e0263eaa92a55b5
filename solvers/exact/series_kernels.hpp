#pragma once
/// The inner loops of TaylorSeries, over columns padded to whole lanes.
#include <cstddef>

namespace drev {

/// One diagonal of a matrix: values[row] at column row + offset, padded with zeros.
struct DiagonalView {
  int offset;
  const double* values;
};

/// The diagonals that have entries in each block of kLanes rows: views[begin[i]] to views[begin[i + 1] - 1] of
/// block i.
struct BlockDiagonals {
  const int* begin;
  const DiagonalView* views;
};

/// next = factor w (p - K x_0 - c_factor C x_1), row by row with the scaling w; C is its main diagonal c_main where
/// that is not null, else the views of c, none where they are null. Returns the largest |next|, or NaN if any is not
/// finite.
double series_term(int stride, const BlockDiagonals& k, const BlockDiagonals& c, const double* c_main,
                   double c_factor, const double* p, const double* x_0, const double* x_1, const double* w,
                   double factor, double* next);

/// z = sum Z_k s^k and v = sum k Z_k s^(k-1) from columns Z_k at z_0 + k stride.
void series_values(int stride, int degree, const double* z_0, double s, double* z, double* v);

/// z and v, as above, at `count` places s (a multiple of 4): rows of place q at z + q stride. v may be null.
void series_at_nodes(int stride, int degree, const double* z_0, const double* s, int count, double* z,
                     double* v);

/// Value and slope of the polynomial with these terms at `count` places x, in whole lanes.
void polynomial_values(int count, int terms, const double* c, const double* x, double* value, double* slope);

/// out_j += sum_q weight[j count + q] f_q, j < terms: columns f_q at f + q stride, out_j at out + j stride.
void weighted_sums(int stride, int terms, int count, const double* weight, const double* f, double* out);

/// Of the columns behind the first: end = sum Z_k, size = sum |Z_k|, bend = sum k |Z_k| without the first.
void series_ranges(int stride, int degree, const double* z_0, double* end, double* size, double* bend);

/// int_0^s (sum P_k s^k) . z' ds with the columns P_k, k = 0 ... p_degree.
double series_work(int stride, int degree, const double* z_0, int p_degree, const double* p, double s);

/// sum_jk 1/(j+k-1) s^(j+k-1) (j Z_j) . (C k Z_k), j, k = 1 ... degree; rates and forces hold j Z_j and
/// C j Z_j at column j - 1. c_main: C is this diagonal, forces are not read.
double series_product(int stride, int degree, const double* rates, const double* forces, const double* c_main,
                      double s);

}  // namespace drev
