#pragma once
/// A system whose lossy gears are ideal ones: the ties that exact propagation holds by torques (friction.hpp) are
/// eliminated, z = basis y. Modes are found in it; the gears' losses are left out. Internal to modes.cpp and
/// damped_modes.cpp.
#include <drev/core/system.hpp>

#include <optional>

namespace drev {

struct TiedSystem {
  System system;
  Eigen::MatrixXd basis;
};

/// nullopt: the system has no lossy gear. Throws SolverError where a planetary set is in it, too.
std::optional<TiedSystem> tied_system(const System& system);

}  // namespace drev
