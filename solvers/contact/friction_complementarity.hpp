#pragma once
/// What contacts at rest and gears with losses ask together at one instant: for W symmetric and positive semi-definite
/// find lambda with
///
///   a = r - W lambda
///   contact between bounds     a_i > 0 only where lambda_i = high_i,     a_i < 0 only where lambda_i = low_i
///   tie (low, high infinite)   a_i = 0
///   loss of a gear             the same between bounds that follow the torque of its tie, lambda_t:
///                                high = max_j (k_j lambda_t + c_j),    low = min_j (k_j lambda_t + c_j)
///                              or, where the gear turns, lambda_i on the bound against its direction, whatever a_i is
///
/// With c - u for each torque and the accelerations split into their signs this is a linear complementarity problem
/// (linear_complementarity.hpp); ties are eliminated first. Unlike that of friction alone it is no minimum of
/// anything: a force that grows with the load it causes is not symmetric. It has one motion for efficiencies of 0 to 1;
/// where self-locking gears have no solution, or several, they jam.
///
/// Source: F. Pfeiffer, Ch. Glocker, Multibody Dynamics with Unilateral Contacts, 1996, chapter 5.
#include "solvers/contact/box_complementarity.hpp"

namespace drev {

struct GearLossRow {
  /// lambda = slope * lambda_tie + constant; `number` is the caller's.
  struct Line {
    double slope = 0.0, constant = 0.0;
    int number = 0;
  };
  Eigen::Index loss = 0, tie = 0;         ///< rows of the problem
  std::vector<Line> high = {}, low = {};  ///< one or two each; none: no such bound
  int turns = 0;                          ///< 1: stands on high, -1: on low; 0: at rest
};

struct FrictionSolution {
  Eigen::VectorXd lambda, a;
  std::vector<int> side;  ///< of each row: 1 on its high bound, -1 on its low one, 0 between
  std::vector<int> line;  ///< of each gear: number of the line that its bound is on; -1: between
};

/// low and high of rows that are losses are not read. Throws SolverError where no solution is found.
FrictionSolution solve(const BoxComplementarity& problem, const std::vector<GearLossRow>& gears);

}  // namespace drev
