#include "solvers/exact/start_state.hpp"

#include <drev/core/assembler.hpp>
#include <drev/core/error.hpp>

#include "solvers/exact/friction_series.hpp"
#include "solvers/linear/sparse_cholesky.hpp"

namespace drev {

void evaluate_start(const System& system, State& state) {
  SparseCholesky mass;
  mass.factorize(system.pattern(), system.mass_values());
  if (!mass.ok()) throw SolverError(system.name() + ": a node without inertia has no acceleration");
  Assembler assembler(system);
  assembler.set_time(state.t);
  FrictionSeries friction(system);
  EvaluatedState point;
  point.state = state;
  const auto evaluate = [&] {
    const State& s = point.state;
    evaluate_laws(assembler, point);
    point.p.setZero(system.size());
    assembler.external(s.z, s.v, point.p);
    assembler.multiply_stiffness(s.z, point.kz);
    assembler.multiply_damping(s.v, point.cv);
    point.total = point.kz + point.cv - point.p;
    add_law_forces(system, point, 1.0, point.total);
    friction.add_forces(s.history, point.total);
    mass.solve(-point.total, point.state.a);
  };
  evaluate();
  if (!friction.empty()) {
    friction.locate(assembler, point);
    friction.hold(assembler, point.state.v);
    evaluate();
  }
  state = std::move(point.state);
}

}  // namespace drev
