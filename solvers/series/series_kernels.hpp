#pragma once
/// The inner loops of TaylorSeries, over columns padded to whole lanes.
#include <drev/core/lanes.hpp>
#include <drev/core/system.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace drev {

/// 1/k, k > 0.
inline constexpr auto kInverse = [] {
  std::array<double, 129> inverse{};
  for (std::size_t k = 1; k < inverse.size(); ++k) inverse[k] = 1.0 / static_cast<double>(k);
  return inverse;
}();

/// One diagonal of a matrix: values[row] at column row + offset, padded with zeros.
struct DiagonalView {
  int offset;
  const double* values;
  int only;  ///< in a block of rows: the column of its entry there, where it has only one; else -1
};

/// The diagonals that have entries in each block of kLanes rows: views[begin[i]] to views[begin[i + 1] - 1] of
/// block i.
struct BlockDiagonals {
  const int* begin;
  const DiagonalView* views;
  bool single = false;  ///< each block has one view at most, with one entry
};

/// Forces on few rows, in one or two rows of lanes: of P_k on row i at values[from[i] - k step]; kMost of those without any.
struct PackedForces {
  const double* values = nullptr;  ///< of P_0; null: none
  int step = 0;                    ///< kLanes or twice as much
  const std::int64_t* from = nullptr;
  static constexpr int kMost = 2 * kLanes - 1;  ///< forces: one lane stays zero
};

/// What acts on every term of a series: adds to Z_k at `term` once it is known without; false: nothing.
struct TermHook {
  bool (*add)(void* of, int k, double* term) = nullptr;
  void* of = nullptr;
};

/// The series of M z'' + C z' + K z = sum P_k s^k with a diagonal M over a step of h [s], s = (t - t_0)/h. Columns hold
/// the coefficients of s^k, or, where derivatives is set, those of s^k/k!. Matrices are scaled for the step, once for all
/// its terms: k is -h^2 M^-1 K, c -h M^-1 C.
struct SeriesRecursion {
  int stride;
  BlockDiagonals k, c;     ///< c.views: null where c_main is C, or where there is none
  const double* c_main;    ///< C, where it has a main diagonal alone; else null
  const double* mobility;  ///< h^2 M^-1 by rows
  double* p;               ///< P_k at p + (k - p_first) stride, k = p_first ... p_degree; none above
  int p_first, p_degree;
  double* z;  ///< Z_k at z + k stride
  /// The diagonals below, on and above the main one, where k and c have the others alone; null: k and c have all.
  std::array<const double*, 3> k_chain{}, c_chain{};
  bool derivatives = false;
  TermHook hook = {};        ///< of a series
  PackedForces packed = {};  ///< of derivatives, in place of p, where takes_packed_forces()
  int first_kept = 0;        ///< with those: terms before this one may be lost

  /// Z_k = factor (mobility P_{k-2} + k Z_{k-2} + damping_factor c Z_{k-1}).
  double factor(int k) const { return derivatives ? 1.0 : 1.0 / (static_cast<double>(k) * (k - 1)); }
  double damping_factor(int k) const { return derivatives ? 1.0 : k - 1.0; }
};

/// Z_k for k = first ... last, and, of a series, the largest |Z_k| of each in sizes from 0 on; the last two are not finite if any
/// of the terms is not. Derivatives have no sizes, and leave P zero.
void series_terms(const SeriesRecursion& recursion, int first, int last, double* sizes);

/// Whether series_terms() takes this recursion's forces packed.
bool takes_packed_forces(const SeriesRecursion& recursion);

/// out_i = factor a_i b_i.
void scaled_product(int stride, double factor, const double* a, const double* b, double* out);

/// main_i -= slope_i; returns the largest |slope_i| mobility_i.
double subtract_slopes(int stride, const double* slope, const double* mobility, double* main);

/// z = sum Z_k s^k and v = sum k Z_k s^(k-1) from columns Z_k at z_0 + k stride.
void series_values(int stride, int degree, const double* z_0, double s, double* z, double* v);

/// z and v, as above, at `count` places s (a multiple of 4): rows of place q at z + q stride. v may be null.
void series_at_nodes(int stride, int degree, const double* z_0, const double* s, int count, double* z,
                     double* v);

/// x_k += sum_e coeff_e Z_k[index_e], k < terms; returns, over the whole lanes that hold these terms, sum |x_k| from the second on and
/// sum k |x_k| from the third on.
std::array<double, 2> add_row_terms(int stride, int terms, const double* z_0, const std::vector<Entry>& row,
                                    double* x);

/// Value and slope of the polynomial with these terms at `count` places x, in whole lanes.
void polynomial_values(int count, int terms, const double* c, const double* x, double* value, double* slope);

/// A polynomial with these terms and its first derivatives at x > 0; and bounds of them, in that order, on [0, 1].
inline constexpr int kDerivatives = 5;
struct PolynomialDerivatives {
  alignas(kLanes * sizeof(double)) std::array<double, kLanes> value, bound;  ///< of 0 ... kDerivatives
};
void find_derivatives(int terms, const double* c, double x, PolynomialDerivatives& out);

/// out_j = sum_q w_qj f_q, j < terms, and behind those out_j = sum_q w_qj |f_q|, j < terms + sizes, q < count; w_qj at
/// weight[q per_column + j], columns f_q at f + q stride, out_j at out + j stride. begin, where it is not null: the w_qj before
/// q = begin[j] are zero. add: to what out holds; else tails, where it is not null: the sizes to this of each j.
void weighted_sums(int stride, int terms, int sizes, int count, const double* weight, int per_column,
                   const int* begin, const double* f, double* out, bool add = false,
                   const double* tails = nullptr);

/// sum = sum Z_k and rate_sum = sum k Z_k, k = 1 ... degree, with the first of them at z_1.
void sum_terms(int stride, int degree, const double* z_1, double* rate_sum, double* sum);

/// z = z_0 + sum + y, v = per_time (rate + y_rate) of n unknowns; y null: without these.
void end_motion(int n, const double* z_0, const double* sum, const double* rate, double per_time,
                const double* y, const double* y_rate, double* z, double* v);

/// sum_i p_0i b_0i + p_1i s/2 (b_0i + b_1i) + p_2i s^2/6 (2 b_0i + 3 b_1i + b_2i) = int_0^s (p_0 + p_1 u + p_2 u^2) z' du with
/// the moments b_k = int_0^s L_k z' du of Legendre polynomials over [0, s].
double work_of_moments(int stride, const double* p, const double* b, double s);

/// sum_i (p_0i + s (p_1i + s p_2i)) y_i - p_1i Y_i - 2 p_2i (s Y_i - W_i) = int_0^s (p_0 + p_1 u + p_2 u^2) y' du, by parts, with
/// y and its integrals Y = int y du and W = int (s - u) y du.
double work_by_parts(int stride, const double* p, double s, const double* y, const double* y_sum,
                     const double* y_sum_2);

/// sum_k factor[k] sum_i c_i (x_ki + y_ki)^2 with columns x_k, k < terms, and y_k, k < y_terms.
double weighted_squares(int stride, int terms, const double* factor, const double* c, const double* x,
                        int y_terms, const double* y);

/// int_0^s (sum P_k s^k) . z' ds with the columns P_k, k = 0 ... p_degree.
double series_work(int stride, int degree, const double* z_0, int p_degree, const double* p, double s);

}  // namespace drev
