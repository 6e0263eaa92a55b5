#pragma once
/// Static equilibrium with contact:  K z + sum_j b_j y_j(x_j, 0) = p(q)  at a given nominal angle, or under the
/// mean of p over a time.
#include <drev/core/state.hpp>
#include <drev/solvers/contact/newton_options.hpp>
#include <drev/solvers/run/peak.hpp>

#include <memory>
#include <vector>

namespace drev {

class Assembler;
class Channel;
class SparseNewton;

struct StaticOptions {
  double nominal_angle = 0.0;  ///< rad, of the reference shaft
  double t = 0.0;              ///< s, for loads and known motions that depend on time
  /// > 0: moving with the nominal motion from t on, under the mean over this time [s] of what acts where
  /// nothing deviates, at the nominal speed and acceleration of t; nominal_angle has no meaning then.
  double mean_over = 0.0;
  SparseNewtonOptions newton = {};
};

struct StaticResult {
  State state;  ///< z of the equilibrium; rates zero
  int iterations = 0;
};

/// Finds the equilibrium for many angles of one System with one set-up.
class StaticSolver {
 public:
  /// Throws SolverError if a part of the model floats even with every contact closed: then there is no
  /// equilibrium, or infinitely many. The message names the parts.
  explicit StaticSolver(const System& system);
  ~StaticSolver();

  /// Throws SolverError, with the angle, if Newton does not converge.
  StaticResult solve(const StaticOptions& options = {});
  /// Stands at the state solved last.
  const Assembler& assembler() const { return *assembler_; }

 private:
  const System& system_;
  std::unique_ptr<Assembler> assembler_;
  std::unique_ptr<SparseNewton> newton_;
  /// Mean of p over [t, t + length], where nothing deviates; the assembler is left at t.
  Vector mean_loads(double t, double length);

  Vector start_, zero_;
  double shift_ = 0.0;
};

/// Equilibrium at one angle.
StaticResult solve_static(const System& system, const StaticOptions& options = {});

/// Largest and smallest static values of channels while the reference shaft turns from angle_0 to angle_1
/// [rad] in `count` >= 1 equal parts; Peak::max_time and min_time are then the angles.
std::vector<Peak> static_sweep(const System& system, const std::vector<Channel>& channels, double angle_0,
                               double angle_1, int count);

}  // namespace drev
