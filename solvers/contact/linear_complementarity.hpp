#pragma once
/// The linear complementarity problem: find z with
///
///   w = M z + q >= 0,      z >= 0,      w_i z_i = 0 for every i
///
/// by Lemke's method: complementary pivots from an artificial variable, with the lexicographic rule of choice, so that
/// it ends although ratios are equal (a train at rest without load). It finds a solution where M is a P-matrix or
/// copositive-plus and the problem can be solved at all.
///
/// Source: R. W. Cottle, J.-S. Pang, R. E. Stone, The Linear Complementarity Problem, Academic Press, 1992, chapter 4.
#include <Eigen/Core>
#include <optional>
#include <vector>

namespace drev {

struct ComplementarySolution {
  Eigen::VectorXd z;
  std::vector<char> basic;  ///< 1: w_i = 0 is what holds; 0: z_i = 0 exactly
};

/// nullopt: the method ends on a ray, so that there is no solution or M is none of the matrices above.
std::optional<ComplementarySolution> solve_complementarity(const Eigen::MatrixXd& m,
                                                           const Eigen::VectorXd& q);
/// The same by trying every set of basic variables, whatever M is: those first that differ at the fewest places from `wanted`, 0 or 1 by
/// variable, any other number where it does not matter. Sets whose equations depend on each other within rounding are left
/// out: what each of their variables is would be chance. nullopt: there is no solution, or more than kMostTried variables.
inline constexpr int kMostTried = 12;
std::optional<ComplementarySolution> try_every_set(const Eigen::MatrixXd& m, const Eigen::VectorXd& q,
                                                   const std::vector<char>& wanted);

}  // namespace drev
