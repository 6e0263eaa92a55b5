#include "solvers/lane_step.hpp"

#include <algorithm>
#include <limits>
#include <type_traits>

namespace drev {

namespace {

/// A matrix by rows, or its diagonal where that is all there is. T: double where all lanes have one value.
template <class T>
struct Product {
  const int *outer, *inner;
  const T *values, *diagonal;

  /// out = row i of A x. All ways round alike (0 + ... keeps the product from being fused into what follows):
  /// a variant's result does not depend on its neighbours' matrices.
  [[gnu::always_inline]] void row(int i, const LaneRow* x, Lanes& out) const {
    if (diagonal) {
      out = Lanes{} + each(diagonal[i]) * x[i].v;
      return;
    }
    out = Lanes{};
    const int* const end = inner + outer[i + 1];
    const T* value = values + outer[i];
    for (const int* j = inner + outer[i]; j != end; ++j) out += each(*value++) * x[*j].v;
  }
};

template <class T>
[[gnu::always_inline]] inline const T* entries(const LaneValues& v) {
  if constexpr (std::is_same_v<T, double>)
    return v.common.empty() ? nullptr : v.common.data();
  else
    return v.rows.empty() ? nullptr : v.rows.data();
}
template <class T>
[[gnu::always_inline]] inline Product<T> product(const LaneMatrices& m, const LaneValues& values,
                                                 const LaneValues& diagonal) {
  return {m.pattern.outerIndexPtr(), m.pattern.innerIndexPtr(), entries<T>(values), entries<T>(diagonal)};
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
  for (LaneValues* a : {&mass, &damping, &stiffness}) a->rows.resize(slots.size());
  bool mass_is_diagonal = true, damping_is_diagonal = true;
  for (int lane = 0; lane < kLanes; ++lane) {
    const System& system = *systems[at(lane)];
    mass_is_diagonal = mass_is_diagonal && system.mass_is_diagonal();
    damping_is_diagonal = damping_is_diagonal && system.damping_is_diagonal();
    for (std::size_t s = 0; s < slots.size(); ++s) {
      mass.rows[s].v[lane] = system.mass_values()[slots[s]];
      damping.rows[s].v[lane] = system.damping_values()[slots[s]];
      stiffness.rows[s].v[lane] = system.stiffness_values()[slots[s]];
    }
  }
  for (const std::size_t s : diagonal) {
    if (mass_is_diagonal) mass_diagonal.rows.push_back(mass.rows[s]);
    if (damping_is_diagonal) damping_diagonal.rows.push_back(damping.rows[s]);
  }
  for (LaneValues* v : {&mass, &damping, &stiffness, &mass_diagonal, &damping_diagonal}) v->find_common();
  common = !mass.common.empty() && !damping.common.empty() && !stiffness.common.empty();
}

void LaneMatrices::combine(const Weights& w, LaneArray& values) const {
  values.resize(mass.rows.size());
  for (std::size_t s = 0; s < values.size(); ++s)
    values[s].v = w.m * mass.rows[s].v + w.c * damping.rows[s].v + w.k * stiffness.rows[s].v;
}

void LanePoint::get(int lane, StepPoint& point) const {
  const auto take = [&](const LaneArray& from, Vector& to) {
    to.resize(static_cast<Eigen::Index>(from.size()));
    for (std::size_t i = 0; i < from.size(); ++i) to[static_cast<Eigen::Index>(i)] = from[i].v[lane];
  };
  take(z, point.state.z), take(v, point.state.v), take(a, point.state.a);
  take(p, point.p), take(total, point.total);
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
  put(point.p, p), put(point.total, total);
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

namespace {

template <class T>
[[gnu::always_inline]] inline void predict_with(const LaneMatrices& m, const StepScheme& c, double h,
                                                const LanePoint& from, LaneArray& right, LanePoint& to) {
  const double phi = 1.0 - c.alpha_f, to_z_0 = h * h * (0.5 - c.beta), to_v_0 = h * (1.0 - c.gamma);
  const LaneRow *z = from.z.data(), *v = from.v.data(), *a = from.a.data(), *total = from.total.data();
  LaneRow *z_0 = to.z.data(), *v_0 = to.v.data(), *known = right.data();
  const Product<T> stiffness = product<T>(m, m.stiffness, {}),
                   damping = product<T>(m, m.damping, m.damping_diagonal),
                   mass = product<T>(m, m.mass, m.mass_diagonal);
  for (int i = 0; i < m.n; ++i) {
    const Lanes a_i = a[i].v, v_i = v[i].v;
    z_0[i].v = z[i].v + h * v_i + to_z_0 * a_i;
    v_0[i].v = v_i + to_v_0 * a_i;
  }
  for (int i = 0; i < m.n; ++i) {
    Lanes elastic, loss;
    stiffness.row(i, z_0, elastic);
    damping.row(i, v_0, loss);
    Lanes sum = -phi * (elastic + loss);
    if (c.alpha_m != 0.0) {
      Lanes inertia;
      mass.row(i, a, inertia);
      sum -= c.alpha_m * inertia;
    }
    if (c.alpha_f != 0.0) sum -= c.alpha_f * total[i].v;
    known[i].v = sum;
  }
}

template <class T>
[[gnu::always_inline]] inline void correct_with(double factor, const T* w, const LaneArray& lambda,
                                                const LaneRow* before, LaneArray& a, LaneRow& change) {
  const std::size_t m = lambda.size(), n = a.size();
  const LaneRow* force = lambda.data();
  LaneRow* to = a.data();
  Lanes most{};
  for (std::size_t i = 0; i < n; ++i) {
    Lanes sum{};
    for (std::size_t j = 0; j < m; ++j) sum += each(*w++) * force[j].v;
    sum = to[i].v - factor * sum;
    to[i].v = sum;
    larger(most, sum - before[i].v);
  }
  change.v = most;
}

/// The sums over all unknowns of a step's end.
struct Sums {
  LaneRow work, loss, kinetic, stored, largest;
};
template <class T>
[[gnu::always_inline]] inline void finish_with(const LaneMatrices& m, const StepScheme& c, double h,
                                               const LanePoint& from, const LaneForces& by, LanePoint& to,
                                               Sums& sums) {
  const double of_a = (1.0 - c.alpha_m) / (1.0 - c.alpha_f), of_a_0 = c.alpha_m / (1.0 - c.alpha_f),
               of_total = c.alpha_f / (1.0 - c.alpha_f), to_z = c.beta * h * h, to_v = c.gamma * h;
  const LaneRow *z_0 = from.z.data(), *v_0 = from.v.data(), *a_0 = from.a.data(), *p_0 = from.p.data(),
                *total_0 = from.total.data(), *a = to.a.data(), *p = to.p.data(), *force = by.values.data();
  LaneRow *total = to.total.data(), *z = to.z.data(), *v = to.v.data();
  const Product<T> damping = product<T>(m, m.damping, m.damping_diagonal),
                   mass = product<T>(m, m.mass, m.mass_diagonal);
  const int *next = by.rows.data(), *end = next + by.rows.size();
  Lanes work{}, loss{}, kinetic{}, stored{}, largest = sums.largest.v;
  const bool a_before = c.alpha_m != 0.0, forces_before = c.alpha_f != 0.0;
  const bool rows_apart = mass.diagonal && damping.diagonal;
  if (!rows_apart)
    for (int i = 0; i < m.n; ++i) v[i].v = v[i].v + to_v * a[i].v;
  for (int i = 0; i < m.n; ++i) {
    if (rows_apart) v[i].v = v[i].v + to_v * a[i].v;
    const Lanes z_i = z[i].v + to_z * a[i].v, p_i = p[i].v;
    z[i].v = z_i;
    Lanes inertia, mv, drag, drag_0;
    mass.row(i, a, inertia);
    mass.row(i, v, mv);
    damping.row(i, v, drag);
    damping.row(i, v_0, drag_0);
    Lanes sum = -of_a * inertia;
    if (a_before) {
      mass.row(i, a_0, inertia);
      sum -= of_a_0 * inertia;
    }
    if (forces_before) {
      sum -= of_total * total_0[i].v;
      total[i].v = sum;
    }
    Lanes elastic = sum + p_i - drag;
    if (next != end && *next == i) {
      elastic -= force++->v;
      ++next;
    }
    const Lanes moved = 0.5 * (z_i - z_0[i].v);
    work += moved * (p_0[i].v + p_i);
    loss += moved * (drag_0 + drag);
    kinetic += v[i].v * mv;
    stored += z_i * elastic;
    larger(largest, p_i);
    larger(largest, elastic);
  }
  sums.work.v = work, sums.loss.v = loss, sums.kinetic.v = kinetic, sums.stored.v = stored;
  sums.largest.v = largest;
}

}  // namespace

DREV_WIDEST
void predict(const LaneMatrices& m, const StepScheme& c, double h, const LanePoint& from, LaneArray& known,
             LanePoint& to) {
  if (m.common)
    predict_with<double>(m, c, h, from, known, to);
  else
    predict_with<LaneRow>(m, c, h, from, known, to);
}

DREV_WIDEST
void correct(double factor, const LaneValues& w, const LaneArray& lambda, const LaneRow* before, LaneArray& a,
             LaneRow& change) {
  if (!w.common.empty())
    correct_with(factor, w.common.data(), lambda, before, a, change);
  else
    correct_with(factor, w.rows.data(), lambda, before, a, change);
}

DREV_WIDEST
void largest(const LaneArray& x, LaneRow& out) {
  Lanes most{};
  for (const LaneRow& row : x) larger(most, row.v);
  out.v = most;
}

DREV_WIDEST
void largest_difference(const LaneArray& x, const LaneArray& y, LaneRow& out) {
  Lanes most{};
  for (std::size_t i = 0; i < x.size(); ++i) larger(most, x[i].v - y[i].v);
  out.v = most;
}

DREV_WIDEST
void finish(const LaneMatrices& m, const StepScheme& c, double h, double t, const LanePoint& from,
            const LaneForces& by, const LaneRow& extra_input, LanePoint& to, LaneMask& good,
            LaneEnergy& energy, LaneRow& force_scale) {
  Sums sums;
  sums.largest = force_scale;
  if (m.common)
    finish_with<double>(m, c, h, from, by, to, sums);
  else
    finish_with<LaneRow>(m, c, h, from, by, to, sums);
  const Lanes work = sums.work.v;
  Lanes loss = sums.loss.v, kinetic = sums.kinetic.v, stored = sums.stored.v, largest = sums.largest.v;
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
