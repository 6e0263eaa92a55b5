#pragma once
/// The modes of a sweep with their shapes, for each of the modes' speeds.
#include "solvers/modes/damped_pairs.hpp"

namespace drev {

struct SweepModes;

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
