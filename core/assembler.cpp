#include <drev/core/assembler.hpp>
#include <drev/core/law/varying_inertia.hpp>

namespace drev {

Assembler::Assembler(const System& system)
    : system_(system),
      u_(system.prescribed().size()),
      tables_(system.table_loads()),
      knotted_(system.knotted_loads()) {
  if (const int m = system.loaded_rows(); m > 0) {
    const auto rows = system.rows().topRows(m).cwiseAbs();
    row_gain_ = std::max(1.0, (rows.transpose() * rows.rowwise().sum()).maxCoeff());
    z_and_rows_.resize(system.size() + m);
    v_and_rows_.resize(system.size() + m);
    p_and_rows_.resize(system.size() + m);
  }
  set_time(0.0);
}

void Assembler::set_time(double t) {
  t_ = t;
  known_found_ = stands_ = false;
  if (system_.reference()) nominal_ = system_.reference()->at(t);
  if (system_.any_prescribed_moves())
    for (std::size_t k = 0; k < u_.size(); ++k)
      if (system_.prescribed()[k].at) u_[k] = system_.prescribed()[k].at(t);
}

void Assembler::set_time_ahead(double t, double ahead) {
  set_time(t + ahead);
  if (!system_.reference()) return;
  nominal_ = system_.reference()->at(t);
  nominal_.value += nominal_.rate * ahead;
}

void Assembler::stand_at_angle(double phi) {
  nominal_ = {phi, 0.0, 0.0};
  known_found_ = false;
  stands_ = true;
  for (MotionPoint& u : u_) u.rate = u.acceleration = 0.0;
}

MotionPoint Assembler::node_motion(int node, const State& s) const {
  const NodeMap& map = system_.node_map(node);
  return {map.coeff * over_coeff(map, s.z, &MotionPoint::value),
          map.coeff * over_coeff(map, s.v, &MotionPoint::rate),
          map.coeff * over_coeff(map, s.a, &MotionPoint::acceleration)};
}

double Assembler::node_angle(int node, const Vector& z) const {
  const NodeMap& map = system_.node_map(node);
  return system_.ratio(node) * nominal_.value + map.coeff * over_coeff(map, z, &MotionPoint::value);
}

LoadResponse Assembler::load(const LoadTerm& term, const Vector& z, const Vector& v) const {
  const NodeMap& map = system_.node_map(term.node);
  const double n = system_.ratio(term.node);
  const double q = over_coeff(map, z, &MotionPoint::value);
  const double q_dot = over_coeff(map, v, &MotionPoint::rate);
  const double rate = n * nominal_.rate;
  return term.load->evaluate({t_, n * nominal_.value, map.coeff * q, rate + map.coeff * q_dot, rate});
}

double Assembler::load_torque(const LoadTerm& term, const State& s) const {
  double torque = load(term, s.z, s.v).torque;
  if (system_.varying_inertias().empty()) return torque;
  const auto* inertia = dynamic_cast<const VaryingInertia*>(term.load);
  if (inertia == nullptr || !inertia->inertia_varies()) return torque;
  const double nominal = system_.ratio(term.node) * nominal_.acceleration;
  return torque - inertia->inertia_beyond(node_angle(term.node, s.z)) *
                      (nominal + node_motion(term.node, s).acceleration);
}

void Assembler::external_of_motions(Vector& p) const {
  const int n = system_.size();
  p.setZero(n);
  if (nominal_.acceleration != 0.0) p -= nominal_.acceleration * system_.nominal_inertia().head(n);
  if (nominal_.rate != 0.0) p -= nominal_.rate * system_.nominal_drag().head(n);
  if (system_.any_prescribed_moves()) {
    const MatrixSet& zu = system_.coupling_zu();
    for (int k = 0; k < system_.prescribed_count(); ++k) {
      const MotionPoint& u = u_[idx(k)];
      for (SparseMatrix::InnerIterator it(zu.mass, k); it; ++it) p[it.row()] -= it.value() * u.acceleration;
      for (SparseMatrix::InnerIterator it(zu.damping, k); it; ++it) p[it.row()] -= it.value() * u.rate;
      for (SparseMatrix::InnerIterator it(zu.stiffness, k); it; ++it) p[it.row()] -= it.value() * u.value;
    }
  }
}

void Assembler::external_known(Vector& p) const {
  external_of_motions(p);
  for (const int l : system_.known_loads()) {
    const LoadTerm& term = system_.loads()[idx(l)];
    add_torque(system_.node_map(term.node),
               load(term, system_.initial_deviation(), system_.initial_rate()).torque, p);
  }
}

void Assembler::add_looked_up(const Vector& z, const Vector& v, Vector& p) const {
  const TableLoads& tables = system_.table_loads();
  const KnottedLoads& knotted = system_.knotted_loads();
  const auto add = [&](const Vector& at_z, const Vector& at_v, Vector& to) {
    if (tables.size() > 0) {
      tables.look_up(at_z.data(), tables_);
      tables.add_to(tables_, to.data());
    }
    if (knotted.size() > 0) {
      knotted.look_up(at_z.data(), at_v.data(), knotted_);
      knotted.add_to(knotted_, to.data());
    }
  };
  const int m = system_.loaded_rows();
  if (m == 0) return add(z, v, p);
  const auto rows = system_.rows().topRows(m);
  z_and_rows_.head(z.size()) = z;
  z_and_rows_.tail(m).noalias() = rows * z;
  v_and_rows_.head(v.size()) = v;
  v_and_rows_.tail(m).noalias() = rows * v;
  p_and_rows_.setZero();
  add(z_and_rows_, v_and_rows_, p_and_rows_);
  p += p_and_rows_.head(z.size());
  p.noalias() += rows.transpose() * p_and_rows_.tail(m);
}

void Assembler::add_varying_inertia(const Vector& z, const Vector& v, Vector& p) const {
  if (stands_) return;
  const SparseMatrix& pattern = system_.pattern();
  for (const VaryingInertiaRow& row : system_.varying_inertias()) {
    double beyond = 0.0, nominal = 0.0;  // of the unknown; what the nominal acceleration makes of it
    for (const VaryingInertiaRow::Part& part : row.parts) {
      const double coeff = system_.node_map(part.node).coeff;
      const double inertia = coeff * part.inertia->inertia_beyond(node_angle(part.node, z));
      beyond += coeff * inertia;
      nominal += inertia * system_.ratio(part.node) * nominal_.acceleration;
    }
    double rest = p[row.unknown];
    for (int s = pattern.outerIndexPtr()[row.unknown]; s < pattern.outerIndexPtr()[row.unknown + 1]; ++s) {
      const int k = pattern.innerIndexPtr()[s];
      rest -= system_.stiffness_values()[s] * z[k] + system_.damping_values()[s] * v[k];
    }
    for (const Entry& law : row.laws) rest -= law.coeff * respond(system_.scalars()[idx(law.index)], z, v).y;
    const double part = row.constant / (row.constant + beyond);  // D
    p[row.unknown] += (part - 1.0) * rest - part * nominal;
  }
}

void Assembler::external(const Vector& z, const Vector& v, Vector& p) const {
  const bool tables = system_.table_loads().size() > 0, knotted = system_.knotted_loads().size() > 0;
  if (!tables && !knotted && system_.moving_loads().empty() && system_.varying_inertias().empty())
    return external_known(p);
  if (!known_found_) {
    external_known(known_);
    if (tables) system_.table_loads().set_nominal(nominal_.value, tables_);
    if (knotted) system_.knotted_loads().set_nominal(t_, nominal_, knotted_);
    known_found_ = true;
  }
  p = known_;
  if (tables || knotted) add_looked_up(z, v, p);
  for (const int l : system_.moving_loads()) {
    const LoadTerm& term = system_.loads()[idx(l)];
    add_torque(system_.node_map(term.node), load(term, z, v).torque, p);
  }
  if (!system_.varying_inertias().empty()) add_varying_inertia(z, v, p);
}

void Assembler::add_given(const ScalarTerm& term, ScalarInput& in) const {
  for (const Entry& e : term.u) {
    in.x += e.coeff * u_[idx(e.index)].value;
    in.x_dot += e.coeff * u_[idx(e.index)].rate;
  }
  if (term.phase_node < 0) return;
  const double n = system_.ratio(term.phase_node);
  const Offset offset = term.force->offset(n * nominal_.value);
  in.x -= offset.e;
  in.x_dot -= offset.de_dangle * n * nominal_.rate;
}

ScalarInput Assembler::input(const ScalarTerm& term, const Vector& z, const Vector& v) const {
  ScalarInput in = given_input(term);
  for (const Entry& e : term.z) {
    in.x += e.coeff * z[e.index];
    in.x_dot += e.coeff * v[e.index];
  }
  if (term.phase_node >= 0) in.angle = node_angle(term.phase_node, z);
  return in;
}

void Assembler::add_scalar_forces(const Vector& z, const Vector& v, Vector& f) const {
  for (const ScalarTerm& term : system_.scalars()) {
    const double y = respond(term, z, v).y;
    for (const Entry& e : term.z) f[e.index] += e.coeff * y;
  }
}

LocalResponse Assembler::respond(const GeneralTerm& g, const Vector& z, const Vector& v,
                                 const Vector& history, Vector& history_new) const {
  const auto n = static_cast<Eigen::Index>(g.nodes.size());
  const auto size = static_cast<std::size_t>(g.force->history_size());
  LocalState local;
  local.t = t_;
  local.q.resize(n);
  local.v.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const NodeMap& map = system_.node_map(g.nodes[static_cast<std::size_t>(i)]);
    const bool free = map.unknown >= 0;
    local.q[i] = map.coeff * (free ? z[map.unknown] : u_[idx(map.prescribed)].value);
    local.v[i] = map.coeff * (free ? v[map.unknown] : u_[idx(map.prescribed)].rate);
  }
  local.history = {history.data() + g.history_begin, size};
  LocalResponse r;
  r.f.setZero(n);
  r.stiffness.setZero(n, n);
  r.damping.setZero(n, n);
  r.history = {history_new.data() + g.history_begin, size};
  g.force->evaluate(local, r);
  return r;
}

