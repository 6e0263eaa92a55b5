#include "solvers/step_point.hpp"

namespace drev {

void evaluate_laws(const Assembler& assembler, StepPoint& point) {
  const std::vector<ScalarTerm>& terms = assembler.system().scalars();
  point.inputs.resize(terms.size());
  point.responses.resize(terms.size());
  for (std::size_t j = 0; j < terms.size(); ++j) {
    point.inputs[j] = assembler.input(terms[j], point.state.z, point.state.v);
    point.responses[j] = terms[j].force->evaluate(point.inputs[j]);
  }
}

void add_law_forces(const System& system, const StepPoint& point, double factor, Vector& f) {
  for (std::size_t j = 0; j < point.responses.size(); ++j)
    for (const Entry& e : system.scalars()[j].z) f[e.index] += factor * e.coeff * point.responses[j].y;
}

}  // namespace drev
