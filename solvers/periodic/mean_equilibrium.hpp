#pragma once
/// Mean deflections of a drivetrain under mean torques, contacts closed, where parts of it may float freely:
///
///   K z = p - sum_f s_f lambda_f,   r_f' (p - sum s lambda) = 0,   z = 0 at one node of each part f
///
/// r_f: the part's rigid motion, 1 where the reference shaft turns by 1. lambda_f takes up the torque that is left
/// over: s = M r, the part speeds up; or s = the row of a node that balances it; or, of a part that only dampers
/// tie to the rest (a damper's ring), s = C r, it runs at the mean speed at which their torques balance.
#include <drev/core/assembler.hpp>
#include <drev/core/error.hpp>

#include <string>
#include <vector>

#include "solvers/linear/complex_elimination.hpp"

namespace drev {

class MeanEquilibrium {
 public:
  /// damping, stiffness: values on the pattern, contacts closed. balance: a node's name, or empty; what is wrong
  /// with it goes to findings. Throws SolverError where the stiffness is singular although no part floats.
  MeanEquilibrium(const System& system, const Vector& damping, const Vector& stiffness,
                  const std::string& balance, std::vector<Finding>& findings);

  const std::vector<std::string>& floating() const { return floating_; }
  const std::vector<Vector>& rigid() const { return rigid_; }
  /// p -> z. left: of each floating part what was left over, r_f' p [N m at the reference shaft]; null: not wanted.
  void solve(Vector& p, Vector* left);

 private:
  void drag_along(Vector& p) const;

  const System& system_;
  Assembler assembler_;
  Vector damping_;
  ComplexElimination elimination_;
  std::vector<std::string> floating_;
  std::vector<Vector> rigid_;                // motion of each floating part, the ratios of its nodes
  std::vector<std::size_t> dragged_;         // those of them that do not turn with the reference shaft
  std::vector<std::vector<Entry>> balance_;  // of each part: row of the node that balances it
  std::vector<std::complex<double>> z_;
};

}  // namespace drev
