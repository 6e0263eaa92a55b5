#pragma once
/// What the modes that a modal reduction leaves out give under constant forces. Internal to reduction.cpp
/// and reduction_choice.cpp.
#include <drev/core/system.hpp>

namespace drev {

/// Rigid and the lowest elastic modes, contacts closed: columns x, x' M x = 1.
struct KeptModes {
  Eigen::MatrixXd vectors;
  Vector lambda;  ///< (rad/s)^2, 0 of the rigid ones
  int rigid = 0, elastic = 0;
  double first_left_out_Hz = 0.0;  ///< infinite where none is
};
/// count elastic modes, or where count is 0 those up to a frequency.
KeptModes kept_modes(const System& system, int count, double up_to_Hz);

struct ResidualVectors {
  Eigen::MatrixXd columns;  ///< x' M x = 1, M- and K-orthogonal to each other and to the modes
  double error = 0.0;       ///< what is missing under the sampled loads, relative, in the energy norm
};
/// accuracy: of the deflection under the loads.
ResidualVectors residual_vectors(const System& system, const KeptModes& modes, double accuracy);

/// Torques of the loads over the unknowns, at rest, at even times in (0, duration): one column a sample; no
/// column without loads.
Eigen::MatrixXd sampled_loads(const System& system, double duration, int count);

}  // namespace drev
