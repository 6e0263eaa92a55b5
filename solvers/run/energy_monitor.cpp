#include "solvers/run/energy_monitor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solvers/linear/vector_kernels.hpp"

namespace drev {

EnergyMonitor::EnergyMonitor(const Assembler& assembler, const EvaluatedState& start)
    : assembler_(assembler),
      mass_(assembler.system().pattern(), assembler.system().mass_values()),
      damped_((assembler.system().damping_values().array() != 0.0).any()) {
  const System& system = assembler.system();
  const Vector sizes = system.stiffness_values().cwiseAbs();
  const double largest = MatrixProduct(system.pattern(), sizes).energy(start.state.z.cwiseAbs());
  balance_.rounding = std::max(kNoEnergy, std::numeric_limits<double>::epsilon() * largest);
  balance_.kinetic = 0.5 * mass_.energy(start.state.v);
  balance_.stored = stored(start);
  balance_.start = balance_.kinetic + balance_.stored;
  balance_.given = balance_.scale = balance_.kinetic + std::abs(balance_.stored);
}

double EnergyMonitor::stored(const EvaluatedState& point) const {
  double sum =
      0.5 * dot(assembler_.system().size(), point.state.z.data(), point.kz.data()) + point.general_energy;
  for (const ScalarResponse& r : point.responses) sum += r.stored_energy;
  return sum;
}

bool EnergyMonitor::step(const EvaluatedState& from, const EvaluatedState& to, double h) {
  const System& system = assembler_.system();
  auto [input, dissipated, by_stiffness] =
      step_work(system.size(), from.state.z.data(), to.state.z.data(), from.p.data(), to.p.data(),
                damped_ ? from.cv.data() : nullptr, to.cv.data(), to.kz.data());
  double stored = by_stiffness + to.general_energy, power = from.general_power + to.general_power;
  for (std::size_t j = 0, m = system.scalars().size(); j < m; ++j) {
    const ScalarTerm& term = system.scalars()[j];
    const ScalarResponse &r0 = from.responses[j], &r1 = to.responses[j];
    power += r0.dissipated_power + r1.dissipated_power;
    stored += r1.stored_energy;
    const bool partly_known = !term.u.empty() || term.phase_node >= 0;
    if (!partly_known && !term.varies) continue;
    const ScalarInput &in0 = from.inputs[j], &in1 = to.inputs[j];
    // Known part of the deflection: prescribed ends and transmission error do work on the law.
    if (partly_known) {
      double by_unknowns = 0.0;
      for (const Entry& e : term.z) by_unknowns += e.coeff * (to.state.z[e.index] - from.state.z[e.index]);
      input += 0.5 * (r0.y + r1.y) * (in1.x - in0.x - by_unknowns);
    }
    // A law that varies: its energy changes at constant x too; mean over both orders of changing.
    if (term.varies) {
      const double v01 = term.force->evaluate({in0.x, in0.x_dot, in1.t, in1.angle}).stored_energy;
      const double v10 = term.force->evaluate({in1.x, in1.x_dot, in0.t, in0.angle}).stored_energy;
      input += 0.5 * ((v01 - r0.stored_energy) + (r1.stored_energy - v10));
    }
  }
  return enter(to, input, dissipated + 0.5 * h * power, stored);
}

bool EnergyMonitor::step(const EvaluatedState& to, double input, double dissipated) {
  return enter(to, input, dissipated, stored(to));
}

bool EnergyMonitor::enter(const EvaluatedState& to, double input, double dissipated, double stored) {
  bool good = true;
  enter_step(balance_, 0.5 * mass_.energy(to.state.v), stored, balance_.input + input,
             balance_.dissipated + dissipated, to.state.t, good);
  return good;
}

void EnergyMonitor::restart(const EvaluatedState& before, const EvaluatedState& after) {
  balance_.input += stored(after) - stored(before);
  balance_.stored = stored(after);
}

}  // namespace drev