void Assembler::add_general_forces(const Vector& z, const Vector& v, const Vector& history, Vector& f,
                                   Vector& history_new) const {
  for (const GeneralTerm& g : system_.generals()) {
    const LocalResponse r = respond(g, z, v, history, history_new);
    for (std::size_t i = 0; i < g.nodes.size(); ++i) {
      const NodeMap& map = system_.node_map(g.nodes[i]);
      if (map.unknown >= 0) f[map.unknown] += map.coeff * r.f[static_cast<Eigen::Index>(i)];
    }
  }
}

void Assembler::add_general_node_forces(const State& s, Vector& r) const {
  Vector scratch(system_.history_size());
  for (const GeneralTerm& g : system_.generals()) {
    const LocalResponse response = respond(g, s.z, s.v, s.history, scratch);
    for (std::size_t i = 0; i < g.nodes.size(); ++i)
      r[g.nodes[i]] += response.f[static_cast<Eigen::Index>(i)];
  }
}

std::pair<double, double> Assembler::general_energy(const State& s, const Vector& history) const {
  std::pair<double, double> sum{0.0, 0.0};
  Vector scratch(system_.history_size());
  for (const GeneralTerm& g : system_.generals()) {
    const LocalResponse r = respond(g, s.z, s.v, history, scratch);
    sum.first += r.stored_energy;
    sum.second += r.dissipated_power;
  }
  return sum;
}

