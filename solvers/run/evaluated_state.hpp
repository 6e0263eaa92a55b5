#pragma once
/// A point of a run: a state with everything that was evaluated at it.
#include <drev/core/scalar_force.hpp>
#include <drev/core/state.hpp>

#include <vector>

namespace drev {

class Assembler;

/// A state with everything that was evaluated at it.
struct EvaluatedState {
  State state;
  /// s; generalized-alpha's own a is of a time (alpha_m - alpha_f) times this later. 0: a is of state.t.
  double a_step = 0.0;
  Vector p;                         ///< loads and known motions, right side
  Vector kz, cv;                    ///< K z, C v
  Vector total;                     ///< C v + K z + B y + general - p
  std::vector<ScalarInput> inputs;  ///< per scalar term
  std::vector<ScalarResponse> responses;
  double general_energy = 0.0;  ///< J, stored in general elements
  double general_power = 0.0;   ///< W, dissipated there
};

/// Zeros for n unknowns where a vector has no entries yet.
void make_room(EvaluatedState& point, int n);
/// Inputs and responses of all laws at the point's motion and the assembler's time.
void evaluate_laws(const Assembler& assembler, EvaluatedState& point);
/// f += factor B y with the point's responses.
void add_law_forces(const System& system, const EvaluatedState& point, double factor, Vector& f);

}  // namespace drev
