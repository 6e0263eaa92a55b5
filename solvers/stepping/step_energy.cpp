#include "solvers/stepping/step_energy.hpp"

#include <cmath>

#include "solvers/stepping/step_polynomial.hpp"

namespace drev {

std::pair<double, double> StepEnergy::over(StepEquation& equation, const EvaluatedState& from,
                                           const EvaluatedState& to, double h) {
  struct Node {
    double s, weight;
  };
  // Three points, exact to degree 5.
  static const Node nodes[] = {
      {0.5 - std::sqrt(0.15), 5.0 / 18}, {0.5, 8.0 / 18}, {0.5 + std::sqrt(0.15), 5.0 / 18}};
  Assembler& assembler = equation.assembler();
  const System& system = assembler.system();
  const StepPolynomial motion(from.state, to.state, h, StepPolynomial::degree_for(equation.scheme()));
  double input = 0.0, dissipated = 0.0;
  for (const Node& node : nodes) {
    motion.at(node.s, inside_.state);
    const Vector& v = inside_.state.v;
    assembler.set_time(inside_.state.t);
    assembler.external(inside_.state.z, v, inside_.p);
    assembler.multiply_damping(v, inside_.cv);
    double power = inside_.p.dot(v), loss = inside_.cv.dot(v);
    for (const ScalarTerm& term : system.scalars()) {
      const ScalarInput in = assembler.input(term, inside_.state.z, v);
      const ScalarResponse r = term.force->evaluate(in);
      loss += r.dissipated_power;
      if (!term.u.empty() || term.phase_node >= 0) {
        double known_rate = in.x_dot;
        for (const Entry& e : term.z) known_rate -= e.coeff * v[e.index];
        power += r.y * known_rate;
      }
      if (term.varies) power -= r.y * in.x_dot - r.dissipated_power;
    }
    if (!system.generals().empty())
      loss += assembler.general_energy(inside_.state, from.state.history).second;
    input += h * node.weight * power;
    dissipated += h * node.weight * loss;
  }
  for (std::size_t j = 0; j < system.scalars().size(); ++j)
    if (system.scalars()[j].varies) input += to.responses[j].stored_energy - from.responses[j].stored_energy;
  return {input, dissipated};
}

}  // namespace drev
