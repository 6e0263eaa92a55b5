#include "solvers/exact/expanded_laws.hpp"

#include <drev/core/law/orders.hpp>

#include <algorithm>
#include <cmath>

#include "solvers/contact/roots.hpp"
#include "solvers/exact/law_offsets.hpp"
#include "solvers/exact/law_series.hpp"
#include "solvers/exact/load_series.hpp"
#include "solvers/linear/lane_pair.hpp"
#include "solvers/series/legendre_projection.hpp"
#include "solvers/series/series_kernels.hpp"

namespace drev {

namespace {

// An angle is clear of a knot, relative to the angle and to 1 rad at least.
constexpr double kClearOfKnot = 2e-15;
// Least rate of an angle at a knot, relative to its mean rate up to there.
constexpr double kLeastRate = 1e-6;
// An angle stands on a knot, relative to the angle and to 1 rad at least.
constexpr double kOnLawKnot = 1e-12;

std::size_t capacity() { return static_cast<std::size_t>(TaylorSeries::kMaxDegree) + 1; }

/// Term m of the product of two series, the second one with its first term last.
double product_term(const std::vector<double>& a, const std::vector<double>& backward, int m) {
  return Eigen::Map<const Vector>(a.data(), m + 1)
      .dot(Eigen::Map<const Vector>(backward.data() + (capacity() - idx(m + 1)), m + 1));
}

/// Term m of cos and sin of orders of an angle whose s theta' has terms `turn`; returns what they add to a sum of orders.
struct OrderTerms {
  template <class L>
  [[gnu::always_inline]] static double run(const double* turn, int m, int lanes, const double* orders,
                                           double* cosine, double* sine) {
    L sum{}, x, order;
    for (int first = 0; first < lanes; first += kLanes) {
      L of_c{}, of_s{}, of_c_even{}, of_s_even{};  // two sums each, that do not wait for each other
      const auto add = [&](int j, L& c_sum, L& s_sum) __attribute__((always_inline)) {
        load(cosine + (m - j) * lanes + first, x);
        c_sum += turn[j] * x;
        load(sine + (m - j) * lanes + first, x);
        s_sum += turn[j] * x;
      };
      int j = 1;
      for (; j < m; j += 2) {
        add(j, of_c, of_s);
        add(j + 1, of_c_even, of_s_even);
      }
      if (j == m) add(j, of_c, of_s);
      of_c += of_c_even;
      of_s += of_s_even;
      load(orders + first, order);
      const L c = -kInverse[idx(m)] * (order * of_s), s = kInverse[idx(m)] * (order * of_c);
      store(c, cosine + m * lanes + first);
      store(s, sine + m * lanes + first);
      L by_cosine, by_sine;
      load(orders + lanes + first, by_cosine);
      load(orders + 2 * lanes + first, by_sine);
      sum += by_cosine * c + by_sine * s;
    }
    return sum_of(sum);
  }
};

/// Terms first ... terms - 1 of the slope by the angle of a sum of orders.
struct OrderSlopes {
  template <class L>
  [[gnu::always_inline]] static void run(int first, int terms, int lanes, const double* orders,
                                         const double* cosine, const double* sine, double* out) {
    for (int m = first; m < terms; ++m) {
      L sum{}, order, by_cosine, by_sine, c, s;
      for (int i = 0; i < lanes; i += kLanes) {
        load(orders + i, order);
        load(orders + lanes + i, by_cosine);
        load(orders + 2 * lanes + i, by_sine);
        load(cosine + m * lanes + i, c);
        load(sine + m * lanes + i, s);
        sum += order * (by_sine * c - by_cosine * s);
      }
      out[m] = sum_of(sum);
    }
  }
};

double term_or_zero(const std::vector<double>& series, int m) {
  return idx(m) < series.size() ? series[idx(m)] : 0.0;
}

}  // namespace

bool ExpandedLaws::takes(const ScalarTerm& term) {
  if (term.force->pieces().empty() || !linear_pieces(term).empty()) return false;
  return term.phase_node < 0 || dynamic_cast<const AngleScaledForce*>(term.force) != nullptr;
}

ExpandedLaws::ExpandedLaws(const System& system) : system_(system), assembler_(system) {
  const auto& scalars = system.scalars();
  if (std::none_of(scalars.begin(), scalars.end(), takes)) return;
  TaylorSeries series(system);
  for (std::size_t j = 0; j < scalars.size(); ++j) {
    const ScalarTerm& term = scalars[j];
    if (!takes(term)) continue;
    Law law;
    law.index = static_cast<int>(j);
    law.term = &term;
    if (term.phase_node >= 0) {
      law.scaled = dynamic_cast<const AngleScaledForce*>(term.force);
      law.phase_row = system.row_of(term.phase_node);
      law.stretch.low = std::numeric_limits<double>::infinity();  // none is known yet
    }
    Vector row = Vector::Zero(system.size()), gain;
    for (const Entry& e : term.z) row[e.index] += e.coeff;
    series.solve_mass(row, gain);
    for (int i = 0; i < system.size(); ++i)
      if (gain[i] != 0.0) law.gain.push_back({i, gain[i]});
    for (auto* s : {&law.x, &law.x_backward, &law.theta, &law.r, &law.turn, &law.by_phase_terms})
      s->assign(capacity(), 0.0);
    laws_.push_back(std::move(law));
  }
}

void ExpandedLaws::locate_as(const ExpandedLaws& other) {
  for (std::size_t i = 0; i < laws_.size(); ++i) {
    laws_[i].direction = other.laws_[i].direction;
    laws_[i].turned_at = other.laws_[i].turned_at;
  }
}

void ExpandedLaws::add_to(TaylorSeries& series, const LawSeries& pieces, const LoadSeries& known,
                          const LawOffsets& offsets, const EvaluatedState& start, double h) {
  active_ = false;
  sweeps_ = true;
  known_degree_ = 0;
  h_ = h;
  t_ = start.state.t;
  assembler_.set_time(t_);
  for (Law& law : laws_) {
    const ScalarTerm& term = *law.term;
    const ScalarInput& in = start.inputs[idx(law.index)];
    const LawPiece& p = term.force->pieces()[idx(pieces.piece(law.index))];
    const bool linear = is_linear(term, p);
    law.terms_to = law.scale_to = -1;
    law.active = !linear && (p.y_0 != 0.0 || p.k != 0.0 || p.c != 0.0 || p.product != 0.0);
    law.works = !linear && (law.active || p.elastic_0 != 0.0 || p.elastic_k != 0.0);
    law.turns = law.works && law.scaled != nullptr;
    sweeps_ = sweeps_ && (linear || term.u.empty() || !system_.any_prescribed_moves());
    law.origin = p.elastic_k != 0.0 ? -p.elastic_0 / p.elastic_k : 0.0;
    law.k = p.k;
    law.g = p.product;
    law.y_0 = p.y_0 + p.k * law.origin;
    law.c = p.c + p.product * law.origin;
    law.elastic_0 = p.elastic_0 + p.elastic_k * law.origin;
    law.elastic_k = p.elastic_k;
    law.stored = start.responses[idx(law.index)].stored_energy;
    law.known = offsets.offset(law.index);
    if (law.known.size() < 3) law.known.resize(3, 0.0);
    for (const Entry& e : term.u)
      for (std::size_t i = 0; i < 3; ++i) law.known[i] += e.coeff * known.prescribed(e.index)[i];
    law.known[0] -= law.origin;
    law.angle = in.angle;
    law.deflection = in.x - law.origin;
    if (law.scaled != nullptr) {
      law.known_angle.assign(3, 0.0);
      const auto add_known = [&](double factor, const MotionPoint& m) {
        law.known_angle[1] += factor * m.rate * h;
        law.known_angle[2] += 0.5 * factor * m.acceleration * h * h;
      };
      const NodeMap& map = system_.node_map(term.phase_node);
      add_known(system_.ratio(term.phase_node), assembler_.nominal());
      if (map.prescribed >= 0) add_known(map.coeff, assembler_.prescribed(map.prescribed));
      double rate = law.known_angle[1] / h;
      for (const Entry& e : law.phase_row) rate += e.coeff * start.state.v[e.index];
      if (rate != 0.0 && law.turned_at != t_) law.direction = rate > 0.0 ? 1.0 : -1.0;
      const double near = kOnLawKnot * std::max(1.0, std::abs(law.angle));
      if (!(law.angle > law.stretch.low + near && law.angle < law.stretch.high - near)) {
        law.stretch = law.scaled->scale_stretch(law.angle, law.direction);
        law.stretch_angle = law.angle;
      }
    }
    law.varies = law.stretch.slope != 0.0 || !law.stretch.orders.empty();
    if (law.works) start_scale(law);
    law.is_spring = law.active && !law.varies && p.c == 0.0 && p.product == 0.0 && p.k == p.elastic_k &&
                    p.y_0 == p.elastic_0 &&
                    std::all_of(law.known.begin() + 1, law.known.end(), [](double e) { return e == 0.0; });
    if (law.is_spring) add_spring(series, law);
    if (!law.active) continue;
    active_ = true;
    known_degree_ = std::max(known_degree_, static_cast<int>(law.known.size()) - 1);
    double b_1 = 0.0;
    for (const Entry& e : term.z) b_1 += std::abs(e.coeff);
    const double k = law.r[0] * law.k + law.g * in.x_dot, c = law.c + law.g * (in.x - law.origin);
    for (const Entry& e : term.z) series.widen(e.index, k * b_1 * e.coeff, c * b_1 * e.coeff);
  }
}

/// A law that is the same spring all along the step acts through the matrices, and works as they do: it loses nothing.
void ExpandedLaws::add_spring(TaylorSeries& series, Law& law) {
  const std::vector<Entry>& z = law.term->z;
  const double k = law.r[0] * law.k, y = law.r[0] * law.y_0 + k * law.known[0];
  series.add_spring(*law.term, k);
  double b_1 = 0.0;
  for (const Entry& row : z) {
    b_1 += std::abs(row.coeff);
    series.right_side(0)[row.index] -= row.coeff * y;
  }
  // The largest step was found with closed_stiffness().
  const double stiffer = k - std::abs(law.term->force->closed_stiffness());
  if (stiffer > 0.0)
    for (const Entry& e : z) series.widen(e.index, stiffer * b_1 * e.coeff, 0.0);
  law.active = law.works = false;
}

void ExpandedLaws::start_scale(Law& law) {
  const std::span<const ScaleOrder> orders = law.stretch.orders;
  law.scale_to = 0;
  law.slopes_to = -1;
  law.r[0] = law.stretch.value + law.stretch.slope * (law.angle - law.stretch_angle);
  const auto lanes = idx(whole_lanes(static_cast<int>(orders.size())));
  law.orders.assign(3 * lanes, 0.0);
  for (auto* terms : {&law.cosine, &law.sine}) {
    terms->resize(lanes * capacity());
    std::fill_n(terms->begin(), lanes, 0.0);  // those of higher degree are written before they are read
  }
  std::size_t i = 0;
  for_each_order(orders, law.angle, [&](const ScaleOrder& o, double c, double s) {
    law.orders[i] = o.order;
    law.orders[lanes + i] = o.cosine;
    law.orders[2 * lanes + i] = o.sine;
    law.cosine[i] = c;
    law.sine[i++] = s;
    law.r[0] += o.cosine * c + o.sine * s;
  });
}

/// r_m, m >= 1, from theta_1 ... theta_m.
void ExpandedLaws::add_scale(Law& law, int m) {
  law.r[idx(m)] = law.stretch.slope * law.theta[idx(m)];
  if (law.orders.empty()) return;
  law.turn[idx(m)] = m * law.theta[idx(m)];
  law.r[idx(m)] += run_widest<OrderTerms>(static_cast<const double*>(law.turn.data()), m, lanes_of(law),
                                          static_cast<const double*>(law.orders.data()), law.cosine.data(),
                                          law.sine.data());
}

/// dr/dtheta, up to the term of r that is known.
void ExpandedLaws::add_scale_slopes(Law& law) {
  const int from = law.slopes_to + 1;
  std::fill_n(law.by_phase_terms.begin() + from, law.scale_to - law.slopes_to, 0.0);
  law.slopes_to = law.scale_to;
  if (!law.orders.empty())
    run_widest<OrderSlopes>(from, law.scale_to + 1, lanes_of(law),
                            static_cast<const double*>(law.orders.data()),
                            static_cast<const double*>(law.cosine.data()),
                            static_cast<const double*>(law.sine.data()), law.by_phase_terms.data());
  if (from == 0) law.by_phase_terms[0] += law.stretch.slope;
}

/// x_m and theta_m; z: term m of the motion.
void ExpandedLaws::add_term(Law& law, const double* z, int m) {
  if (law.works) {
    const double x = term_or_zero(law.known, m) + value_along(law.term->z, z);
    law.x[idx(m)] = x;
    law.x_backward[capacity() - idx(m + 1)] = x;
  }
  if (law.scaled == nullptr) return;
  law.theta[idx(m)] = m == 0 ? law.angle : term_or_zero(law.known_angle, m) + value_along(law.phase_row, z);
}

double ExpandedLaws::add(const TaylorSeries& series, int k, double factor, double* term) {
  const int m = k - 2;
  const double* z = series.coefficients(m + 1);
  for (Law& law : laws_) {
    if (!law.active) continue;
    if (m == 0) add_term(law, series.coefficients(0), 0);
    add_term(law, z, m + 1);
    law.terms_to = m + 1;
    double y = law.k * (law.varies ? product_term(law.r, law.x_backward, m) : law.r[0] * law.x[idx(m)]);
    y += law.y_0 * (m == 0 || law.varies ? law.r[idx(m)] : 0.0);
    double rate = law.c * (m + 1) * law.x[idx(m + 1)];
    // x x' is half the rate of x^2.
    if (law.g != 0.0) rate += 0.5 * law.g * (m + 1) * product_term(law.x, law.x_backward, m + 1);
    y += rate / h_;
    for (const Entry& e : law.gain) term[e.index] -= e.coeff * y * factor;
    // Ahead of the next term, while the processor waits for this one.
    if (law.varies) add_scale(law, law.scale_to = m + 1);
  }
  return std::numeric_limits<double>::infinity();
}

/// x and theta up to the series' degree, behind what add() has found; and r.
void ExpandedLaws::complete_terms(Law& law, const TaylorSeries& series) {
  for (; law.terms_to < series.degree(); ++law.terms_to)
    add_term(law, series.coefficients(law.terms_to + 1), law.terms_to + 1);
}

void ExpandedLaws::complete(Law& law, const TaylorSeries& series) {
  complete_terms(law, series);
  if (law.scale_to < 0) start_scale(law);
  if (!law.varies) return;
  for (; law.scale_to < series.degree(); ++law.scale_to) add_scale(law, law.scale_to + 1);
  add_scale_slopes(law);
}

void ExpandedLaws::expand(const TaylorSeries& series) {
  for (Law& law : laws_) {
    if (law.works)
      complete(law, series);
    else if (law.turns)
      complete_terms(law, series);
  }
}

bool ExpandedLaws::turns_back(const TaylorSeries& series) {
  bool any = false;
  for (Law& law : laws_) {
    if (!law.turns || law.turned_at == t_) continue;
    const double near = kOnLawKnot * std::max(1.0, std::abs(law.angle));
    const double to_knot = law.direction > 0.0 ? law.angle - law.stretch.low : law.stretch.high - law.angle;
    if (!(to_knot < near)) continue;
    double largest = 0.0, lead = 0.0;
    if (!law.active) law.terms_to = -1;  // add() has not found those of this pass
    complete_terms(law, series);
    for (int m = 1; m <= series.degree(); ++m) largest = std::max(largest, std::abs(law.theta[idx(m)]));
    for (int m = 1; m <= series.degree() && lead == 0.0; ++m)
      if (std::abs(law.theta[idx(m)]) > kOnLawKnot * largest) lead = law.theta[idx(m)];
    if (!(lead * law.direction < 0.0)) continue;
    law.direction = -law.direction;
    law.turned_at = t_;
    any = true;
  }
  return any;
}

ExpandedLaws::Law* ExpandedLaws::find(int index) {
  const auto law =
      std::find_if(laws_.begin(), laws_.end(), [index](const Law& l) { return l.index == index; });
  return law == laws_.end() ? nullptr : &*law;
}

bool ExpandedLaws::scale_of(int index, const TaylorSeries& series, std::vector<double>& scale) {
  Law* law = find(index);
  if (law == nullptr) return false;
  complete(*law, series);
  scale.assign(law->r.begin(), law->r.begin() + (law->varies ? series.degree() : 0) + 1);
  return true;
}

ExpandedLaws::Turning ExpandedLaws::turning(int index) {
  const Law* law = find(index);
  if (law == nullptr || law->scaled == nullptr) return {};
  Turning turning{std::abs(law->stretch.slope), law->stretch.orders.empty(), law->phase_row};
  for (const ScaleOrder& o : law->stretch.orders)
    turning.steepest += o.order * (std::abs(o.cosine) + std::abs(o.sine));
  return turning;
}

std::optional<double> ExpandedLaws::first_knot(const TaylorSeries& series, double end) {
  std::optional<double> first;
  for (Law& law : laws_) {
    if (!law.turns) continue;
    if (!std::isfinite(law.stretch.low) && !std::isfinite(law.stretch.high)) continue;
    const double near = kOnLawKnot * std::max(1.0, std::abs(law.angle));
    const auto terms = idx(series.degree() + 1);
    double reach = near, others = 0.0;  // how far the angle comes at most, on either side; what bends its way
    for (std::size_t m = 1; m < terms; ++m) {
      reach += std::abs(law.theta[m]);
      others += static_cast<double>(m) * std::abs(law.theta[m]);
    }
    const double first_rate = std::abs(law.theta[1]);
    for (const double side : {1.0, -1.0}) {
      const double bound = side > 0.0 ? law.stretch.high : law.stretch.low;
      if (side * (bound - law.angle) > reach) continue;
      // It moves away from this bound all along the step.
      if (side * law.theta[1] < 0.0 && 2.0 * first_rate > others) continue;
      std::vector<double>& g = to_knot_;
      g.resize(terms);
      for (std::size_t m = 1; m < terms; ++m) g[m] = -side * law.theta[m];
      g[0] = std::max(0.0, side * (bound - law.angle));
      if (g[0] == 0.0 && law.direction * side > 0.0)
        continue;  // no stretch is that short: on the knot, past it
      if (g[0] < near && law.direction * side < 0.0) {
        // On the knot behind: the first term that is not rounding leads away from it (turns_back()).
        double largest = 0.0;
        for (std::size_t k = 1; k < g.size(); ++k) largest = std::max(largest, std::abs(g[k]));
        std::size_t lead = 0;
        g[0] = 0.0;
        while (lead < g.size() && std::abs(g[lead]) <= kOnLawKnot * largest) g[lead++] = 0.0;
        if (lead == g.size() || g[lead] < 0.0) continue;
      }
      if (const auto s = first_crossing(g, end)) {
        first = s;
        end = *s;
        knot_law_ = &law;
        knot_ = bound;
        const double rate = std::max(std::abs(polynomial_slope(g, end)), kLeastRate * std::abs(g[0]));
        knot_clearance_ = kClearOfKnot * std::max(1.0, std::abs(law.angle)) * h_ / rate;
      }
    }
  }
  return first;
}

LawWork ExpandedLaws::work(const TaylorSeries& series, double s, const EvaluatedState& end,
                           bool swept) const {
  LawWork work;
  const GaussRule& rule = gauss_rule();
  const auto terms = idx(series.degree() + 1);
  NodeValues x, r, p, known, y, turn;
  for (const Law& law : laws_) {
    const bool varies = law.term->force->varies();
    if (varies) work.input += end.responses[idx(law.index)].stored_energy - law.stored;
    // What such a spring stored beyond the work on it comes from a jump of its stiffness at the step's end.
    if (varies && law.is_spring) {
      const double from = law.deflection, to = end.inputs[idx(law.index)].x - law.origin;
      work.input -= law.r[0] * (to - from) * (law.y_0 + 0.5 * law.k * (from + to));
    }
    if (!law.works) continue;
    find_at_nodes(std::span(law.x).first(terms), s, x);
    find_at_nodes(std::span(law.r).first(law.varies ? terms : 1), s, r);
    find_at_nodes(law.known, s, known);
    if (swept) {
      series.swept_at_nodes(law.term->z, s, y);
      for (std::size_t q = 0; q < GaussRule::kNodes; ++q) {
        x.value[q] += y.value[q];
        x.slope[q] += y.slope[q];
      }
    }
    if (swept && law.varies) {
      series.swept_at_nodes(law.phase_row, s, turn);
      find_at_nodes(std::span(law.by_phase_terms).first(slope_terms(law, terms)), s, p);
      for (std::size_t q = 0; q < GaussRule::kNodes; ++q) r.value[q] += p.value[q] * turn.value[q];
    }
    for (std::size_t q = 0; q < GaussRule::kNodes; ++q) {
      const double deflection = x.value[q], rate = x.slope[q] / h_, scale = r.value[q];
      const double force = scale * (law.y_0 + law.k * deflection) + (law.c + law.g * deflection) * rate;
      const double elastic = scale * (law.elastic_0 + law.elastic_k * deflection);
      work.add(s * h_ * rule.weight[q], force, rate, rate - known.slope[q] / h_, (force - elastic) * rate,
               varies);
    }
  }
  return work;
}

}  // namespace drev
