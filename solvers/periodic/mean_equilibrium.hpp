#pragma once
/// Static equilibrium of a drivetrain under mean torques with contacts closed, where parts of it may float
/// freely:
///
///   K z = p - sum_f s_f lambda_f,   r_f' (p - sum s lambda) = 0,   z = 0 at one node of each part f
///
/// r_f: rigid-body motion of the part, 1 where the reference shaft turns by 1. lambda_f takes up the
/// unbalanced torque, in one of three ways: s = M r, the part speeds up; s = the row of a node whose torque
/// balances it; or, for a part that only dampers tie to the rest (a damper's ring), s = C r, the part runs at
/// the mean speed at which the damper torques balance.
#include <drev/core/assembler.hpp>
#include <drev/core/error.hpp>

#include <string>
#include <vector>

#include "solvers/linear/complex_elimination.hpp"

namespace drev {

class MeanEquilibrium {
 public:
  /// damping, stiffness: values on the pattern, with contacts closed. balance: name of the balancing node, or
  /// empty; faults of it are added to findings. Throws SolverError where the stiffness is singular although
  /// no part floats.
  MeanEquilibrium(const System& system, const Vector& damping, const Vector& stiffness,
                  const std::string& balance, std::vector<Finding>& findings);

  const std::vector<std::string>& floating() const { return floating_; }
  const std::vector<Vector>& rigid() const { return rigid_; }
  /// p -> z. left: receives the unbalanced torque of each floating part, r_f' p [N m at the reference shaft];
  /// null if not wanted.
  void solve(Vector& p, Vector* left);

 private:
  void drag_along(Vector& p) const;

  const System& system_;
  Assembler assembler_;
  Vector damping_;
  ComplexElimination elimination_;
  std::vector<std::string> floating_;
  std::vector<Vector> rigid_;                // rigid-body motion of each floating part: ratios of its nodes
  std::vector<std::size_t> dragged_;         // floating parts that do not turn with the reference shaft
  std::vector<std::vector<Entry>> balance_;  // for each part: row of the node whose torque balances it
  std::vector<std::complex<double>> z_;
};

}  // namespace drev
