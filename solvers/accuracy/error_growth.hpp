#pragma once
/// How a small difference of the state grows along a run: what makes rattling trajectories comparable up to a
/// horizon only.
///
///   d_0 = 1e-9 of the largest |v| of the run, in an arbitrary direction of the rates;  run both for T / N;
///   d_k: the separation then, scaled back to d_0 without change of direction;  k = 1 ... N
///
/// The product of the d_k / d_0 is the growth, the mean of ln(d_k / d_0) N / T the rate, for long runs the
/// largest Lyapunov exponent. Separation: largest |dz| / largest |z| or |dv| / largest |v|. It starts in the rates alone: part of
/// the angles of a train that drifts, or of stiff shafts, is a twist that would grow into rates at once, in linear trains as well.
/// Source: G. Benettin, L. Galgani, A. Giorgilli, J.-M. Strelcyn, Lyapunov characteristic exponents for
/// smooth dynamical systems and for Hamiltonian systems, Meccanica 15, 1980, doi:10.1007/BF02128236.
#include <drev/core/state.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/run/estimate.hpp>

namespace drev {

struct ErrorGrowthOptions {
  /// Constant steps or exact: one that does the same for states that are nearly the same. Controlled steps do
  /// not (their error is far above d_0): the whole run is made with them, the pieces with constant steps of
  /// sdirk4, half as long as theirs in the mean.
  Method method;
  double t_end = 0.0;  ///< s
  int pieces = 400;    ///< N
  std::function<bool(double)> progress = {};
};

struct ErrorGrowth {
  std::vector<double> t;                ///< s, ends of the pieces that were run
  std::vector<double> growth;           ///< the largest separation up to t, over d_0
  double rate = 0.0;                    ///< 1/s
  double rate_error = 0.0;              ///< 1/s, half of the 95 % interval, by batch means
  double z_scale = 1.0, v_scale = 1.0;  ///< largest |z| and |v| of the run
  RunStatus status = RunStatus::success;
  std::string reason;  ///< why it ended early
  /// Factor up to t; 1 at least.
  double factor(double time) const;
  /// The first time at which a difference has grown by more than the factor; infinity: never in the run.
  double time_of(double factor) const;
};

ErrorGrowth measure_error_growth(const System& system, const ErrorGrowthOptions& options);

/// The model's initial state and beside it 1e-9 of the scales, in the i-th of arbitrary directions.
State neighbour(const System& system, int i, double z_scale, double v_scale);

/// Mean of samples in order of time, with its 95 % confidence interval by the means of batches and Student's
/// t. The interval is infinite with less than two samples.
Estimate batch_mean(const std::vector<double>& samples, int batches = 20);

}  // namespace drev
