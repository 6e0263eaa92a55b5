// Forces of the reference model as Taylor series, and the guards between their formulas.
#include <stdexcept>

#include "tests/stability/coverage/reference_model.hpp"

namespace coverage {

namespace {

Real factorial_step(int k) { return static_cast<Real>(k + 1); }

}  // namespace

void ReferenceModel::expand(int degree) {
  degree_ = degree;
  phi_ = nominal();
  for (std::size_t u = 0; u < z_.size(); ++u) z_[u] = {}, z_[u][0] = z[u], z_[u][1] = v[u];
  for (std::size_t i = 0; i < meshes_.size(); ++i) expand_error(meshes_[i], spec_.meshes[i], degree + 1);
  for (std::size_t i = 0; i < loads_.size(); ++i) expand_known_load(loads_[i], spec_.loads[i], degree);
  std::vector<Real> sum(z_.size());
  for (int k = 0; k <= degree; ++k) {
    for (std::size_t i = 0; i < q_.size(); ++i) {
      const int u = unknown_[i];
      q_[i][k] = u < 0 ? 0 : factor_[i] * z_[at(u)][k];
      rate_[i][k] = u < 0 ? 0 : factor_[i] * factorial_step(k) * z_[at(u)][k + 1];
      force_[i][k] = spec_.rayleigh_mass * spec_.nodes[i].inertia * rate_[i][k];
    }
    add_linear(k);
    for (std::size_t i = 0; i < meshes_.size(); ++i) add_mesh(spec_.meshes[i], meshes_[i], k);
    for (std::size_t i = 0; i < polylines_.size(); ++i) add_polyline(spec_.polylines[i], polylines_[i], k);
    for (std::size_t i = 0; i < loads_.size(); ++i) add_load(spec_.loads[i], loads_[i], k);
    sum.assign(z_.size(), 0);
    for (std::size_t i = 0; i < q_.size(); ++i) {
      residual_[i][k] = force_[i][k];
      if (k == 0) residual_[i][k] += spec_.nodes[i].inertia * ratio_[i] * 2 * phi_[2];
      if (unknown_[i] >= 0) sum[at(unknown_[i])] += factor_[i] * residual_[i][k];
    }
    for (std::size_t u = 0; u < z_.size(); ++u)
      z_[u][k + 2] = -sum[u] / mass_[u] / (factorial_step(k) * factorial_step(k + 1));
    for (std::size_t i = 0; i < q_.size(); ++i)
      if (unknown_[i] >= 0)
        residual_[i][k] -=
            spec_.nodes[i].inertia * factor_[i] * sum[at(unknown_[i])] / mass_[at(unknown_[i])];
  }
}

/// Shafts, dashpots and springs to ground: tau = k twist + c rate pulls a forward and b back.
void ReferenceModel::add_linear(int k) {
  const auto add = [&](const Shaft& s, Real rayleigh, bool drags) {
    Real tau = 0;
    const Real c = s.damping + rayleigh * s.stiffness;
    if (s.b >= 0) {
      tau = s.stiffness * (q_[at(s.b)][k] - q_[at(s.a)][k]) + c * (rate_[at(s.b)][k] - rate_[at(s.a)][k]);
      if (drags) tau += c * (ratio_[at(s.b)] - ratio_[at(s.a)]) * factorial_step(k) * phi_[k + 1];
      force_[at(s.a)][k] -= tau;
      force_[at(s.b)][k] += tau;
    } else {
      tau = s.stiffness * q_[at(s.a)][k] + c * rate_[at(s.a)][k];
      if (drags) tau += c * ratio_[at(s.a)] * factorial_step(k) * phi_[k + 1];
      force_[at(s.a)][k] += tau;
    }
  };
  for (const Shaft& s : spec_.shafts) add(s, spec_.rayleigh_stiffness, false);
  for (const Shaft& s : spec_.springs) add(s, 0, false);
  for (const Shaft& s : spec_.dashpots) add(s, 0, true);
}

/// e over the mesh phase at gear a's nominal angle.
void ReferenceModel::expand_error(MeshState& s, const Mesh& m, int degree) {
  s.e = {};
  if (m.error_harmonics.empty() && s.error.empty()) return;
  Series phase;  // in mesh periods
  for (int k = 0; k <= 2; ++k) phase[k] = m.teeth * ratio_[at(m.a)] * phi_[k] / kTurn;
  phase[0] += m.phase;
  if (!s.error.empty()) {
    for (int k = 0; k <= 2; ++k) s.e[k] = s.error.slope() * phase[k];
    s.e[0] += s.error.value_at_low() - s.error.slope() * s.error.low();
    s.error_angle = phase;
    return;
  }
  for (std::size_t h = 0; h < m.error_harmonics.size(); ++h) {
    const Harmonic& wave = m.error_harmonics[h];
    Series angle;
    for (int k = 0; k <= 2; ++k) angle[k] = kTurn * wave.order * phase[k];
    angle[0] += wave.phase;
    for (int k = 0; k <= degree; ++k) {
      s.error_waves[h].extend(angle, k);
      s.e[k] += wave.amplitude * s.error_waves[h].cosine[k];
    }
  }
}

void ReferenceModel::add_mesh(const Mesh& m, MeshState& s, int k) {
  const Real r_b = m.internal ? -static_cast<Real>(m.radius_b) : static_cast<Real>(m.radius_b);
  s.x[k] = m.radius_a * q_[at(m.a)][k] + r_b * q_[at(m.b)][k] - s.e[k];
  s.rate[k] = m.radius_a * rate_[at(m.a)][k] + r_b * rate_[at(m.b)][k] - factorial_step(k) * s.e[k + 1];
  Real phase = m.teeth * (ratio_[at(m.a)] * phi_[k] + q_[at(m.a)][k]) / kTurn;
  if (k == 0) phase += m.phase;
  s.error_angle[k] =
      s.error.empty() ? 0 : m.teeth * ratio_[at(m.a)] * phi_[k] / kTurn + (k == 0 ? m.phase : 0);
  s.phase[k] = phase;
  s.k[k] = 0;
  if (m.kind == Mesh::Stiffness::constant) {
    s.k[k] = k == 0 ? m.stiffness : 0.0;
  } else if (m.kind == Mesh::Stiffness::fourier) {
    s.k[k] = k == 0 ? m.stiffness : 0.0;
    for (std::size_t h = 0; h < s.waves.size(); ++h) {
      const Harmonic& wave = m.stiffness_harmonics[h];
      s.wave_angles[h][k] = kTurn * wave.order * phase + (k == 0 ? wave.phase : 0);
      s.waves[h].extend(s.wave_angles[h], k);
      s.k[k] += wave.amplitude * s.waves[h].cosine[k];
    }
  } else if (m.kind == Mesh::Stiffness::step) {
    s.k[k] = k == 0 ? s.stiffness.value_at_low() : 0;
  } else {
    s.k[k] = s.stiffness.slope() * (k == 0 ? phase - s.stiffness.low() : phase);
    if (k == 0) s.k[k] += s.stiffness.value_at_low();
  }
  s.y[k] = mesh_force(m, s, k);
  force_[at(m.a)][k] += m.radius_a * s.y[k];
  force_[at(m.b)][k] += r_b * s.y[k];
}

/// y: docs/catalogue.md, "Which damping law". p: penetration.
Real ReferenceModel::mesh_force(const Mesh& m, MeshState& s, int k) const {
  const Real c = m.damping, half = static_cast<Real>(m.backlash) / 2, sigma = s.side;
  if (m.backlash == 0) return product(s.k, s.x, k) + c * s.rate[k];
  const Real always = m.law == Law::always ? c * s.rate[k] : 0;
  s.p[k] = s.side == 0 ? 0 : sigma * s.x[k] - (k == 0 ? half : 0);
  if (s.side == 0) return always;
  if (s.free) return 0;
  const Real spring = sigma * product(s.k, s.p, k);
  if (m.law == Law::always) return spring + always;
  if (s.capped) return 2 * spring;
  if (m.law == Law::proportional && !s.deep)
    return spring + c / reference_penetration(m) * product(s.p, s.rate, k);
  return spring + c * s.rate[k];
}

Real ReferenceModel::reference_penetration(const Mesh& m) {
  return m.reference_penetration > 0 ? static_cast<Real>(m.reference_penetration)
                                     : static_cast<Real>(m.backlash) / 40;
}

void ReferenceModel::add_polyline(const Polyline& p, PolylineState& s, int k) {
  s.x[k] = p.b >= 0 ? q_[at(p.b)][k] - q_[at(p.a)][k] : q_[at(p.a)][k];
  s.rate[k] = p.b >= 0 ? rate_[at(p.b)][k] - rate_[at(p.a)][k] : rate_[at(p.a)][k];
  const std::size_t i = at(s.segment);
  const Real slope = (static_cast<Real>(p.y[i + 1]) - p.y[i]) / (static_cast<Real>(p.x[i + 1]) - p.x[i]);
  s.y[k] = slope * s.x[k] + p.damping * s.rate[k];
  if (k == 0) s.y[k] += p.y[i] - slope * p.x[i];
  force_[at(p.a)][k] += p.b >= 0 ? -s.y[k] : s.y[k];
  if (p.b >= 0) force_[at(p.b)][k] += s.y[k];
}

/// What is known without the motion: tables and harmonics in time, and all loads over the nominal angle.
void ReferenceModel::expand_known_load(LoadState& s, const Load& l, int degree) {
  if (l.kind == Load::Kind::table_in_time) {
    s.torque = {};
    const auto& times = l.times;
    std::size_t i = 0;  // the first time beyond t
    while (i < times.size() && times[i] <= t) ++i;
    if (i == 0 || i == times.size()) {
      s.torque[0] = i == 0 ? l.torques.front() : l.torques.back();
      return;
    }
    const Real length = static_cast<Real>(times[i]) - times[i - 1];
    s.torque[1] = (static_cast<Real>(l.torques[i]) - l.torques[i - 1]) / length;
    s.torque[0] = l.torques[i - 1] + s.torque[1] * (t - times[i - 1]);
  } else if (l.kind == Load::Kind::harmonics_in_time) {
    s.torque = {};
    for (std::size_t h = 0; h < l.harmonics.size(); ++h) {
      Series angle;
      angle[0] = kTurn * l.harmonics[h].order * t + l.harmonics[h].phase;
      angle[1] = kTurn * l.harmonics[h].order;
      for (int k = 0; k <= degree; ++k) {
        s.waves[h].extend(angle, k);
        s.torque[k] += l.harmonics[h].amplitude * s.waves[h].cosine[k];
      }
    }
  }
}

void ReferenceModel::add_load(const Load& l, LoadState& s, int k) {
  if (l.kind == Load::Kind::table_in_angle || l.kind == Load::Kind::harmonics_in_angle) {
    s.angle[k] = ratio_[at(l.node)] * phi_[k] + (l.actual_angle ? q_[at(l.node)][k] : 0);
    if (l.kind == Load::Kind::table_in_angle) {
      if (k == 0) s.angle[k] += l.phase;
      s.torque[k] = s.table.slope() * (k == 0 ? s.angle[k] - s.table.low() : s.angle[k]);
      if (k == 0) s.torque[k] += s.table.value_at_low();
    } else {
      s.torque[k] = k == 0 ? l.mean : 0.0;
      for (std::size_t h = 0; h < l.harmonics.size(); ++h) {
        s.wave_angles[h][k] = l.harmonics[h].order * s.angle[k] + (k == 0 ? l.harmonics[h].phase : 0);
        s.waves[h].extend(s.wave_angles[h], k);
        s.torque[k] += l.harmonics[h].amplitude * s.waves[h].cosine[k];
      }
    }
  }
  force_[at(l.node)][k] -= s.torque[k];
}

/// The formulas that hold at the present values: at the start and after a jump.
void ReferenceModel::settle_mesh(std::size_t i, bool start) {
  const Mesh& m = spec_.meshes[i];
  MeshState& s = meshes_[i];
  phi_ = nominal();
  const Real nominal_phase = m.teeth * ratio_[at(m.a)] * phi_[0] / kTurn + m.phase;
  const Real nominal_rate = m.teeth * ratio_[at(m.a)] * phi_[1] / kTurn;
  const Real phase = nominal_phase + m.teeth * angle_now(m.a) / kTurn;
  if (start && !s.stiffness.empty()) s.stiffness.place(phase, nominal_rate + m.teeth * rate_now(m.a) / kTurn);
  if (start && !s.error.empty()) s.error.place(nominal_phase, nominal_rate);
  if (m.backlash == 0) return;
  expand_error(s, m, 1);
  const Real r_b = m.internal ? -static_cast<Real>(m.radius_b) : static_cast<Real>(m.radius_b);
  const Real x = m.radius_a * angle_now(m.a) + r_b * angle_now(m.b) - s.e[0];
  const Real rate = m.radius_a * rate_now(m.a) + r_b * rate_now(m.b) - s.e[1];
  const Real half = static_cast<Real>(m.backlash) / 2;
  if (start) s.side = x > half ? 1 : x < -half ? -1 : 0;
  if (s.side == 0) return;
  const Real p = s.side * x - half, closing = s.side * rate, c = m.damping;
  Real k = m.stiffness;
  if (m.kind == Mesh::Stiffness::fourier)
    for (const Harmonic& h : m.stiffness_harmonics)
      k += h.amplitude * std::cos(kTurn * h.order * phase + h.phase);
  if (m.kind == Mesh::Stiffness::step) k = s.stiffness.value_at_low();
  if (m.kind == Mesh::Stiffness::table)
    k = s.stiffness.value_at_low() + s.stiffness.slope() * (phase - s.stiffness.low());
  const Real reference = reference_penetration(m);
  s.deep = m.law == Law::proportional && p > reference;
  s.free =
      c > 0 && m.law != Law::always &&
      (m.law == Law::proportional && !s.deep ? k + c * closing / reference < 0 : k * p + c * closing < 0);
  s.capped = c > 0 && m.law == Law::limited && c * closing > k * p;
}

void ReferenceModel::pass(const Guard& guard) {
  Guard now = guard;  // the guard that stands at its zero from here on
  const std::size_t i = at(guard.index);
  switch (guard.of) {
    case Guard::Of::mesh_edge: {
      MeshState& s = meshes_[i];
      s.side = s.side == 0 ? guard.side : 0;
      s.deep = s.free = false;
      s.capped = s.side != 0 && spec_.meshes[i].law == Law::limited && spec_.meshes[i].damping > 0;
      break;
    }
    case Guard::Of::mesh_deep:
      meshes_[i].deep = !meshes_[i].deep;
      break;
    case Guard::Of::mesh_free:
      meshes_[i].free = !meshes_[i].free;
      break;
    case Guard::Of::mesh_cap:
      meshes_[i].capped = !meshes_[i].capped;
      break;
    case Guard::Of::mesh_stiffness:
      meshes_[i].stiffness.move(guard.side);
      if (spec_.meshes[i].kind == Mesh::Stiffness::step) settle_mesh(i, false);
      now.side = -guard.side;
      break;
    case Guard::Of::mesh_error:
      meshes_[i].error.move(guard.side);
      settle_mesh(i, false);
      now.side = -guard.side;
      break;
    case Guard::Of::polyline:
      polylines_[i].segment += guard.side;
      now.side = -guard.side;
      break;
    case Guard::Of::load:
      loads_[i].table.move(guard.side);
      now.side = -guard.side;
      break;
  }
  passed_ = now, any_passed_ = true;
}

std::vector<Guard> ReferenceModel::guards() const {
  std::vector<Guard> all;
  const auto add = [&](Guard::Of of, std::size_t index, int side, const Poly& g) {
    Guard guard{of, static_cast<int>(index), side, g, false};
    guard.fresh = any_passed_ && passed_.of == of && passed_.index == guard.index && passed_.side == side;
    all.push_back(guard);
  };
  const auto sum = [&](Real constant, Real a, const Series& x, Real b = 0, const Series& y = {}) {
    Poly g;
    g.degree = degree_;
    for (int k = 0; k <= degree_; ++k) g.a[k] = a * x[k] + b * y[k];
    g.a[0] += constant;
    return g;
  };
  const auto between = [&](Guard::Of of, std::size_t i, const KnotWalk& walk, const Series& argument) {
    add(of, i, -1, sum(-walk.low(), 1, argument));
    add(of, i, 1, sum(walk.high(), -1, argument));
  };
  for (std::size_t i = 0; i < meshes_.size(); ++i) {
    const Mesh& m = spec_.meshes[i];
    const MeshState& s = meshes_[i];
    if (!s.stiffness.empty()) between(Guard::Of::mesh_stiffness, i, s.stiffness, s.phase);
    if (!s.error.empty()) between(Guard::Of::mesh_error, i, s.error, s.error_angle);
    if (m.backlash == 0) continue;
    const Real half = static_cast<Real>(m.backlash) / 2, c = m.damping, sigma = s.side;
    if (s.side == 0) {
      add(Guard::Of::mesh_edge, i, 1, sum(half, -1, s.x));
      add(Guard::Of::mesh_edge, i, -1, sum(half, 1, s.x));
      continue;
    }
    add(Guard::Of::mesh_edge, i, s.side, sum(0, 1, s.p));
    if (c == 0 || m.law == Law::always) continue;
    const Real reference = reference_penetration(m);
    if (m.law == Law::proportional)
      add(Guard::Of::mesh_deep, i, 0, s.deep ? sum(-reference, 1, s.p) : sum(reference, -1, s.p));
    Series spring = s.k;
    if (m.law != Law::proportional || s.deep)
      for (int k = 0; k <= degree_; ++k) spring[k] = product(s.k, s.p, k);
    const Real damper = m.law == Law::proportional && !s.deep ? c * sigma / reference : c * sigma;
    const Real sign = s.free ? -1 : 1;
    if (!s.capped) add(Guard::Of::mesh_free, i, 0, sum(0, sign, spring, sign * damper, s.rate));
    if (m.law == Law::limited && !s.free) {
      const Real cap = s.capped ? -1 : 1;
      add(Guard::Of::mesh_cap, i, 0, sum(0, cap, spring, -cap * damper, s.rate));
    }
  }
  for (std::size_t i = 0; i < polylines_.size(); ++i) {
    const Polyline& p = spec_.polylines[i];
    const int segment = polylines_[i].segment, last = static_cast<int>(p.x.size()) - 2;
    if (segment > 0) add(Guard::Of::polyline, i, -1, sum(-p.x[at(segment)], 1, polylines_[i].x));
    if (segment < last) add(Guard::Of::polyline, i, 1, sum(p.x[at(segment + 1)], -1, polylines_[i].x));
  }
  for (std::size_t i = 0; i < loads_.size(); ++i)
    if (!loads_[i].table.empty()) between(Guard::Of::load, i, loads_[i].table, loads_[i].angle);
  return all;
}

}  // namespace coverage
