#pragma once
/// The inner loops of a step over all unknowns, for a processor's widest vectors (core/lanes.hpp).
namespace drev {

/// z_0 = z + h v + c_z a, v_0 = v + c_v a.
void predict_motion(int n, double h, double c_z, double c_v, const double* z, const double* v,
                    const double* a, double* z_0, double* v_0);
/// z = z_0 + c_z a, v = v_0 + c_v a; returns the largest change of z, NaN if z is or was not finite.
double correct_motion(int n, double c_z, double c_v, const double* z_0, const double* v_0,
                      const double* a, double* z, double* v);
/// out = y + factor x.
void sum_with(int n, const double* y, double factor, const double* x, double* out);
/// out_i += factor d_i x_i.
void add_scaled(int n, double factor, const double* d, const double* x, double* out);
/// out_i += factor x_i.
void add_multiple(int n, double factor, const double* x, double* out);
/// Largest |x_i|; NaN if any x_i is not finite.
double largest_size(int n, const double* x);
/// Largest |x_i - y_i|; NaN if any is not finite.
double largest_difference(int n, const double* x, const double* y);

/// out = A x for a dense A of n columns that begin `stride` apart, a multiple of kLanes not less than n;
/// n at most kLargestDense.
inline constexpr int kLargestDense = 64;
void dense_product(int n, int stride, const double* columns, const double* x, double* out);

/// What a step adds to the energy balance [J].
struct StepWork {
  double input = 0.0;        ///< sum (z_1 - z_0) (p_0 + p_1)/2
  double dissipated = 0.0;   ///< sum (z_1 - z_0) (cv_0 + cv_1)/2
};
StepWork step_work(int n, const double* z_0, const double* z_1, const double* p_0, const double* p_1,
                   const double* cv_0, const double* cv_1);
/// sum x_i y_i.
double dot(int n, const double* x, const double* y);

}  // namespace drev