void Assembler::linear_values(const Weights& w, Vector& values) const {
  values = w.m * system_.mass_values() + w.c * system_.damping_values() + w.k * system_.stiffness_values();
}

void Assembler::add_scalar_slope(const ScalarTerm& term, double slope, Vector& values) const {
  std::size_t s = 0;
  for (const Entry& row : term.z)
    for (const Entry& col : term.z) values[term.slots[s++]] += slope * row.coeff * col.coeff;
}

void Assembler::add_general_slopes(const Weights& w, const Vector& z, const Vector& v, const Vector& history,
                                   Vector& values) const {
  if (system_.generals().empty()) return;
  Vector scratch(system_.history_size());
  for (const GeneralTerm& g : system_.generals()) {
    const LocalResponse r = respond(g, z, v, history, scratch);
    std::size_t s = 0;
    for (std::size_t i = 0; i < g.nodes.size(); ++i)
      for (std::size_t j = 0; j < g.nodes.size(); ++j, ++s)
        if (g.slots[s] >= 0) {
          const auto a = static_cast<Eigen::Index>(i), b = static_cast<Eigen::Index>(j);
          values[g.slots[s]] += system_.node_map(g.nodes[i]).coeff * system_.node_map(g.nodes[j]).coeff *
                                (w.k * r.stiffness(a, b) + w.c * r.damping(a, b));
        }
  }
}

