#pragma once
/// Any other element: a local force with both tangents over its own nodes, and history.
#include <Eigen/Core>
#include <span>

namespace drev {

inline constexpr int kMaxLocalDofs = 8;  ///< fixed capacity: no heap in assembly
using LocalVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxLocalDofs, 1>;
using LocalMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxLocalDofs, kMaxLocalDofs>;

/// What the element sees: its own nodes at one instant, in its own order.
struct LocalState {
  double t = 0.0;                   ///< s
  LocalVector q, v;                 ///< deviations [rad or m] and their rates
  std::span<const double> history;  ///< as left by the last accepted step
};

/// What the element returns (zeroed before the call): M a + f(q, v, t) = p, f on the LEFT.
struct LocalResponse {
  LocalVector f;                   ///< N m or N
  LocalMatrix stiffness, damping;  ///< df/dq, df/dv
  std::span<double> history;       ///< written: the history if this step is accepted
  /// Both enter the energy balance: an element that leaves them at zero ends every run as energy_error.
  double stored_energy = 0.0;     ///< J
  double dissipated_power = 0.0;  ///< W, >= 0 for a passive element
};

class GeneralForce {
 public:
  virtual ~GeneralForce() = default;
  /// Pure: same state in, same response out.
  virtual void evaluate(const LocalState& state, LocalResponse& response) const = 0;
  virtual int history_size() const { return 0; }
  virtual void initial_history(std::span<double> /*history*/) const {}
  /// False: Newton uses an unsymmetric factorisation (KLU).
  virtual bool symmetric_tangent() const { return true; }
};

}  // namespace drev
