#pragma once
/// DampedPairs: damped modes of large systems, one by one, each from a guess (the undamped mode, or the same
/// mode at a neighbouring speed):
///
///   S(s) x = 0,  S(s) = K + s C + s^2 M
///   x <- S(s)^-1 (C + 2 s M) x,   s <- the root of x' S(s) x = 0 next to s       (x' without conjugation)
///
/// Each step takes one complex elimination, whose cost on chains and trees of shafts is proportional to the
/// number of nodes. Since the matrices are symmetric, x' S x is stationary at a mode and s converges
/// cubically. Where damping is light, the mode found is that of the guess; strong damping between modes may
/// lead two guesses to one mode, which the caller detects by lambda. Matrices may depend on the frequency Im s of the mode:
/// each step takes them anew, and their derivatives are left out.
/// Source: P. Lancaster, Lambda-matrices and Vibrating Systems, Pergamon, 1966, section 7.3 (generalised Rayleigh
/// quotients), section 4.3 (residues).
#include <drev/core/system.hpp>

#include <complex>
#include <functional>
#include <vector>

#include "solvers/linear/complex_elimination.hpp"

namespace drev {

struct SweepModes;

/// Values on System::pattern(). They hold until the next are asked for.
struct ModeMatrices {
  const Vector &damping, &stiffness;
};

/// A damped mode, the first, and those that coincide with it.
struct DampedPole {
  Vector damping;  ///< values on the pattern at which these are damped modes
  Eigen::VectorXcd lambda;
  Eigen::MatrixXcd shapes;  ///< over the unknowns
};

class DampedPairs {
 public:
  explicit DampedPairs(const System& system);
  /// matrices: of a mode of frequency omega > 0 [rad/s]. lambda [1/s], Im > 0, and shape over the unknowns: a guess in, the
  /// mode out. False: no convergence to one with Im > 0, and both are as the last step left them.
  bool refine(const std::function<ModeMatrices(double omega)>& matrices, std::complex<double>& lambda,
              Eigen::VectorXcd& shape);
  /// Of the response z(s) to forces p that grow as exp(s t), the residue at the pole. The matrices are symmetric: of a mode of
  /// its own x x' p / x' (2 lambda M + C) x, of modes X that coincide X N^-1 X' p, N_ij = x_i' ((lambda_i + lambda_j) M + C) x_j.
  Eigen::VectorXcd residue(const DampedPole& pole, const Eigen::VectorXcd& p) const;

 private:
  const SparseMatrix& pattern_;
  Vector mass_;
  ComplexElimination elimination_;
};

/// The modes of a sweep with their shapes, for each of the modes' speeds.
struct DampedPoles {
  DampedPairs pairs;
  std::function<ModeMatrices(double speed, double omega)> matrices;
  std::vector<double> jumps = {};  ///< speeds on both sides of those at which a load's slope or size jumps
  std::vector<Eigen::VectorXcd> lambda = {};  ///< of modes that coincide all; 0: not known
  std::vector<Eigen::MatrixXcd> shapes = {};  ///< over the unknowns
  /// A mode at a speed with the matrices there, from the nearest of the modes' speeds, at which it oscillates. Where no mode is found
  /// from there, or another one, the mode is that between the modes' speeds, with the damping and the shape of the nearest.
  DampedPole at(const SweepModes& modes, Eigen::Index mode, double speed);
};

}  // namespace drev
