#include "tests/stability/coverage/reference_model.hpp"

#include <algorithm>
#include <limits>

namespace coverage {

void KnotWalk::place(Real argument, Real direction) {
  const Real period = points_.period, first = points_.arguments.front();
  turn_ = static_cast<long>(std::floor((argument - first) / period));
  const Real u = argument - period * static_cast<Real>(turn_);
  segment_ = static_cast<int>(points_.arguments.size()) - 1;
  while (segment_ > 0 && points_.arguments[index(segment_)] > u) --segment_;
  if (direction < 0 && argument == low()) move(-1);
}

void KnotWalk::move(int by) {
  const int n = static_cast<int>(points_.arguments.size());
  segment_ += by;
  if (segment_ >= n) segment_ -= n, ++turn_;
  if (segment_ < 0) segment_ += n, --turn_;
}

Real KnotWalk::knot(int i) const {
  const int n = static_cast<int>(points_.arguments.size());
  const long turn = turn_ + (i >= n ? 1 : 0);
  return points_.arguments[index(i)] + static_cast<Real>(points_.period) * static_cast<Real>(turn);
}

Real KnotWalk::slope() const {
  return (static_cast<Real>(points_.values[index(segment_ + 1)]) - points_.values[index(segment_)]) /
         (high() - low());
}

ReferenceModel::ReferenceModel(const Spec& spec) : spec_(spec) {
  find_groups();
  find_ratios();
  list_channels();
  for (const Mesh& m : spec_.meshes) {
    MeshState s;
    if (m.kind == Mesh::Stiffness::table) s.stiffness = m.stiffness_table;
    if (m.kind == Mesh::Stiffness::step)
      s.stiffness = PeriodicPoints{{0.0, m.ratio - 1.0}, {m.both, m.stiffness}, 1.0};
    if (!m.error_table.arguments.empty()) s.error = m.error_table;
    s.waves.resize(m.stiffness_harmonics.size()), s.wave_angles.resize(m.stiffness_harmonics.size());
    s.error_waves.resize(m.error_harmonics.size());
    meshes_.push_back(s);
  }
  polylines_.resize(spec_.polylines.size());
  for (const Load& l : spec_.loads) {
    LoadState s;
    if (l.kind == Load::Kind::table_in_angle) s.table = l.table;
    s.waves.resize(l.harmonics.size()), s.wave_angles.resize(l.harmonics.size());
    loads_.push_back(s);
  }
  const std::size_t n = spec_.nodes.size();
  q_.resize(n), rate_.resize(n), force_.resize(n), residual_.resize(n);
  z.assign(mass_.size(), 0), v.assign(mass_.size(), 0);
  z_.resize(mass_.size());
  for (std::size_t i = 0; i < n; ++i)
    if (unknown_[i] >= 0 && root_[i] == static_cast<int>(i))
      z[at(unknown_[i])] = spec_.nodes[i].angle, v[at(unknown_[i])] = spec_.nodes[i].speed;
  for (std::size_t i = 0; i < loads_.size(); ++i)
    if (!loads_[i].table.empty()) {
      const Load& l = spec_.loads[i];
      const Real twist = l.actual_angle ? angle_now(l.node) : 0, rate = l.actual_angle ? rate_now(l.node) : 0;
      const Series phi = nominal();
      loads_[i].table.place(ratio_[at(l.node)] * phi[0] + twist + l.phase,
                            ratio_[at(l.node)] * phi[1] + rate);
    }
  for (std::size_t i = 0; i < meshes_.size(); ++i) settle_mesh(i, true);
  for (std::size_t i = 0; i < polylines_.size(); ++i) {
    const Polyline& p = spec_.polylines[i];
    const Real x = p.b >= 0 ? angle_now(p.b) - angle_now(p.a) : angle_now(p.a);
    int& segment = polylines_[i].segment;
    while (segment + 2 < static_cast<int>(p.x.size()) && x > p.x[at(segment + 1)]) ++segment;
  }
}

/// The root of a group of ideal gears is the node that is no gear's second one.
void ReferenceModel::find_groups() {
  const int n = static_cast<int>(spec_.nodes.size());
  root_.resize(at(n)), factor_.assign(at(n), 1), unknown_.assign(at(n), -1);
  for (int i = 0; i < n; ++i) root_[at(i)] = i;
  for (const Gear& g : spec_.gears) {  // in the order in which nodes were attached
    root_[at(g.b)] = root_[at(g.a)];
    factor_[at(g.b)] = factor_[at(g.a)] * g.ratio;
  }
  for (int i = 0; i < n; ++i)
    if (root_[at(i)] == i && !spec_.nodes[at(i)].prescribed) {
      unknown_[at(i)] = static_cast<int>(mass_.size());
      mass_.push_back(0);
    }
  for (int i = 0; i < n; ++i) {
    unknown_[at(i)] = unknown_[at(root_[at(i)])];
    if (unknown_[at(i)] >= 0)
      mass_[at(unknown_[at(i)])] += factor_[at(i)] * factor_[at(i)] * spec_.nodes[at(i)].inertia;
  }
}

/// Nominal ratios by walking every element that carries force at rest.
void ReferenceModel::find_ratios() {
  ratio_.assign(spec_.nodes.size(), 0);
  if (spec_.nominal.node < 0) return;
  std::vector<bool> known(spec_.nodes.size(), false);
  known[at(spec_.nominal.node)] = true, ratio_[at(spec_.nominal.node)] = 1;
  bool more = true;
  const auto tie = [&](int a, int b, Real ratio) {
    if (b < 0 || known[at(a)] == known[at(b)]) return;
    if (known[at(a)])
      ratio_[at(b)] = ratio * ratio_[at(a)];
    else
      ratio_[at(a)] = ratio_[at(b)] / ratio;
    known[at(a)] = known[at(b)] = more = true;
  };
  while (more) {
    more = false;
    for (const Shaft& s : spec_.shafts) tie(s.a, s.b, 1);
    for (const Gear& g : spec_.gears) tie(g.a, g.b, g.ratio);
    for (const Polyline& p : spec_.polylines) tie(p.a, p.b, 1);
    for (const Mesh& m : spec_.meshes)
      tie(m.a, m.b, (m.internal ? 1 : -1) * static_cast<Real>(m.radius_a) / m.radius_b);
  }
}

Real ReferenceModel::angle_now(int node) const {
  const int u = unknown_[at(node)];
  return u < 0 ? 0 : factor_[at(node)] * z[at(u)];
}

Real ReferenceModel::rate_now(int node) const {
  const int u = unknown_[at(node)];
  return u < 0 ? 0 : factor_[at(node)] * v[at(u)];
}

Real ReferenceModel::next_breakpoint() const {
  Real next = std::numeric_limits<Real>::infinity();
  const auto take = [&](double time) {
    if (time > t) next = std::min(next, static_cast<Real>(time));
  };
  if (spec_.nominal.node >= 0 && spec_.nominal.runs_up()) take(spec_.nominal.t_0), take(spec_.nominal.t_1);
  for (const Load& l : spec_.loads)
    for (const double time : l.times) take(time);
  return next;
}

/// phi, its rate and half its acceleration at t: the motion of a run-up is quadratic in each of its parts.
Series ReferenceModel::nominal() const {
  Series phi;
  const Nominal& n = spec_.nominal;
  if (n.node < 0) return phi;
  if (!n.runs_up() || t < n.t_0) {
    phi[0] = n.omega_0 * t, phi[1] = n.omega_0;
    return phi;
  }
  const Real length = static_cast<Real>(n.t_1) - n.t_0;
  const Real alpha = (static_cast<Real>(n.omega_1) - n.omega_0) / length;
  const Real s = std::min(t - n.t_0, length);
  phi[0] = n.omega_0 * (n.t_0 + s) + alpha * s * s / 2;
  phi[1] = n.omega_0 + alpha * s;
  phi[2] = alpha / 2;
  if (t >= n.t_1) phi[0] += n.omega_1 * (t - n.t_1), phi[1] = n.omega_1, phi[2] = 0;
  return phi;
}

void ReferenceModel::advance(Real s, const Real* time) {
  for (std::size_t u = 0; u < z_.size(); ++u) {
    const Poly motion{z_[u], degree_ + 2};
    z[u] = motion.value(s), v[u] = motion.slope(s);
  }
  t = time ? *time : t + s;
}

std::vector<const Series*> ReferenceModel::known_series() const {
  std::vector<const Series*> all;
  for (const MeshState& m : meshes_) all.push_back(&m.e), all.push_back(&m.k);
  for (const LoadState& l : loads_) all.push_back(&l.torque);
  return all;
}

void ReferenceModel::settle() {
  any_passed_ = false;
  for (std::size_t i = 0; i < meshes_.size(); ++i) settle_mesh(i, false);
}

ReferenceModel::Gap ReferenceModel::polyline_gap(int polyline) const {
  const Polyline& p = spec_.polylines[at(polyline)];
  Gap gap;
  for (std::size_t i = 0; i + 1 < p.x.size(); ++i)
    if (p.y[i] == 0 && p.y[i + 1] == 0) {
      if (gap.low >= gap.high) gap.low = p.x[i];
      gap.high = p.x[i + 1];
    }
  return gap;
}

}  // namespace coverage
