#pragma once
/// The arithmetic of a step of the generalized-alpha family (step_scheme.hpp) and of its energy balance
/// (energy_monitor.hpp) for kLanes variants at once: step_solver.hpp and step_equation.hpp in lanes.
#include <array>

#include "solvers/energy_monitor.hpp"
#include "solvers/lane_laws.hpp"
#include "solvers/step_scheme.hpp"

namespace drev {

/// M, C, K on the union of their nonzero entries in all lanes.
struct LaneMatrices {
  explicit LaneMatrices(const std::array<const System*, kLanes>& systems);
  /// Values of w.m M + w.c C + w.k K on the pattern.
  void combine(const Weights& w, LaneArray& values) const;

  int n = 0;
  SparseMatrix pattern;
  LaneArray mass, damping, stiffness;
  /// Of M and C, where they hold nothing else; else empty. A block wants to stay in the nearest cache.
  LaneArray mass_diagonal, damping_diagonal;
};

/// StepPoint in lanes; total is there with alpha_f != 0 only, kz not at all.
struct LanePoint {
  LaneArray z, v, a, p, cv, total;
  LanePointLaws laws;
  /// Copies a lane from and to a point of one variant.
  void get(int lane, StepPoint& point) const;
  void set(int lane, const StepPoint& point);
};

/// EnergyBalance in lanes.
struct LaneEnergy {
  LaneRow start, kinetic, stored, input, dissipated, imbalance, worst, worst_time, given, scale;
  EnergyBalance get(int lane) const;
  void set(int lane, const EnergyBalance& balance);
};

/// The step's motion with a = 0 and its known right side.
struct LanePrediction {
  LaneArray z_0, v_0, known;
};
/// to's z: where loads are looked up first, with the acceleration so far; v too, if rates are wanted.
void predict(const LaneMatrices& matrices, const StepScheme& scheme, double h, const LanePoint& from,
             bool rates, LanePrediction& step, LanePoint& to);

/// a -= phi W lambda, W by rows, then z from a; v too, if rates are wanted.
void correct(const StepScheme& scheme, double h, const LanePrediction& step, const LaneArray& w,
             const LaneArray& lambda, bool rates, LanePoint& to);

/// Everything else at the step's end, whose z, a, p and laws are there; by: B y. In the lanes that are good,
/// enters the step, ending at t, into the balance, with extra input [J] of the laws, and the forces into the
/// largest so far. Lanes with a number that is not finite are taken from good.
void finish(const LaneMatrices& matrices, const StepScheme& scheme, double h, double t,
            const LanePoint& from, const LanePrediction& step, const LaneForces& by,
            const LaneRow& extra_input, LanePoint& to, LaneMask& good, LaneEnergy& energy,
            LaneRow& force_scale);

}  // namespace drev