void Assembler::tangent_values(const Weights& w, const Vector& z, const Vector& v, const Vector& history,
                               bool with_loads, Vector& values) const {
  linear_values(w, values);
  for (const ScalarTerm& term : system_.scalars()) {
    const ScalarResponse r = respond(term, z, v);
    add_scalar_slope(term, w.k * r.dy_dx + w.c * r.dy_dx_dot, values);
  }
  if (with_loads)
    for (const LoadTerm& term : system_.loads()) {
      const NodeMap& map = system_.node_map(term.node);
      if (map.prescribed >= 0 || !term.load->depends_on_motion()) continue;
      const LoadResponse r = load(term, z, v);
      const double slope = map.coeff * map.coeff * (w.k * r.dtorque_dangle + w.c * r.dtorque_dspeed);
      if (map.unknown >= 0) {
        values[term.slot] -= slope;
      } else {  // the pattern is full
        const auto row = system_.rows().row(map.row);
        values.reshaped(row.size(), row.size()).noalias() -= slope * row.transpose() * row;
      }
    }
  add_general_slopes(w, z, v, history, values);
}

void Assembler::contact_values(const Weights& w, Contact contact, Vector& values) const {
  linear_values(w, values);
  for (const ScalarTerm& term : system_.scalars()) {
    if (contact == Contact::open && term.force->gap()) continue;
    add_scalar_slope(term, w.k * term.force->closed_stiffness() + w.c * term.force->closed_damping(), values);
  }
  const Vector zero = Vector::Zero(system_.size());
  add_general_slopes(w, zero, zero, State::initial(system_).history, values);
}

void Assembler::multiply(const Vector& values, const Vector& x, Vector& out) const {
  // Symmetric: a column is a row, and a row is a sum without stores in between.
  const SparseMatrix& p = system_.pattern();
  const int* outer = p.outerIndexPtr();
  const int* inner = p.innerIndexPtr();
  out.resize(p.rows());
  for (int row = 0; row < p.cols(); ++row) {
    double sum = 0.0;
    for (int s = outer[row]; s < outer[row + 1]; ++s) sum += values[s] * x[inner[s]];
    out[row] = sum;
  }
}

Eigen::MatrixXd Assembler::product(const Vector& values, const Eigen::MatrixXd& x) const {
  Eigen::MatrixXd out(x.rows(), x.cols());
  Vector column;
  for (Eigen::Index j = 0; j < x.cols(); ++j) {
    multiply(values, x.col(j), column);
    out.col(j) = column;
  }
  return out;
}

void Assembler::multiply_diagonal(const Vector& values, const Vector& x, Vector& out) const {
  const std::vector<int>& slots = system_.diagonal_slots();
  out.resize(x.size());
  for (std::size_t k = 0; k < slots.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    out[i] = values[slots[k]] * x[i];
  }
}

void Assembler::multiply_mass(const Vector& x, Vector& out) const {
  if (system_.mass_is_diagonal()) return multiply_diagonal(system_.mass_values(), x, out);
  multiply(system_.mass_values(), x, out);
}

void Assembler::multiply_damping(const Vector& x, Vector& out) const {
  if (system_.damping_is_diagonal()) return multiply_diagonal(system_.damping_values(), x, out);
  multiply(system_.damping_values(), x, out);
}

}  // namespace drev
