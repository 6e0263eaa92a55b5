#pragma once
/// Matrices of a Spec with every contact closed, and their eigenvalues, in extended precision.
#include <complex>
#include <vector>

#include "tests/stability/coverage/series.hpp"
#include "tests/stability/coverage/spec.hpp"

namespace coverage {

/// M (diagonal), C and K over the nodes that are neither prescribed nor driven by an ideal gear.
class LinearModel {
 public:
  explicit LinearModel(const Spec& spec);
  int size() const { return static_cast<int>(mass.size()); }
  std::vector<Real> mass;
  std::vector<std::vector<Real>> damping, stiffness;

 private:
  void add(int a, Real r_a, int b, Real r_b, Real k, Real c);
  std::vector<int> unknown_;
  std::vector<Real> factor_;
};

/// omega^2, by Jacobi's method on M^-1/2 K M^-1/2.
std::vector<Real> symmetric_eigenvalues(const LinearModel& m);
/// The 2 n values lambda of lambda^2 M + lambda C + K, by the QR algorithm with shifts.
std::vector<std::complex<Real>> quadratic_eigenvalues(const LinearModel& m);

}  // namespace coverage
