#include "solvers/lane_step.hpp"

#include <algorithm>
#include <limits>

namespace drev {

namespace {

[[gnu::always_inline]] inline void larger(Lanes& most, const Lanes& x) {
  const Lanes size = x < 0.0 ? -x : x;
  most = most < size ? size : most;
}

/// out = row i of A x. Both ways round alike (0 + ... keeps the product from being fused into what follows):
/// a variant's result does not depend on whether its neighbours' matrices are diagonal.
[[gnu::always_inline]] inline void row_product(const LaneMatrices& m, const LaneArray& values,
                                               const LaneArray& diagonal, const LaneRow* x, int i,
                                               Lanes& out) {
  if (!diagonal.empty()) {
    out = Lanes{} + diagonal.data()[i].v * x[i].v;
    return;
  }
  const int* outer = m.pattern.outerIndexPtr();
  const int* inner = m.pattern.innerIndexPtr();
  const LaneRow* v = values.data();
  out = Lanes{};
  for (int s = outer[i]; s < outer[i + 1]; ++s) out += v[s].v * x[inner[s]].v;
}

}  // namespace

LaneMatrices::LaneMatrices(const std::array<const System*, kLanes>& systems) : n(systems[0]->size()) {
  const SparseMatrix& full = systems[0]->pattern();
  std::vector<Eigen::Triplet<double>> kept;
  std::vector<int> slots;
  std::vector<std::size_t> diagonal;  // of the slots kept
  for (int j = 0; j < n; ++j)
    for (int s = full.outerIndexPtr()[j]; s < full.outerIndexPtr()[j + 1]; ++s) {
      const int i = full.innerIndexPtr()[s];
      const bool there = i == j || std::any_of(systems.begin(), systems.end(), [&](const System* system) {
        return system->mass_values()[s] != 0.0 || system->damping_values()[s] != 0.0 ||
               system->stiffness_values()[s] != 0.0;
      });
      if (!there) continue;
      kept.emplace_back(i, j, 1.0);
      slots.push_back(s);
      if (i == j) diagonal.push_back(slots.size() - 1);
    }
  pattern.resize(n, n);
  pattern.setFromTriplets(kept.begin(), kept.end());
  for (LaneArray* a : {&mass, &damping, &stiffness}) a->resize(slots.size());
  bool mass_is_diagonal = true, damping_is_diagonal = true;
  for (int lane = 0; lane < kLanes; ++lane) {
    const System& system = *systems[at(lane)];
    mass_is_diagonal = mass_is_diagonal && system.mass_is_diagonal();
    damping_is_diagonal = damping_is_diagonal && system.damping_is_diagonal();
    for (std::size_t s = 0; s < slots.size(); ++s) {
      mass[s].v[lane] = system.mass_values()[slots[s]];
      damping[s].v[lane] = system.damping_values()[slots[s]];
      stiffness[s].v[lane] = system.stiffness_values()[slots[s]];
    }
  }
  for (const std::size_t s : diagonal) {
    if (mass_is_diagonal) mass_diagonal.push_back(mass[s]);
    if (damping_is_diagonal) damping_diagonal.push_back(damping[s]);
  }
}

void LaneMatrices::combine(const Weights& w, LaneArray& values) const {
  values.resize(mass.size());
  for (std::size_t s = 0; s < values.size(); ++s)
    values[s].v = w.m * mass[s].v + w.c * damping[s].v + w.k * stiffness[s].v;
}

void LanePoint::get(int lane, StepPoint& point) const {
  const auto take = [&](const LaneArray& from, Vector& to) {
    to.resize(static_cast<Eigen::Index>(from.size()));
    for (std::size_t i = 0; i < from.size(); ++i) to[static_cast<Eigen::Index>(i)] = from[i].v[lane];
  };
  take(z, point.state.z), take(v, point.state.v), take(a, point.state.a);
  take(p, point.p), take(cv, point.cv), take(total, point.total);
  const std::size_t m = laws.x.size();
  point.inputs.resize(m);
  point.responses.resize(m);
  for (std::size_t j = 0; j < m; ++j) {
    point.inputs[j] = {laws.x[j].v[lane], laws.x_dot[j].v[lane], laws.t, laws.angle[j].v[lane]};
    point.responses[j] = {.y = laws.y[j].v[lane],
                          .stored_energy = laws.energy[j].v[lane],
                          .dissipated_power = laws.power[j].v[lane]};
  }
}

void LanePoint::set(int lane, const StepPoint& point) {
  const auto put = [&](const Vector& from, LaneArray& to) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i].v[lane] = from[static_cast<Eigen::Index>(i)];
  };
  put(point.state.z, z), put(point.state.v, v), put(point.state.a, a);
  put(point.p, p), put(point.cv, cv), put(point.total, total);
  for (std::size_t j = 0; j < laws.x.size(); ++j) {
    const ScalarInput& in = point.inputs[j];
    const ScalarResponse& r = point.responses[j];
    laws.x[j].v[lane] = in.x, laws.x_dot[j].v[lane] = in.x_dot, laws.angle[j].v[lane] = in.angle;
    laws.y[j].v[lane] = r.y;
    laws.energy[j].v[lane] = r.stored_energy, laws.power[j].v[lane] = r.dissipated_power;
    laws.t = in.t;
  }
}

