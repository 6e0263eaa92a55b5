#include "core/energy/element_energy.hpp"

#include <drev/core/assembler.hpp>
#include <drev/core/law/friction.hpp>

#include "core/element_parts.hpp"

namespace drev {

struct ElementEnergy::Motion {
  std::vector<double> q, rate, actual;  // longer than the part has nodes where an earlier one had more
};

namespace {

/// x' A y. Summed here: the powers of every element are asked for many times a step, and a product of Eigen's would
/// take memory for each.
double product(const std::vector<double>& x, const Eigen::MatrixXd& a, const std::vector<double>& y) {
  double sum = 0.0;
  for (Eigen::Index j = 0; j < a.cols(); ++j) {
    double column = 0.0;
    for (Eigen::Index i = 0; i < a.rows(); ++i) column += x.data()[i] * a(i, j);
    sum += column * y.data()[j];
  }
  return sum;
}

/// A general element's answer at a state; its history is read and not written.
LocalResponse respond(const GeneralTerm& term, const Assembler& assembler, const State& state) {
  const auto n = static_cast<Eigen::Index>(term.nodes.size());
  const auto count = static_cast<std::size_t>(term.force->history_size());
  LocalState local;
  local.t = state.t;
  local.q.resize(n);
  local.v.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const MotionPoint m = assembler.node_motion(term.nodes[static_cast<std::size_t>(i)], state);
    local.q[i] = m.value;
    local.v[i] = m.rate;
  }
  local.history = {state.history.data() + term.history_begin, count};
  std::vector<double> left(count);
  LocalResponse r;
  r.f.setZero(n);
  r.stiffness.setZero(n, n);
  r.damping.setZero(n, n);
  r.history = left;
  term.force->evaluate(local, r);
  r.history = {};
  return r;
}

}  // namespace

std::vector<ElementEnergy> ElementEnergy::of_all(const System& system) {
  std::vector<ElementEnergy> all(system.element_instances().size());
  double a = 0.0, b = 0.0;  // coefficients of Rayleigh damping [1/s, s]
  for_each_stated(system, [&](int /*element*/, const Terms& terms, const std::vector<int>& /*nodes*/) {
    a += terms.rayleigh_a;
    b += terms.rayleigh_b;
  });
  for_each_stated(system, [&](int element, const Terms& terms, const std::vector<int>& nodes) {
    ElementEnergy& own = all[idx(element)];
    Part part{nodes, terms.mass, terms.damping, terms.deviation_damping, terms.stiffness};
    // It acts on the deviations alone, as in the system's equations.
    if (terms.rayleigh) {
      if (part.deviation_damping.size() == 0)
        part.deviation_damping.setZero(terms.mass.rows(), terms.mass.cols());
      part.deviation_damping += a * terms.mass + b * terms.stiffness;
    }
    for (const ScalarSpec& s : terms.scalars)
      if (const LawPiece* line = straight_line(s)) {
        const Eigen::MatrixXd square = s.b * s.b.transpose();
        part.damping += line->c * square;
        part.stiffness += line->k * square;
      }
    const auto keeps = [](Eigen::MatrixXd& matrix) {
      if (matrix.isZero(0.0)) matrix.resize(0, 0);
      return matrix.size() > 0;
    };
    const bool heavy = keeps(part.mass), stiff = keeps(part.stiffness), damped = keeps(part.damping),
               by_deviation = keeps(part.deviation_damping);
    own.heavy_ |= heavy;
    own.stiff_ |= stiff;
    own.damped_ |= damped || by_deviation;
    if (heavy || stiff || damped || by_deviation) own.parts_.push_back(std::move(part));
  });
  const auto enter = [&](const auto& terms, std::vector<int> ElementEnergy::*places) {
    for (std::size_t i = 0; i < terms.size(); ++i)
      (all[idx(index(terms[i].element))].*places).push_back(static_cast<int>(i));
  };
  enter(system.scalars(), &ElementEnergy::scalars_);
  enter(system.loads(), &ElementEnergy::loads_);
  enter(system.generals(), &ElementEnergy::generals_);
  enter(system.frictions(), &ElementEnergy::frictions_);
  for (const FrictionTerm& term : system.frictions())
    all[idx(index(term.element))].friction_heat_ = term.history_begin + FrictionHistory::kHeat;
  return all;
}

double ElementEnergy::actual_rate(int node, const Assembler& assembler, const State& state) const {
  return assembler.node_motion(node, state).rate + assembler.system().ratio(node) * assembler.nominal().rate;
}

double ElementEnergy::along(const std::vector<Entry>& nodes, const Assembler& assembler,
                            const State& state) const {
  double sum = 0.0;
  for (const Entry& e : nodes) sum += e.coeff * actual_rate(e.index, assembler, state);
  return sum;
}

