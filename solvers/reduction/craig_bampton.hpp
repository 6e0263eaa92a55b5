#pragma once
/// The Craig-Bampton basis of a system: static shapes of its kept unknowns and modes with them held.
/// Internal to reduction.cpp.
#include <drev/core/system.hpp>

#include "solvers/linear/sparse_cholesky.hpp"

namespace drev {

/// Unknowns of the named nodes and of those of laws, their phases and general elements, ascending.
std::vector<int> nodes_to_keep(const System& system, const std::vector<std::string>& names);

class CraigBampton {
 public:
  /// Throws SolverError where a part hangs on no kept unknown.
  CraigBampton(const System& system, std::vector<int> kept);

  /// Kept unknowns first. modes: with them held, or where 0 those up to a frequency.
  Eigen::MatrixXd basis(int modes, double up_to_Hz);
  int modes() const { return modes_; }
  int boundary() const { return static_cast<int>(kept_.size()); }
  double first_left_out_Hz() const { return first_left_out_Hz_; }

 private:
  void find_modes(int count);

  const System& system_;
  std::vector<int> kept_, inside_;
  SparseMatrix stiffness_, mass_, boundary_stiffness_;  // K_ii, M_ii on one pattern, K_ib
  SparseCholesky factor_;                               // of K_ii
  Vector lambda_;                                       // the lowest, of the unknowns inside
  Eigen::MatrixXd vectors_;
  int modes_ = 0;
  double first_left_out_Hz_ = 0.0;
};

}  // namespace drev
