#include "solvers/exact/kink_moments.hpp"

#include <algorithm>
#include <array>

#include "solvers/linear/lane_pair.hpp"
#include "solvers/series/taylor_series.hpp"

namespace drev {

namespace {

constexpr int kMomentNodes = 10;
constexpr int kMaxNewton = 30;
constexpr double kSettled = 1e-8;  // Newton's rule ends below this last step in s
// The same where the force is continuous, so that the square of the place's error counts.
constexpr double kSweepSettled = 1e-5;

/// A kink's knot and the angle at the end; in lanes without one, 0 and 1, where theta = s.
template <class L>
[[gnu::always_inline]] inline void load_turn(const double* knot, const double* end, const L& kinks, L& target,
                                             L& at_end) {
  load(knot, target);
  load(end, at_end);
  target *= kinks;
  at_end = at_end * kinks + (1.0 - kinks);
}

/// The terms of kLanes angles: turn Z_k + ratio phi_k; theta = s in lanes without a kink.
struct Angles {
  template <class L>
  [[gnu::always_inline]] static void run(const int* row, const double* lanes, const double* angle,
                                         const double* ratio, const double* turn, const double* columns,
                                         int stride, std::size_t known, std::size_t terms, double phi_1,
                                         double phi_2, double* theta) {
    L kinks, by, x{};
    load(lanes, kinks);
    load(angle, x);
    store(kinks * x, theta);
    load(turn, by);
    by *= kinks;
    const double* column = columns + stride;
    for (std::size_t k = 1; k < known; ++k, column += stride) {
      gather(column, row, x);
      store(by * x, theta + k * kLanes);
    }
    for (std::size_t k = known; k < terms; ++k) store(L{}, theta + k * kLanes);
    load(ratio, by);
    by *= kinks;
    load(theta + kLanes, x);
    x += phi_1 * by + (1.0 - kinks);
    store(x, theta + kLanes);
    load(theta + 2 * kLanes, x);
    x += phi_2 * by;
    store(x, theta + 2 * kLanes);
  }
};

/// s where theta = target, from the line between 0 and `end`, where theta is at_end. By Newton's rule, within [0, end], until
/// `lanes` of them settle.
template <class L>
[[gnu::always_inline]] inline void find_place(const double* theta, std::size_t terms, const double* lanes,
                                              const L& target, const L& at_end, double end, double settled,
                                              L& s) {
  L x;
  load(theta, x);
  s = end * (target - x) / (at_end - x);
  for (int newton = 0; newton < kMaxNewton; ++newton) {
    L value{}, slope{};
    for (std::size_t k = terms; k-- > 0;) {
      load(theta + k * kLanes, x);
      slope = slope * s + value;
      value = value * s + x;
    }
    L step = (value - target) / slope;
    s -= step;
    L within{};
    raise(within, s);
    s = L{} + end;
    sink(s, within);
    magnitude(step);
    load(lanes, x);
    step *= x;
    if (largest_of(step) < settled) break;  // the next step would be its square
  }
}

/// theta at two places.
template <class L>
[[gnu::always_inline]] inline void angles(const double* theta, std::size_t terms, const L& s_0, const L& s_1,
                                          L& f_0, L& f_1) {
  L x;
  f_0 = L{};
  f_1 = L{};
  for (std::size_t k = terms; k-- > 0;) {
    load(theta + k * kLanes, x);
    f_0 = f_0 * s_0 + x;
    f_1 = f_1 * s_1 + x;
  }
}

/// x becomes its polynomial, whose terms from the first power on are at `force`.
template <class L>
[[gnu::always_inline]] inline void take_force(const double* force, std::size_t powers, L& x) {
  L value, term;
  load(force + (powers - 1) * kLanes, value);
  for (std::size_t q = powers - 1; q-- > 0;) {
    load(force + q * kLanes, term);
    value = value * x + term;
  }
  x = value * x;
}

/// Moments int_s^1 f(theta - knot) L_j du of kLanes kinks, behind the s at which theta = knot, by Gauss's rule with
/// kMomentNodes nodes between s and 1: exact where f is of degree 11 in s there.
struct Moments {
  template <class L>
  [[gnu::always_inline]] static void run(const double* theta, std::size_t terms, const double* lanes,
                                         const double* knot, const double* force, std::size_t powers,
                                         const double* end, const double* nodes, const double* weights,
                                         double* place, double* moments) {
    L target, at_end, s;
    load(lanes, s);
    load_turn(knot, end, s, target, at_end);
    find_place(theta, terms, lanes, target, at_end, 1.0, kSettled, s);
    store(s, place);
    L sum[kProjectionTerms];
    clear(sum);
    const L rest = 1.0 - s;
    for (int q = 0; q < kMomentNodes; q += 2) {
      const L s_0 = s + nodes[q] * rest, s_1 = s + nodes[q + 1] * rest;
      L f_0, f_1;
      angles(theta, terms, s_0, s_1, f_0, f_1);
      for (int node = 0; node < 2; ++node) {
        const L u = 2.0 * (node == 0 ? s_0 : s_1) - 1.0;
        L f = (node == 0 ? f_0 : f_1) - target;
        take_force(force, powers, f);
        L below = weights[q + node] * f, now = u * below;
        sum[0] += below;
        sum[1] += now;
        for (int j = 1; j < kProjectionDegree; ++j) {
          const L next = ((2.0 * j + 1.0) / (j + 1.0)) * (u * now) - (j / (j + 1.0)) * below;
          below = now;
          now = next;
          sum[j + 1] += now;
        }
      }
    }
    for (int j = 0; j < kProjectionTerms; ++j) {
      sum[j] *= (2.0 * j + 1.0) * rest;
      store(sum[j], moments + j * kLanes);
    }
  }
};

/// Moments int_s^e (e - s)^j/j! f(theta - knot) ds, j = 0 ... degree, by Gauss's rule with kSweepNodes nodes, whose weights times
/// (1 - node)^j/j! are at weights + j kSweepNodes; `step` apart, zeros in lanes without a kink.
template <int kSweepNodes>
struct SweepMoments {
  template <class L>
  [[gnu::always_inline]] static void run(const double* theta, std::size_t terms, std::size_t place_terms,
                                         const double* lanes, const double* knot, const double* force,
                                         std::size_t powers, const double* end, double s_end,
                                         const double* nodes, const double* weights, int degree,
                                         double* place, int step, double* moments) {
    L target, at_end, s;
    load(lanes, s);
    load_turn(knot, end, s, target, at_end);
    find_place(theta, place_terms, lanes, target, at_end, s_end, kSweepSettled, s);
    store(s, place);
    const L rest = s_end - s;
    double f[kSweepNodes * kLanes];
    for (int q = 0; q < kSweepNodes; q += 2) {
      L f_0, f_1;
      angles(theta, terms, s + nodes[q] * rest, s + nodes[q + 1] * rest, f_0, f_1);
      f_0 = f_0 - target;
      f_1 = f_1 - target;
      take_force(force, powers, f_0);
      take_force(force, powers, f_1);
      store(f_0, f + q * kLanes);
      store(f_1, f + (q + 1) * kLanes);
    }
    L power;  // rest^(j+1)
    load(lanes, power);
    power *= rest;
    for (int j = 0; j <= degree; ++j, weights += kSweepNodes, moments += step) {
      L sum{}, x;
      for (int q = 0; q < kSweepNodes; ++q) {
        load(f + q * kLanes, x);
        sum += weights[q] * x;
      }
      sum *= power;
      store(sum, moments);
      power *= rest;
    }
  }
};

template <int kNodes>
struct NodesAndWeights {
  std::array<double, kNodes> nodes, weights;
  NodesAndWeights() { find_gauss_rule(kNodes, nodes.data(), weights.data()); }
};

/// The weights of SweepMoments.
template <int kNodes>
struct SweepRule : NodesAndWeights<kNodes> {
  std::array<double, std::size_t{kNodes} * (TaylorSeries::kMostSwept + 1)> of_moments;
  SweepRule() {
    for (std::size_t q = 0; q < kNodes; ++q) {
      double weight = this->weights[q];
      for (std::size_t j = 0; j <= TaylorSeries::kMostSwept; ++j) {
        of_moments[j * kNodes + q] = weight;
        weight *= (1.0 - this->nodes[q]) / static_cast<double>(j + 1);
      }
    }
  }
};

}  // namespace

/// int f dz of kinks, z = (theta - ratio phi)/turn: of f(theta_e + turn y - knot) in closed form, less ratio int f phi' ds, where f bends
/// by its slope at the end times turn y.
struct KinkMoments::Work {
  template <class L>
  [[gnu::always_inline]] static double run(const KinkMoments* kinks, double rate, double bend,
                                           const double* y, const double* y_sum, const double* y_sum_2) {
    L sum{};
    for (int i = 0; i < kinks->count_; i += kLanes) {
      const auto at = [&](Quantity q) __attribute__((always_inline)) { return kinks->table_.at(q) + i; };
      const int* row = kinks->row_.data() + i;
      L behind, knot, turn, x{}, along, along_2;
      load(at(kTurn), turn);
      load(at(kEnd), behind);
      load(at(kKnot), knot);
      gather(y, row, x);
      behind = behind - knot + turn * x;
      const double* force = kinks->force_.data() + idx_of(i) / kLanes * kForce;
      L slope{}, integral{};
      for (std::size_t q = kinks->powers_; q-- > 0;) {
        load(force + q * kLanes, x);
        slope = slope * behind + static_cast<double>(q + 1) * x;
        integral = integral * behind + (1.0 / static_cast<double>(q + 2)) * x;
      }
      slope *= turn;
      const double* moments = kinks->sweep_moments_.data() + i;
      load(moments, along);
      gather(y_sum, row, x);
      along += slope * x;
      load(moments + whole_lanes(kinks->count_), along_2);
      gather(y_sum_2, row, x);
      along_2 += slope * x;
      load(at(kRatio), x);
      x = integral * (behind * behind) - x * (rate * along - bend * along_2);
      load(at(kPerTurn), turn);
      load(first_lanes(kinks->count_ - i), along);
      sum += (along * turn) * x;
    }
    return sum_of(sum);
  }
};

double KinkMoments::work(double rate, double bend, const double* y, const double* y_sum,
                         const double* y_sum_2) const {
  return run_widest<Work>(this, rate, bend, y, y_sum, y_sum_2);
}

void KinkMoments::make_room() {
  table_.make_room();
  row_.resize(table_.room());
  theta_.resize(table_.room() * kMostTerms);
  force_.resize(table_.room() * kMostPowers);
}

void KinkMoments::expand(const double* columns, int stride, std::size_t known, std::size_t terms,
                         const std::array<double, 3>& phi) {
  terms_ = terms;
  for (int i = 0; i < count_; i += kLanes)
    run_widest<Angles>(static_cast<const int*>(row_.data() + i), first_lanes(count_ - i),
                       static_cast<const double*>(table_.at(kAngle) + i),
                       static_cast<const double*>(table_.at(kRatio) + i),
                       static_cast<const double*>(table_.at(kTurn) + i), columns, stride, known, terms,
                       phi[1], phi[2], theta_.data() + idx_of(i) / kLanes * kGroup);
}

/// The terms of a force behind its first one.
void KinkMoments::add_powers(std::size_t i, double factor, std::span<const double> force) {
  for (; powers_ < force.size(); ++powers_)  // those before have none of this power
    for (std::size_t k = 0; k < i; ++k) force_[k / kLanes * kForce + powers_ * kLanes + k % kLanes] = 0.0;
  double* own = force_.data() + i / kLanes * kForce + i % kLanes;
  for (std::size_t q = 1; q < powers_; ++q) own[q * kLanes] = q < force.size() ? factor * force[q] : 0.0;
}

KinkMoments::Force KinkMoments::force(int i, double behind) const {
  const double* terms = force_.data() + idx_of(i) / kLanes * kForce + idx_of(i) % kLanes;
  Force f;
  for (std::size_t q = powers_; q-- > 0;) {
    const double term = terms[q * kLanes];
    f.slope = f.slope * behind + static_cast<double>(q + 1) * term;
    f.value = f.value * behind + term;
    f.integral = f.integral * behind + term / static_cast<double>(q + 2);
  }
  f.value *= behind;
  f.integral *= behind * behind;
  return f;
}

void KinkMoments::force_terms(int i, const std::array<double, 3>& behind, std::span<double> terms) const {
  const double* force = force_.data() + idx_of(i) / kLanes * kForce + idx_of(i) % kLanes;
  std::fill(terms.begin(), terms.end(), 0.0);
  for (std::size_t q = powers_; q-- > 0;) {  // Horner's rule on series
    terms[0] += force[q * kLanes];
    for (std::size_t k = terms.size(); k-- > 0;) {
      terms[k] *= behind[0];
      for (std::size_t j = 1; j <= std::min<std::size_t>(k, 2); ++j) terms[k] += behind[j] * terms[k - j];
    }
  }
}

void KinkMoments::add_to(LegendreProjection& projection) {
  if (count_ == 0) return;
  static const NodesAndWeights<kMomentNodes> rule;
  moments_.resize(kProjectionTerms * kLanes);
  for (int first = 0; first < count_; first += kLanes) {
    const auto at = static_cast<std::size_t>(first);
    run_widest<Moments>(static_cast<const double*>(theta_.data() + at / kLanes * kGroup), terms_,
                        first_lanes(count_ - first), static_cast<const double*>(table_.at(kKnot) + at),
                        static_cast<const double*>(force_.data() + at / kLanes * kForce), powers_,
                        static_cast<const double*>(table_.at(kEnd) + at), rule.nodes.data(),
                        rule.weights.data(), table_.at(kPlace) + at, moments_.data());
    const int lanes = std::min(kLanes, count_ - first);
    for (int j = 0; j < kProjectionTerms; ++j)
      for (int l = 0; l < lanes; ++l)
        projection.coefficient(j, row_[static_cast<std::size_t>(first + l)]) +=
            moments_[static_cast<std::size_t>(j * kLanes + l)];
  }
}

template <int kNodes>
void KinkMoments::find_moments(double end, int degree, std::size_t place_terms) {
  static const SweepRule<kNodes> rule;
  for (int first = 0; first < count_; first += kLanes) {
    const auto at = static_cast<std::size_t>(first);
    run_widest<SweepMoments<kNodes>>(static_cast<const double*>(theta_.data() + at / kLanes * kGroup), terms_,
                                     std::min(place_terms, terms_), first_lanes(count_ - first),
                                     static_cast<const double*>(table_.at(kKnot) + at),
                                     static_cast<const double*>(force_.data() + at / kLanes * kForce),
                                     powers_, static_cast<const double*>(table_.at(kEnd) + at), end,
                                     rule.nodes.data(), rule.of_moments.data(), degree,
                                     table_.at(kPlace) + at, whole_lanes(count_), sweep_moments_.data() + at);
  }
}

TaylorSeries::RowMoments KinkMoments::find_moments(double end, int degree, int nodes,
                                                   std::size_t place_terms) {
  const int step = whole_lanes(count_);
  if (const std::size_t size = idx_of(degree + 1) * idx_of(step); sweep_moments_.size() < size)
    sweep_moments_.resize(size);
  nodes == kSweepRules[0]   ? find_moments<kSweepRules[0]>(end, degree, place_terms)
  : nodes == kSweepRules[1] ? find_moments<kSweepRules[1]>(end, degree, place_terms)
                            : find_moments<kSweepRules[2]>(end, degree, place_terms);
  return {.count = count_, .rows = row_.data(), .values = sweep_moments_.data(), .step = step};
}

}  // namespace drev
