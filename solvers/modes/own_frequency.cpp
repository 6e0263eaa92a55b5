#include "solvers/modes/own_frequency.hpp"

#include <drev/core/assembler.hpp>
#include <drev/core/error.hpp>
#include <drev/core/ritz_projection.hpp>
#include <drev/core/units.hpp>

#include <cmath>
#include <limits>

#include "solvers/linear/complex_stiffnesses.hpp"
#include "solvers/modes/damped_pairs.hpp"

namespace drev {

namespace {

using Complex = std::complex<double>;

constexpr double kStill = 1e-6;  // frequency that stands for 0 [rad/s]

Complex beyond_in_time(const System& system, const ComplexStiffnesses& stiffnesses, std::size_t term,
                       double omega) {
  return stiffnesses.beyond(term, omega, system.frequency_terms()[term].stiffness->load_in_matrices());
}

/// With Re k*(omega), and a damping added [values on the pattern; empty: none].
System spring_system(const System& system, const ComplexStiffnesses& stiffnesses, double omega,
                     const Vector& damping) {
  Vector no_loss = Vector::Zero(system.pattern().nonZeros()), added = no_loss;
  stiffnesses.add(
      1.0, [&](std::size_t t) -> Complex { return beyond_in_time(system, stiffnesses, t, omega).real(); },
      no_loss, added);
  return held_system(system, stiffnesses.held(), damping, added);
}

/// Columns over the unknowns that are not held, over all of them.
template <class Matrix>
Matrix with_held(const std::vector<bool>& held, const Matrix& columns) {
  Matrix all = Matrix::Zero(static_cast<Eigen::Index>(held.size()), columns.cols());
  for (Eigen::Index k = 0, row = 0; k < all.rows(); ++k)
    if (!held[static_cast<std::size_t>(k)]) all.row(k) = columns.row(row++);
  return all;
}

}  // namespace

ModeSet modes_at_own_frequency(const System& system, const ModesOptions& options) {
  constexpr double kSettled = 1e-13;  // last change of a frequency relative to it [-]
  constexpr double kSteepest =
      0.9;  // slope of the frequency found by the one assumed from which no secant is taken [-]
  constexpr int kMostSteps = 100;
  const ComplexStiffnesses stiffnesses(system);
  ModesOptions at_one = options;
  at_one.in_time = true;
  const auto modes_at = [&](double omega) {
    return solve_modes(spring_system(system, stiffnesses, omega, {}), at_one);
  };
  ModeSet modes = modes_at(kStill);
  bool constant = true;
  for (std::size_t t = 0; t < stiffnesses.count(); ++t) constant &= stiffnesses.constant(t);
  for (int m = 0; m < modes.count() && !constant; ++m) {
    at_one.count = m + 1;
    double assumed = modes.omega(m);
    ModeSet own = modes_at(assumed);
    for (int step = 0; std::abs(own.omega(m) - assumed) > kSettled * assumed; ++step) {
      if (step == kMostSteps)
        throw SolverError(
            "modes of " + system.name() + ": no frequency of mode " + std::to_string(m + 1) +
            " was found that it has with the stiffness of couplings at that frequency; it is near " +
            to_text(to_hz(assumed)) + " Hz");
      const double found = own.omega(m);
      own = modes_at(found);
      const double slope = (own.omega(m) - found) / (found - assumed);
      assumed = found;
      if (std::abs(slope) > kSteepest || step % 2 == 1) continue;
      assumed += (own.omega(m) - found) / (1.0 - slope);
      own = modes_at(assumed);
    }
    modes.frequency_Hz[idx(m)] = own.frequency_Hz[idx(m)];
    modes.error_Hz[idx(m)] = own.error_Hz[idx(m)];
    modes.shapes.col(m) = own.shapes.col(m);
    modes.vectors.col(m) = own.vectors.col(m);
  }
  modes.vectors = with_held(stiffnesses.held(), modes.vectors);
  if (modes.rigid_vectors.size() > 0)
    modes.rigid_vectors = with_held(stiffnesses.held(), modes.rigid_vectors);
  return modes;
}

DampedModeSet damped_modes_at_own_frequency(const System& system, const DampedModesOptions& options) {
  const ComplexStiffnesses stiffnesses(system);
  DampedModeSet set =
      solve_damped_modes(spring_system(system, stiffnesses, kStill, options.damping),
                         {.contact = options.contact, .size_limit = options.size_limit, .in_time = true});
  set.in_time = false;
  set.vectors = with_held(stiffnesses.held(), set.vectors);
  const Assembler assembler(system);
  Vector damping, stiffness, its_loss, its_stiffness;
  assembler.contact_values({0.0, 1.0, 0.0}, options.contact, damping);
  assembler.contact_values({0.0, 0.0, 1.0}, options.contact, stiffness);
  if (options.damping.size() > 0) damping += options.damping;
  DampedPairs pairs(system, stiffnesses.held());
  const auto matrices = [&](double part, double omega) -> ModeMatrices {
    its_loss.setZero(damping.size());
    its_stiffness = stiffness;
    stiffnesses.add(
        1.0,
        [&](std::size_t t) {
          const double still = beyond_in_time(system, stiffnesses, t, kStill).real();
          return still + part * (beyond_in_time(system, stiffnesses, t, omega) - still);
        },
        its_loss, its_stiffness);
    return {damping, its_stiffness, its_loss};
  };
  Eigen::VectorXcd lambda = lambda_of(set);
  if (!pairs.take_all_on(matrices, std::numeric_limits<double>::infinity(), {}, lambda, set.vectors))
    throw SolverError("damped modes of " + system.name() +
                      ": a mode was lost between the stiffness of couplings without loss and that with it");
  set.set_modes(system, lambda);
  return set;
}

}  // namespace drev