EnergyBalance LaneEnergy::get(int lane) const {
  return {kinetic.v[lane],   stored.v[lane],     input.v[lane], dissipated.v[lane], imbalance.v[lane],
          worst.v[lane], worst_time.v[lane], given.v[lane], scale.v[lane]};
}

void LaneEnergy::set(int lane, const EnergyBalance& b) {
  kinetic.v[lane] = b.kinetic, stored.v[lane] = b.stored;
  input.v[lane] = b.input, dissipated.v[lane] = b.dissipated;
  imbalance.v[lane] = b.imbalance, worst.v[lane] = b.worst_imbalance, worst_time.v[lane] = b.worst_time;
  given.v[lane] = b.given, scale.v[lane] = b.scale;
}

DREV_WIDEST
void predict(const LaneMatrices& m, const StepScheme& c, double h, const LanePoint& from, bool rates,
             LanePrediction& step, LanePoint& to) {
  const double phi = 1.0 - c.alpha_f, to_z_0 = h * h * (0.5 - c.beta), to_v_0 = h * (1.0 - c.gamma),
               to_z = c.beta * h * h, to_v = c.gamma * h;
  const LaneRow *z = from.z.data(), *v = from.v.data(), *a = from.a.data(), *total = from.total.data();
  LaneRow *z_0 = step.z_0.data(), *v_0 = step.v_0.data(), *known = step.known.data();
  LaneRow *z_1 = to.z.data(), *v_1 = to.v.data();
  const LaneArray full;
  for (int i = 0; i < m.n; ++i) {
    const Lanes a_i = a[i].v, v_i = v[i].v;
    const Lanes z_free = z[i].v + h * v_i + to_z_0 * a_i, v_free = v_i + to_v_0 * a_i;
    z_0[i].v = z_free;
    v_0[i].v = v_free;
    z_1[i].v = z_free + to_z * a_i;
    if (rates) v_1[i].v = v_free + to_v * a_i;
  }
  for (int i = 0; i < m.n; ++i) {
    Lanes elastic, loss;
    row_product(m, m.stiffness, full, z_0, i, elastic);
    row_product(m, m.damping, m.damping_diagonal, v_0, i, loss);
    Lanes sum = -phi * (elastic + loss);
    if (c.alpha_m != 0.0) {
      Lanes inertia;
      row_product(m, m.mass, m.mass_diagonal, a, i, inertia);
      sum -= c.alpha_m * inertia;
    }
    if (c.alpha_f != 0.0) sum -= c.alpha_f * total[i].v;
    known[i].v = sum;
  }
}

DREV_WIDEST
void correct(const StepScheme& c, double h, const LanePrediction& step, const LaneArray& w,
             const LaneArray& lambda, bool rates, LanePoint& to) {
  const double phi = 1.0 - c.alpha_f, to_z = c.beta * h * h, to_v = c.gamma * h;
  const auto n = static_cast<int>(step.z_0.size());
  const LaneRow *z_0 = step.z_0.data(), *v_0 = step.v_0.data();
  LaneRow *a = to.a.data(), *z = to.z.data(), *v = to.v.data();
  const std::size_t m = lambda.size();
  const LaneRow *force = lambda.data(), *row = w.data();
  for (int i = 0; i < n; ++i) {
    Lanes sum{};
    for (std::size_t j = 0; j < m; ++j) sum += row++->v * force[j].v;
    a[i].v = sum = a[i].v - phi * sum;
    z[i].v = z_0[i].v + to_z * sum;
    if (rates) v[i].v = v_0[i].v + to_v * sum;
  }
}

