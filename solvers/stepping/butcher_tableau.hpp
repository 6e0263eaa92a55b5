#pragma once
/// Runge-Kutta methods as one family, applied to z' = v, M v' = -F(t, z, v):
///
///   z_i = z_0 + h sum_j a_ij v_j,   v_i = v_0 + h sum_j a_ij a_j,   t_i = t_0 + c_i h
///
/// a is lower triangular. A stage with a_ii = 0 is an evaluation, a stage with a_ii = g > 0 (one g a method)
/// an equation with M + g h C + g^2 h^2 K. Implicit methods are stiffly accurate: their last stage is the
/// step's end. Explicit ones add the evaluation at the end, with which the next step begins.
#include <drev/core/system.hpp>

#include <Eigen/Core>
#include <string>

namespace drev {

struct ButcherTableau {
  std::string name;
  int order = 0;
  Eigen::MatrixXd a;  ///< s x s
  Vector b, c;
  /// Weights of the stages' rates in the local error of the embedded formula, e_i = b_i - b^_i (explicit: one
  /// more for the rate at the end). Empty: none.
  Vector e;
  /// Weights of values at the stages that carry on their polynomial to the start; empty where a stage is there.
  Vector to_start = {};

  bool starts_late() const { return to_start.size() > 0; }
  int stages() const { return static_cast<int>(b.size()); }
  double diagonal() const { return a(a.rows() - 1, a.rows() - 1); }
};

/// Trapezoidal rule over gamma h, then a three-point formula over h, gamma = 2 / (2 + sqrt(2 + 2 rho_inf)),
/// with which both have one matrix; spectral radius at infinity rho_inf. rho_inf = 0 is TR-BDF2 with
/// gamma = 2 - sqrt 2. Third-order embedded formula: quadrature over 0, gamma, 1.
/// Sources: G. Noh, K.-J. Bathe, The Bathe time integration method with controllable spectral radius: the
/// rho_inf-Bathe method, Comput. Struct. 212, 2019, doi:10.1016/j.compstruc.2018.11.001; M. E. Hosea,
/// L. F. Shampine, Analysis and implementation of TR-BDF2, Appl. Numer. Math. 20, 1996,
/// doi:10.1016/0168-9274(95)00115-8.
ButcherTableau bathe_tableau(std::string name, double rho_inf);

/// Five stages, g = 1/4, L-stable, fourth order with an embedded formula of third. Source: E. Hairer,
/// G. Wanner, Solving Ordinary Differential Equations II, Springer 1996, table IV.6.5.
ButcherTableau sdirk4_tableau();

/// The classical method, fourth order. omega h < 2 sqrt 2.
ButcherTableau rk4_tableau();

/// Fifth order with an embedded formula of fourth. Source: J. R. Dormand, P. J. Prince, A family of embedded
/// Runge-Kutta formulae, J. Comput. Appl. Math. 6, 1980, doi:10.1016/0771-050X(80)90013-3.
ButcherTableau dormand_prince_tableau();

}  // namespace drev
