#pragma once
/// How far a reduced run is off: the next modes of the full system, driven by the forces of the reduced run.
///
///   z_j'' + d_j z_j' + omega_j^2 z_j = psi_j' (p - sum b (y - k b' q) - C q') + d_j psi_j' M q'
///   e = sum_j psi_j (z_j - psi_j' M q),     q = R y of the reduced run,  d_j = psi_j' C psi_j
///
/// with forces straight between the points that observers see. e is the error that these modes leave; what
/// lies beyond them, if anything, is taken as large as what their upper half leaves, which holds where shares
/// fall as 1/omega^2 or faster. The estimate is 1.5 times the sum. With laws that are not linear, which shift
/// their changes and so change everything, it is twice the sum, and no less, relative to the peak, than the
/// worst error of such laws' forces relative to the largest of them (by F^2/k). It is no bound, and knows
/// nothing of the growth of differences in motions that are sensitive to their start (error_growth.hpp).
#include <drev/core/assembler.hpp>
#include <drev/core/channel.hpp>
#include <drev/core/error.hpp>
#include <drev/solvers/reduction/reduction.hpp>
#include <drev/solvers/run/estimate.hpp>
#include <drev/solvers/run/evaluated_state.hpp>
#include <drev/solvers/run/observer.hpp>

#include <optional>
#include <string>
#include <vector>

namespace drev {

/// Shares of modes, columns over the unknowns, in a channel: value = sum z_j e_j + v_j e_j', for a law's
/// force times its slopes. False for channels that are no deviation, rate, shaft's torque, force or
/// deflection.
bool modal_shares(const System& system, const Channel& channel, const Eigen::MatrixXd& modes, Vector& z,
                  Vector& v);
/// What is said of those.
Finding no_estimate(const std::string& place, const Channel& channel);

class TruncationError final : public Observer {
 public:
  /// Of a run of reduction.system from the model's initial conditions. Both must live as long. count: modes
  /// followed beyond those kept; 0: twice as many as are kept and 20. channels: deviations, rates, shaft
  /// torques, forces and deflections of laws; throws ModelError for others.
  TruncationError(const System& full, const Reduction& reduction, const std::vector<std::string>& channels,
                  int count = 0);

  void start(const Assembler& assembler, const EvaluatedState& point) override;
  void step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) override;
  bool needs_acceleration() const override { return false; }  // modal_shares() refuses what does

  /// Of each channel the largest |value| of the reduced run at the points seen, which is its scale, too, with
  /// the estimate of the largest error over the run; of the channel's name and unit.
  std::vector<Figure> estimates() const;

 private:
  struct Watched {
    std::string name = {};
    std::optional<Channel> channel = {};  // of the reduced system; none: the force of `law`
    int law = -1;                         // whose slopes make its force of an error of deflection
    Vector z = {}, v = {};                // shares of the modes
    double peak = 0.0, all = 0.0, upper = 0.0;
  };
  Vector force(const EvaluatedState& point);
  void watch(const Assembler& assembler, const EvaluatedState& point);

  const System& full_;
  const Eigen::MatrixXd& basis_;
  Assembler assembler_;                                     // of the full system
  Eigen::MatrixXd modes_, by_mass_, by_damping_, by_laws_;  // psi, psi' M R, what of C is left, psi' b
  Vector lambda_, damping_, z_, v_, force_;
  std::vector<Watched> watched_;
  std::size_t asked_ = 0;  // of watched_; behind them the laws that are not linear
  bool all_followed_ = false;
};

}  // namespace drev
