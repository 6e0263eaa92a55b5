#include "solvers/batch/lane_step.hpp"

#include <algorithm>
#include <type_traits>

#include "solvers/linear/vector_kernels.hpp"

namespace drev {

namespace {

constexpr int kLeastChain = 4;  // unknowns

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
    add_row_product(outer, inner, values, x, i, out);
  }
};

/// The same for a matrix that is known to be diagonal.
template <class T>
struct DiagonalProduct {
  const T* diagonal;

  [[gnu::always_inline]] void row(int i, const LaneRow* x, Lanes& out) const {
    out = Lanes{} + each(diagonal[i]) * x[i].v;
  }
};

/// The same for a chain's matrix.
template <class T>
struct ChainProduct {
  const T* values;
  int last;

  [[gnu::always_inline]] void row(int i, const LaneRow* x, Lanes& out) const {
    const T* value = values + 3 * i;
    out = Lanes{};
    if (i > 0) out += each(value[-1]) * x[i - 1].v;
    out += each(value[0]) * x[i].v;
    if (i < last) out += each(value[1]) * x[i + 1].v;
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

/// The usual case, for which loops are shorter (kAtEnd): the equation is of the step's end alone, M and C are
/// diagonal.
template <class T>
bool at_end(const StepScheme& c, const Product<T>& mass, const Product<T>& damping) {
  return c.alpha_m == 0.0 && c.alpha_f == 0.0 && mass.diagonal && damping.diagonal;
}

}  // namespace

LaneMatrices::LaneMatrices(const std::array<const System*, kLanes>& systems) : n(systems[0]->size()) {
  const SparseMatrix& full = systems[0]->pattern();
  std::vector<Eigen::Triplet<double>> kept;
  std::vector<int> slots;
  std::vector<std::size_t> diagonal;  // places of the diagonal among the slots kept
  const int *outer = full.outerIndexPtr(), *inner = full.innerIndexPtr();
  const auto filled = [&](int s) {
    return std::any_of(systems.begin(), systems.end(), [s](const System* system) {
      return system->mass_values()[s] != 0.0 || system->damping_values()[s] != 0.0 ||
             system->stiffness_values()[s] != 0.0;
    });
  };
  const auto keep = [&](int i, int j, int s) {
    if (i == j) diagonal.push_back(slots.size());
    kept.emplace_back(i, j, 1.0);
    slots.push_back(s);
  };
  int links = 0, others = 0;
  for (int j = 0; j < n; ++j)
    for (int s = outer[j]; s < outer[j + 1]; ++s)
      if (inner[s] > j && filled(s)) ++(inner[s] == j + 1 ? links : others);
  chain = n >= kLeastChain && others == 0 && 2 * links >= n;
  for (int j = 0; j < n; ++j)
    if (chain) {
      for (int i = std::max(0, j - 1); i <= std::min(n - 1, j + 1); ++i) {
        const int* const found = std::lower_bound(inner + outer[j], inner + outer[j + 1], i);
        keep(i, j, found != inner + outer[j + 1] && *found == i ? static_cast<int>(found - inner) : -1);
      }
    } else {
      for (int s = outer[j]; s < outer[j + 1]; ++s)
        if (inner[s] == j || filled(s)) keep(inner[s], j, s);
    }
  pattern.resize(n, n);
  pattern.setFromTriplets(kept.begin(), kept.end());
  for (LaneValues* a : {&mass, &damping, &stiffness}) a->rows.resize(slots.size());
  bool mass_is_diagonal = true, damping_is_diagonal = true;
  for (int lane = 0; lane < kLanes; ++lane) {
    const System& system = *systems[idx(lane)];
    mass_is_diagonal = mass_is_diagonal && system.mass_is_diagonal();
    damping_is_diagonal = damping_is_diagonal && system.damping_is_diagonal();
    for (std::size_t s = 0; s < slots.size(); ++s) {
      if (slots[s] < 0) continue;
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

void LanePoint::get(int lane, EvaluatedState& point) const {
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

void LanePoint::set(int lane, const EvaluatedState& point) {
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

namespace {
/// f(x, y) for every number of two balances.
template <class A, class B, class F>
void for_each_number(A& a, B& b, const F& f) {
  f(a.start, b.start), f(a.kinetic, b.kinetic), f(a.stored, b.stored), f(a.input, b.input);
  f(a.dissipated, b.dissipated), f(a.imbalance, b.imbalance), f(a.worst_imbalance, b.worst_imbalance);
  f(a.worst_time, b.worst_time), f(a.given, b.given), f(a.scale, b.scale);
}
}  // namespace

EnergyBalance LaneEnergy::get(int lane) const {
  EnergyBalance balance;
  for_each_number(*this, balance, [lane](const LaneRow& from, double& to) { to = from.v[lane]; });
  return balance;
}

void LaneEnergy::set(int lane, const EnergyBalance& balance) {
  for_each_number(*this, balance, [lane](LaneRow& to, double from) { to.v[lane] = from; });
}

namespace {

template <bool kAtEnd, class Stiffness, class Matrix>
[[gnu::always_inline]] inline void predict_with(const Stiffness& stiffness, const Matrix& mass,
                                                const Matrix& damping, const StepScheme& c, double h,
                                                const LanePoint& from, LaneArray& right_side, LanePoint& to) {
  const double phi = 1.0 - c.alpha_f, to_z_0 = h * h * (0.5 - c.beta), to_v_0 = h * (1.0 - c.gamma),
               of_a = kAtEnd ? 0.0 : c.alpha_m, of_total = kAtEnd ? 0.0 : c.alpha_f;
  const LaneRow *z = from.z.data(), *v = from.v.data(), *a = from.a.data(), *total = from.total.data();
  LaneRow *z_0 = to.z.data(), *v_0 = to.v.data(), *known = right_side.data();
  const int n = static_cast<int>(from.z.size());
  for (int i = 0; i < n; ++i) {
    const Lanes a_i = a[i].v, v_i = v[i].v;
    z_0[i].v = z[i].v + h * v_i + to_z_0 * a_i;
    v_0[i].v = v_i + to_v_0 * a_i;
  }
  for (int i = 0; i < n; ++i) {
    Lanes elastic, loss;
    stiffness.row(i, z_0, elastic);
    damping.row(i, v_0, loss);
    Lanes sum = -phi * (elastic + loss);
    if (of_a != 0.0) {
      Lanes inertia;
      mass.row(i, a, inertia);
      sum -= of_a * inertia;
    }
    if (of_total != 0.0) sum -= of_total * total[i].v;
    known[i].v = sum;
  }
}
template <class T>
[[gnu::always_inline]] inline void predict_with(const LaneMatrices& m, const StepScheme& c, double h,
                                                const LanePoint& from, LaneArray& right_side, LanePoint& to) {
  const Product<T> mass = product<T>(m, m.mass, m.mass_diagonal),
                   damping = product<T>(m, m.damping, m.damping_diagonal);
  const DiagonalProduct<T> lumped{mass.diagonal}, dashpots{damping.diagonal};
  if (m.chain && at_end(c, mass, damping))
    predict_with<true>(ChainProduct<T>{entries<T>(m.stiffness), m.n - 1}, lumped, dashpots, c, h, from,
                       right_side, to);
  else
    predict_with<false>(product<T>(m, m.stiffness, {}), mass, damping, c, h, from, right_side, to);
}

template <class T>
[[gnu::always_inline]] inline void correct_with(double factor, const T* w, const LaneArray& lambda,
                                                const LaneRow* before, LaneArray& a, LaneRow& change) {
  const std::size_t m = lambda.size(), n = a.size();
  const LaneRow* force = lambda.data();
  LaneRow* to = a.data();
  Lanes most{};
  const auto row = [&](std::size_t i, const Lanes& sum) {
    const Lanes corrected = to[i].v - factor * sum;
    to[i].v = corrected;
    larger(most, corrected - before[i].v);
  };
  if (m == 2) {  // most often: two stages of gears
    const Lanes force_0 = force[0].v, force_1 = force[1].v;
    for (std::size_t i = 0; i < n; ++i, w += 2) {
      Lanes sum = each(w[0]) * force_0;
      sum += each(w[1]) * force_1;
      row(i, sum);
    }
  } else {
    for (std::size_t i = 0; i < n; ++i) {
      Lanes sum{};
      for (std::size_t j = 0; j < m; ++j) sum += each(*w++) * force[j].v;
      row(i, sum);
    }
  }
  change.v = most;
}

/// The sums over all unknowns of a step's end.
struct Sums {
  LaneRow work, loss, kinetic, stored, largest;
};
template <bool kAtEnd, class Matrix>
[[gnu::always_inline]] inline void finish_with(const LaneMatrices& m, const Matrix& mass,
                                               const Matrix& damping, const StepScheme& c, double h,
                                               const LanePoint& from, const LaneForces& by, LanePoint& to,
                                               Sums& sums) {
  const double of_a = (1.0 - c.alpha_m) / (1.0 - c.alpha_f), of_a_0 = c.alpha_m / (1.0 - c.alpha_f),
               of_total = c.alpha_f / (1.0 - c.alpha_f), to_z = c.beta * h * h, to_v = c.gamma * h;
  const LaneRow *z_0 = from.z.data(), *v_0 = from.v.data(), *a_0 = from.a.data(), *p_0 = from.p.data(),
                *total_0 = from.total.data(), *a = to.a.data(), *p = to.p.data(), *force = by.values.data();
  LaneRow *total = to.total.data(), *z = to.z.data(), *v = to.v.data();
  const int *next = by.rows.data(), *end = next + by.rows.size();
  // Two largest, since a maximum waits for the one before it.
  Lanes work{}, loss{}, kinetic{}, stored{}, largest = sums.largest.v, largest_elastic{};
  const bool a_before = !kAtEnd && c.alpha_m != 0.0, forces_before = !kAtEnd && c.alpha_f != 0.0;
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
    larger(largest_elastic, elastic);
  }
  larger(largest, largest_elastic);
  sums.work.v = work, sums.loss.v = loss, sums.kinetic.v = kinetic, sums.stored.v = stored;
  sums.largest.v = largest;
}
template <class T>
[[gnu::always_inline]] inline void finish_with(const LaneMatrices& m, const StepScheme& c, double h,
                                               const LanePoint& from, const LaneForces& by, LanePoint& to,
                                               Sums& sums) {
  const Product<T> mass = product<T>(m, m.mass, m.mass_diagonal),
                   damping = product<T>(m, m.damping, m.damping_diagonal);
  if (at_end(c, mass, damping))
    finish_with<true>(m, DiagonalProduct<T>{mass.diagonal}, DiagonalProduct<T>{damping.diagonal}, c, h, from,
                      by, to, sums);
  else
    finish_with<false>(m, mass, damping, c, h, from, by, to, sums);
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
  const Lanes input = energy.input.v + work + extra_input.v, dissipated = energy.dissipated.v + loss;
  enter_step(energy, kinetic, stored, input, dissipated, t, good);
  force_scale.v = good ? largest : force_scale.v;
}

}  // namespace drev
