#pragma once
/// The linear complementarity problem between bounds that dry friction asks at one instant: for W symmetric and
/// positive semi-definite and r in its range, find lambda with
///
///   a = r - W lambda,     a_i > 0 only where lambda_i = high_i,     a_i < 0 only where lambda_i = low_i
///
/// These are the conditions of the convex problem min lambda^T W lambda/2 - r^T lambda, low <= lambda <= high
/// (Gauss's principle of least constraint), so that a solution exists and a is unique; lambda is not where W is
/// singular (two clutches side by side). Solved by the active-set method for bounded least squares: each outer
/// step frees one bound variable, each inner one binds at least one. The objective falls with every outer step,
/// so that no set of free variables occurs twice and the method ends. A variable is freed only where a_i differs
/// from 0, that is where its column is independent of the free ones: their matrix stays positive definite.
///
/// Source: C. L. Lawson, R. J. Hanson, Solving Least Squares Problems, 1974, chapter 23; P. B. Stark, R. L. Parker,
/// Bounded-variable least squares, Computational Statistics 10, 1995. Friction as such a problem: F. Pfeiffer,
/// Ch. Glocker, Multibody Dynamics with Unilateral Contacts, 1996; J. J. Moreau, 1966.
#include <Eigen/Core>
#include <vector>

namespace drev {

struct BoxComplementarity {
  Eigen::MatrixXd w;            ///< 1/(kg m^2) or 1/kg
  Eigen::VectorXd r;            ///< rad/s^2 or m/s^2
  Eigen::VectorXd low, high;    ///< N m or N; low <= high, either may be infinite
  Eigen::VectorXd rounding;     ///< |a_i| up to this is zero
  std::vector<char> free = {};  ///< variables to begin with as free ones; their columns must be independent
};

struct BoxSolution {
  Eigen::VectorXd lambda, a;
  std::vector<char> free;  ///< 1: between its bounds, with a = 0
};

/// Throws SolverError if rounding keeps it from ending.
BoxSolution solve(const BoxComplementarity& problem);

}  // namespace drev
