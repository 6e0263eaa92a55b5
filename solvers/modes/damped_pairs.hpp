#pragma once
/// DampedPairs: damped modes of large systems, one by one, each from a guess (the undamped mode, or the same
/// mode at a neighbouring speed):
///
///   S(s) x = 0,  S(s) = K + i L + s C + s^2 M
///   x <- S(s)^-1 (C + 2 s M) x,   s <- the root of x' S(s) x = 0 next to s       (x' without conjugation)
///
/// Each step takes one complex elimination, whose cost on chains and trees of shafts is proportional to the
/// number of nodes. Since the matrices are symmetric, x' S x is stationary at a mode and s converges
/// cubically. Where damping is light, the mode found is that of the guess; strong damping between modes may
/// lead two guesses to one mode, which the caller detects by lambda. L is the loss of complex stiffnesses. Matrices may depend on the frequency Im s of the mode:
/// each step takes them anew, and their derivatives are left out. Where they are far from those of the guess, part goes from 0 to 1
/// in steps, each of which starts at the mode of the one before.
/// Source: P. Lancaster, Lambda-matrices and Vibrating Systems, Pergamon, 1966, section 7.3 (generalised Rayleigh
/// quotients), section 4.3 (residues).
#include <drev/core/system.hpp>
#include <drev/solvers/modes/damped_modes.hpp>

#include <complex>
#include <functional>
#include <vector>

#include "solvers/linear/complex_elimination.hpp"

namespace drev {

/// Values on System::pattern(). They hold until the next are asked for.
struct ModeMatrices {
  const Vector &damping, &stiffness;
  const Vector& loss;  ///< empty: none
};

/// A damped mode, the first, and those that coincide with it.
struct DampedPole {
  Vector damping;  ///< C, values on the pattern, with which these are damped modes
  Eigen::VectorXcd lambda;
  Eigen::MatrixXcd shapes;  ///< over the unknowns
};

/// The lambda of a set's modes, as DampedPairs takes them.
Eigen::VectorXcd lambda_of(const DampedModeSet& set);

class DampedPairs {
 public:
  static constexpr double kSameMode = 1e-9;  ///< relative difference of lambda of one and the same mode [-]
  /// held: unknowns at rest, one flag each; empty: none.
  explicit DampedPairs(const System& system, const std::vector<bool>& held = {});
  /// matrices: of a mode of frequency omega > 0 [rad/s]. lambda [1/s], Im > 0, and shape over the unknowns: a guess in, the
  /// mode out. False: no convergence to one with Im > 0, and both are as the last step left them.
  bool refine(const std::function<ModeMatrices(double omega)>& matrices, std::complex<double>& lambda,
              Eigen::VectorXcd& shape);
  /// Matrices of a mode of frequency omega > 0 [rad/s], at part 0 those of the guess and at part 1 those wanted.
  using Path = std::function<ModeMatrices(double part, double omega)>;
  static constexpr int kFewSteps = 8;  ///< from 0 to 1
  /// Takes a mode on from part 0 to part 1 in steps. False: lost on the way, and both are as given.
  bool take_on(const Path& matrices, int steps, std::complex<double>& lambda, Eigen::VectorXcd& shape);
  /// Takes all modes on, those of |lambda| up to `highest` [1/s] in steps small enough that no two of them become the same one. Modes above
  /// it that are lost on the way stay as they are. False: some below it are lost, and their lambda is 0.
  bool take_all_on(const Path& matrices, double highest, const std::function<void()>& pause,
                   Eigen::VectorXcd& lambda, Eigen::MatrixXcd& shapes);
  /// Of the response z(s) to forces p that grow as exp(s t), the residue at the pole. The matrices are symmetric: of a mode of
  /// its own x x' p / x' (2 lambda M + C) x, of modes X that coincide X N^-1 X' p, N_ij = x_i' ((lambda_i + lambda_j) M + C) x_j.
  Eigen::VectorXcd residue(const DampedPole& pole, const Eigen::VectorXcd& p) const;

 private:
  const SparseMatrix& pattern_;
  Vector mass_;
  ComplexElimination elimination_;
  Vector damping_, stiffness_;  // with the loss
};

}  // namespace drev