/// Good until the next call of the thread.
const ElementEnergy::Motion& ElementEnergy::motion(const Part& part, const Assembler& assembler,
                                                   const State& state) const {
  static thread_local Motion m;
  const std::size_t n = part.nodes.size();
  if (m.q.size() < n)
    for (std::vector<double>* x : {&m.q, &m.rate, &m.actual}) x->resize(n);
  const double nominal = assembler.nominal().rate;
  for (std::size_t i = 0; i < n; ++i) {
    const MotionPoint point = assembler.node_motion(part.nodes[i], state);
    m.q[i] = point.value;
    m.rate[i] = point.rate;
    m.actual[i] = point.rate + assembler.system().ratio(part.nodes[i]) * nominal;
  }
  return m;
}

double ElementEnergy::power(const Assembler& assembler, const State& state) const {
  const System& system = assembler.system();
  double sum = 0.0;
  for (const Part& part : parts_) {
    const Motion& m = motion(part, assembler, state);
    if (part.stiffness.size() > 0) sum -= product(m.actual, part.stiffness, m.q);
    if (part.damping.size() > 0) sum -= product(m.actual, part.damping, m.actual);
    if (part.deviation_damping.size() > 0) sum -= product(m.actual, part.deviation_damping, m.rate);
  }
  for (const int j : scalars_) {
    const ScalarTerm& term = system.scalars()[idx(j)];
    sum -= assembler.respond(term, state.z, state.v).y * along(term.nodes, assembler, state);
  }
  for (const int g : generals_) {
    const GeneralTerm& term = system.generals()[idx(g)];
    const LocalResponse r = respond(term, assembler, state);
    for (std::size_t i = 0; i < term.nodes.size(); ++i)
      sum -= r.f[static_cast<Eigen::Index>(i)] * actual_rate(term.nodes[i], assembler, state);
  }
  for (const int f : frictions_) {
    const FrictionTerm& term = system.frictions()[idx(f)];
    sum -= state.history[term.history_begin + FrictionHistory::kTorque] * along(term.nodes, assembler, state);
  }
  for (const int l : loads_) {
    const LoadTerm& term = system.loads()[idx(l)];
    sum += assembler.load_torque(term, state) * actual_rate(term.node, assembler, state);
  }
  return sum;
}

double ElementEnergy::dissipation(const Assembler& assembler, const State& state) const {
  const System& system = assembler.system();
  double sum = 0.0;
  for (const Part& part : parts_) {
    const Motion& m = motion(part, assembler, state);
    if (part.damping.size() > 0) sum += product(m.actual, part.damping, m.actual);
    if (part.deviation_damping.size() > 0) sum += product(m.rate, part.deviation_damping, m.rate);
  }
  for (const int j : scalars_)
    sum += assembler.respond(system.scalars()[idx(j)], state.z, state.v).dissipated_power;
  for (const int g : generals_) sum += respond(system.generals()[idx(g)], assembler, state).dissipated_power;
  for (const int f : frictions_) {
    const FrictionTerm& term = system.frictions()[idx(f)];
    sum += state.history[term.history_begin + FrictionHistory::kTorque] * along(term.nodes, assembler, state);
  }
  return sum;
}

double ElementEnergy::stored(const Assembler& assembler, const State& state) const {
  const System& system = assembler.system();
  double sum = 0.0;
  for (const Part& part : parts_) {
    if (part.stiffness.size() == 0) continue;
    const Motion& m = motion(part, assembler, state);
    sum += 0.5 * product(m.q, part.stiffness, m.q);
  }
  for (const int j : scalars_)
    sum += assembler.respond(system.scalars()[idx(j)], state.z, state.v).stored_energy;
  for (const int g : generals_) sum += respond(system.generals()[idx(g)], assembler, state).stored_energy;
  return sum;
}

std::optional<double> ElementEnergy::stored_rate(const Assembler& assembler, const State& state) const {
  if (!generals_.empty()) return std::nullopt;
  double sum = 0.0;
  for (const int j : scalars_) {
    const ScalarTerm& term = assembler.system().scalars()[idx(j)];
    if (term.varies || term.phase_node >= 0) return std::nullopt;
    const ScalarInput in = assembler.input(term, state.z, state.v);
    const ScalarResponse r = term.force->evaluate(in);
    sum += r.y * in.x_dot - r.dissipated_power;
  }
  for (const Part& part : parts_) {
    if (part.stiffness.size() == 0) continue;
    const Motion& m = motion(part, assembler, state);
    sum += product(m.rate, part.stiffness, m.q);
  }
  return sum;
}

double ElementEnergy::kinetic(const Assembler& assembler, const State& state) const {
  double sum = 0.0;
  for (const Part& part : parts_) {
    if (part.mass.size() == 0) continue;
    const Motion& m = motion(part, assembler, state);
    sum += 0.5 * product(m.actual, part.mass, m.actual);
  }
  return sum;
}

}  // namespace drev
