#pragma once
/// The arithmetic of a step of the generalized-alpha family (step_scheme.hpp) and of its energy balance
/// (energy_monitor.hpp) for kLanes variants at once: generalized_alpha.hpp and step_equation.hpp in lanes.
#include <drev/solvers/stepping/step_scheme.hpp>

#include <array>

#include "solvers/batch/lane_laws.hpp"
#include "solvers/run/energy_monitor.hpp"

namespace drev {

/// M, C, K on the union of their nonzero entries in all lanes.
struct LaneMatrices {
  explicit LaneMatrices(const std::array<const System*, kLanes>& systems);
  /// Values of w.m M + w.c C + w.k K on the pattern.
  void combine(const Weights& w, LaneArray& values) const;

  int n = 0;
  SparseMatrix pattern;
  LaneValues mass, damping, stiffness;
  /// Of M and C, where they hold nothing else; else empty.
  LaneValues mass_diagonal, damping_diagonal;
  bool common = false;  ///< all are the same in all lanes
  /// Mostly a chain in its own order: the pattern holds the diagonal and both its neighbours, whole.
  bool chain = false;
};

/// EvaluatedState in lanes; total is there with alpha_f != 0 only, kz and cv not at all.
struct LanePoint {
  LaneArray z, v, a, p, total;
  LanePointLaws laws;
  /// Copies a lane from and to a point of one variant.
  void get(int lane, EvaluatedState& point) const;
  void set(int lane, const EvaluatedState& point);
};

/// EnergyBalance in lanes.
struct LaneEnergy : Balance<LaneRow> {
  EnergyBalance get(int lane) const;
  void set(int lane, const EnergyBalance& balance);
};

/// The motion with a = 0 at the step's end goes to to's z and v; known: the known right side.
void predict(const LaneMatrices& matrices, const StepScheme& scheme, double h, const LanePoint& from,
             LaneArray& known, LanePoint& to);

/// a -= factor W lambda, W by rows. change: largest |a - before|.
void correct(double factor, const LaneValues& w, const LaneArray& lambda, const LaneRow* before, LaneArray& a,
             LaneRow& change);

/// Largest |x| and |x - y| in each lane.
void largest(const LaneArray& x, LaneRow& out);
void largest_difference(const LaneArray& x, const LaneArray& y, LaneRow& out);

/// Everything else at the step's end: to has its a, p and laws, and the motion with a = 0; by: B y. In the
/// lanes that are good, enters the step, ending at t, into the balance, with extra input [J] of the laws, and
/// the forces into the largest so far. Lanes with a number that is not finite are taken from good.
void finish(const LaneMatrices& matrices, const StepScheme& scheme, double h, double t, const LanePoint& from,
            const LaneForces& by, const LaneRow& extra_input, LanePoint& to, LaneMask& good,
            LaneEnergy& energy, LaneRow& force_scale);

}  // namespace drev
