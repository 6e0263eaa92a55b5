#include <drev/core/assembler.hpp>
#include <drev/solvers/run/evaluated_state.hpp>

#include <new>

#include "solvers/linear/huge_pages.hpp"

namespace drev {

void make_room(EvaluatedState& point, int n) {
  State& s = point.state;
  for (Vector* x : {&s.z, &s.v, &s.a, &point.p, &point.kz, &point.cv, &point.total})
    if (x->size() == 0) set_zeros(*x, n);
}

void evaluate_laws(const Assembler& assembler, EvaluatedState& point) {
  const std::vector<ScalarTerm>& terms = assembler.system().scalars();
  point.inputs.resize(terms.size());
  point.responses.resize(terms.size());
  for (std::size_t j = 0; j < terms.size(); ++j) {
    // In place: a copy of what was stored field by field just before has to wait until that is in memory.
    new (&point.inputs[j]) ScalarInput(assembler.input(terms[j], point.state.z, point.state.v));
    new (&point.responses[j]) ScalarResponse(terms[j].force->evaluate(point.inputs[j]));
  }
}

void add_law_forces(const System& system, const EvaluatedState& point, double factor, Vector& f) {
  const ScalarResponse* r = point.responses.data();
  double* force = f.data();
  for (const ScalarTerm& term : system.scalars()) {
    const double y = factor * (r++)->y;
    for (const Entry& e : term.z) force[e.index] += e.coeff * y;
  }
}

}  // namespace drev