DREV_WIDEST
void finish(const LaneMatrices& m, const StepScheme& c, double h, double t, const LanePoint& from,
            const LanePrediction& step, const LaneForces& by, const LaneRow& extra_input, LanePoint& to,
            LaneMask& good, LaneEnergy& energy, LaneRow& force_scale) {
  const double of_a = (1.0 - c.alpha_m) / (1.0 - c.alpha_f), of_a_0 = c.alpha_m / (1.0 - c.alpha_f),
               of_total = c.alpha_f / (1.0 - c.alpha_f), to_v = c.gamma * h;
  const LaneRow *z_0 = from.z.data(), *a_0 = from.a.data(), *p_0 = from.p.data(), *cv_0 = from.cv.data(),
                *total_0 = from.total.data(), *v_0 = step.v_0.data(), *z = to.z.data(), *a = to.a.data(),
                *p = to.p.data();
  LaneRow *total = to.total.data(), *cv = to.cv.data(), *v = to.v.data();
  Lanes work{}, loss{}, kinetic{}, stored{}, largest = force_scale.v;
  const bool rows_apart = !m.mass_diagonal.empty() && !m.damping_diagonal.empty();
  if (!rows_apart)
    for (int i = 0; i < m.n; ++i) v[i].v = v_0[i].v + to_v * a[i].v;
  std::size_t next = 0;  // of by
  for (int i = 0; i < m.n; ++i) {
    if (rows_apart) v[i].v = v_0[i].v + to_v * a[i].v;
    Lanes inertia, mv, drag;
    row_product(m, m.mass, m.mass_diagonal, a, i, inertia);
    row_product(m, m.mass, m.mass_diagonal, v, i, mv);
    row_product(m, m.damping, m.damping_diagonal, v, i, drag);
    Lanes sum = -of_a * inertia;
    if (c.alpha_m != 0.0) {
      row_product(m, m.mass, m.mass_diagonal, a_0, i, inertia);
      sum -= of_a_0 * inertia;
    }
    if (c.alpha_f != 0.0) {
      sum -= of_total * total_0[i].v;
      total[i].v = sum;
    }
    Lanes elastic = sum + p[i].v - drag;
    if (next < by.rows.size() && by.rows[next] == i) elastic -= by.values[next++].v;
    cv[i].v = drag;
    const Lanes moved = 0.5 * (z[i].v - z_0[i].v);
    work += moved * (p_0[i].v + p[i].v);
    loss += moved * (cv_0[i].v + drag);
    kinetic += v[i].v * mv;
    stored += z[i].v * elastic;
    larger(largest, p[i].v);
    larger(largest, elastic);
  }
  stored *= 0.5;
  kinetic *= 0.5;
  for (std::size_t j = 0; j < to.laws.y.size(); ++j) {
    loss += 0.5 * h * (from.laws.power[j].v + to.laws.power[j].v);
    stored += to.laws.energy[j].v;
    larger(largest, to.laws.y[j].v);
  }
  LaneEnergy& b = energy;
  const Lanes input = b.input.v + work + extra_input.v, dissipated = b.dissipated.v + loss;
  const Lanes all = kinetic + stored;
  const Lanes imbalance = all - b.start.v - input + dissipated;
  Lanes given = b.given.v;
  larger(given, input);
  given = given < dissipated ? dissipated : given;
  Lanes scale = b.scale.v < given ? given : b.scale.v;
  scale = scale < all ? all : scale;
  Lanes size = imbalance < 0.0 ? -imbalance : imbalance;
  good &= size <= std::numeric_limits<double>::max();
  const Lanes worst_so_far = b.worst.v < 0.0 ? -b.worst.v : b.worst.v;
  const LaneMask worse = good & (size > worst_so_far);
  b.worst.v = worse ? imbalance : b.worst.v;
  b.worst_time.v = worse ? Lanes{} + t : b.worst_time.v;
  b.kinetic.v = good ? kinetic : b.kinetic.v;
  b.stored.v = good ? stored : b.stored.v;
  b.input.v = good ? input : b.input.v;
  b.dissipated.v = good ? dissipated : b.dissipated.v;
  b.imbalance.v = good ? imbalance : b.imbalance.v;
  b.given.v = good ? given : b.given.v;
  b.scale.v = good ? scale : b.scale.v;
  force_scale.v = good ? largest : force_scale.v;
}

}  // namespace drev
