#pragma once
/// The inner loops of a step over all unknowns, for a processor's widest vectors (core/lanes.hpp).
#include <vector>

namespace drev {

/// z_0 = z + h v + c_z a, v_0 = v + c_v a.
void predict_motion(int n, double h, double c_z, double c_v, const double* z, const double* v,
                    const double* a, double* z_0, double* v_0);
/// z = z_0 + c_z a, v = v_0 + c_v a; returns the largest change of z, NaN if z is or was not finite.
double correct_motion(int n, double c_z, double c_v, const double* z_0, const double* v_0,
                      const double* a, double* z, double* v);
/// out = y + factor x.
void sum_with(int n, const double* y, double factor, const double* x, double* out);
/// total + p - cv, which is what the springs and laws give; cv null: 0.
void elastic_forces(int n, const double* total, const double* p, const double* cv, double* out);
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

/// A diagonal of a symmetric matrix and its mirror image: values_i stands at (i, i + offset) and
/// (i + offset, i).
struct Band {
  int offset = 0;  ///< >= 0
  std::vector<double> values;
};
/// out = y + factor A x for the bands of A, by growing offsets; y null: 0. x, y and out are different.
void band_product(int n, const std::vector<Band>& bands, double factor, const double* x, const double* y,
                  double* out);
/// x' A x.
double band_energy(int n, const std::vector<Band>& bands, const double* x);

/// What a step adds to the energy balance, and what is stored at its end [J].
struct StepWork {
  double input = 0.0;       ///< sum (z_1 - z_0) (p_0 + p_1)/2
  double dissipated = 0.0;  ///< sum (z_1 - z_0) (cv_0 + cv_1)/2; 0 where the cv are null
  double stored = 0.0;      ///< sum z_1 kz_1/2
};
StepWork step_work(int n, const double* z_0, const double* z_1, const double* p_0, const double* p_1,
                   const double* cv_0, const double* cv_1, const double* kz_1);
/// sum x_i y_i.
double dot(int n, const double* x, const double* y);

}  // namespace drev
