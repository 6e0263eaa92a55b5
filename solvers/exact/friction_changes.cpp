// The second part of FrictionSeries: when a contact sticks or slides, along an expanded step.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "solvers/contact/friction_complementarity.hpp"
#include "solvers/contact/roots.hpp"
#include "solvers/exact/friction_series.hpp"
#include "solvers/run/cubic_peak.hpp"

namespace drev {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNothing = 1e-13;  // rounding of a coefficient, relative to the terms that it is summed from
constexpr double kOnBound = 1e-11;  // a torque stands on its bound, relative to what the contact can hold
constexpr double kSameSlope = 1e-9;  // rounding of a derivative, relative to the derivative
constexpr double kSlack = 4.0;       // factor on the difference of two forces that differ by rounding alone
// Rounding of a bound's higher coefficients, relative to the largest terms of lower ones.
constexpr double kLeast = 4e-15;
// Part of the step within which the others outgrow a coefficient that is rounding.
constexpr double kOutgrown = 1e-12;
constexpr int kPlaces = 16;  // parts of a step in which a torque is taken for a cubic

/// int_0^s a(s) b(s) ds.
double integral_of_product(const std::vector<double>& a, const double* b, std::size_t terms_b, double s) {
  double sum = 0.0, s_j = s;
  for (std::size_t j = 0; j < a.size(); ++j, s_j *= s) {
    if (a[j] == 0.0) continue;
    double s_k = s_j;
    for (std::size_t k = 0; k < terms_b; ++k, s_k *= s)
      sum += a[j] * b[k] * s_k / static_cast<double>(j + k + 1);
  }
  return sum;
}

/// The range of a polynomial in [0, end]: of cubics between places, with how far it lies from them.
StepMotion::Range range_along(const std::vector<double>& g, double end) {
  double moves = 0.0, fourth = 0.0, power = end;
  for (std::size_t k = 1; k < g.size(); ++k, power *= end) {
    const double term = std::abs(g[k]) * power;
    moves += term;
    fourth += term * static_cast<double>(k * (k - 1)) * (static_cast<double>(k) - 2.0) *
              (static_cast<double>(k) - 3.0);
  }
  if (g.empty() || moves == 0.0) return g.empty() ? StepMotion::Range{} : StepMotion::Range{g[0], g[0]};
  const double part = end / kPlaces;
  StepMotion::Range range{g[0], g[0], fourth / (384.0 * std::pow(kPlaces, 4))};
  double y = g[0], slope = polynomial_slope(g, 0.0);
  for (int i = 1; i <= kPlaces; ++i) {
    const double y_1 = polynomial_value(g, part * i), slope_1 = polynomial_slope(g, part * i);
    const Interval reach = cubic_reach(y, slope, y_1, slope_1, part);
    range.low = std::min(range.low, reach.low);
    range.high = std::max(range.high, reach.high);
    y = y_1;
    slope = slope_1;
  }
  return range;
}

}  // namespace

void FrictionSeries::note_changes(double t, bool at_start, RunSummary& summary) {
  noted_.resize(contacts_.size(), FrictionState::open);
  for (int i = 0; i < count(); ++i) {
    const FrictionState to = state(i);
    if (to == std::exchange(noted_[idx(i)], to) || at_start || contacts_[idx(i)].rigid) continue;
    ++summary.friction_changes;
    if (summary.friction_events.size() < RunSummary::kMostFrictionEvents)
      summary.friction_events.push_back(
          {t, system_.element_instances()[idx(index(element(i)))].name, to_text(to)});
  }
}

void FrictionSeries::expand(const TaylorSeries& series, const State& from) {
  const auto terms = idx(series.degree());
  const double r = series.step() / h_;
  for (Contact& c : contacts_) {
    c.torque.resize(terms - 1);
    c.slip.resize(terms);
    c.slip_size.resize(terms);
    double power = 1.0;
    for (std::size_t d = 0; d < terms; ++d, power *= r) {
      if (d + 1 < terms) c.torque[d] *= power;
      if (d < c.capacity.size()) c.capacity[d] *= power;
      if (d < 2) c.known[d] *= power;
      double sum = 0.0, size = 0.0;
      for (const Entry& e : c.z) {
        const double part = e.coeff * series.coefficient(static_cast<int>(d) + 1, e.index);
        sum += part;
        size += std::abs(part);
      }
      const double rate = static_cast<double>(d + 1) / series.step();
      c.slip[d] = rate * sum + (d < 2 ? c.known[d] : 0.0);
      c.slip_size[d] = rate * size + (d < 2 ? std::abs(c.known[d]) : 0.0);
      if (c.stuck || c.tied) c.slip[d] = 0.0;
    }
  }
  h_ = series.step();
  largest_.assign(terms - 1, 0.0);
  for (const Contact& c : contacts_)
    for (std::size_t d = 0; d < c.torque.size(); ++d)
      largest_[d] = std::max(largest_[d], std::abs(c.torque[d]));
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    Contact& c = contacts_[i];
    const double per_torque = h_ * w_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i));
    for (std::size_t d = 1; d < terms; ++d)
      c.slip_size[d] = std::max(c.slip_size[d], per_torque / static_cast<double>(d) * largest_[d - 1]);
    c.acceleration_slack = c.speed_rounding;
    if (c.root && from.a.allFinite()) {
      double differs = 0.0;
      for (const Entry& e : c.z)
        differs += e.coeff * (2.0 / (h_ * h_) * series.coefficient(2, e.index) - from.a[e.index]);
      c.acceleration_slack += kSlack * std::abs(differs);
    }
    c.acceleration_slack *= patience_;
    // What the torque was resolved to, from forces that are evaluated, and the series' differ by rounding.
    const double resolved = from.history[system_.frictions()[i].history_begin + FrictionHistory::kTorque];
    c.torque_slack = patience_ * kSlack * std::abs(c.torque[0] - resolved);
  }
  for (std::size_t i = 0; i < contacts_.size(); ++i) find_bounds(i);
}

void FrictionSeries::find_bounds(std::size_t i) {
  Contact& c = contacts_[i];
  c.bounds.clear();
  if (c.open || c.rigid) return;
  if (c.tie >= 0) find_gear_bounds(i);
  if (c.tied || (c.stuck && c.tie >= 0)) return;
  using What = Change::What;
  if (c.stuck) {
    const Limits most = limits(i, false);
    for (const What what : {What::bound_high, What::bound_low}) {
      const double side = what == What::bound_high ? 1.0 : -1.0, limit = side > 0.0 ? most.high : -most.low;
      if (!std::isfinite(limit)) continue;
      std::vector<double> g(std::max(c.capacity.size(), c.torque.size()), 0.0);
      for (std::size_t d = 0; d < c.torque.size(); ++d) g[d] = -side * c.torque[d];
      std::vector<double> size(g.size());
      for (std::size_t d = 0; d < g.size(); ++d) size[d] = std::abs(g[d]);
      for (std::size_t d = 0; d < c.capacity.size(); ++d) {
        g[d] += limit * c.capacity[d];
        size[d] += std::abs(limit * c.capacity[d]);
      }
      const bool on_it = c.root && c.root_bound == static_cast<int>(side);
      const double zero = kOnBound * size[0] + c.torque_rounding + (c.root ? c.torque_slack : 0.0);
      for (std::size_t d = 0; d < std::min(size.size(), largest_.size()); ++d)
        size[d] = std::max(size[d], largest_[d]);
      c.bounds.push_back({what, std::move(g)});
      clean(c.bounds.back(), size, zero, 0.0, on_it, bounded_patience(), zero);
    }
    return;
  }
  std::vector<double> g(c.slip);
  for (double& x : g) x *= c.sign;
  const double zero = kNothing * std::max(c.slip_size[0], speed_scale_);
  c.bounds.push_back({What::slip_ends, g});
  clean(c.bounds.back(), c.slip_size, zero, c.acceleration_slack * h_, c.root);
  const std::vector<double>& speeds = law(i).slip_speeds();
  if (law(i).one_way() || speeds.size() < 2) return;
  const auto add_knot = [&](What what, double speed) {
    std::vector<double> bound(g);
    bound[0] -= speed;
    if (what == What::knot_above)
      for (double& x : bound) x = -x;
    c.bounds.push_back({what, std::move(bound)});
    clean(c.bounds.back(), c.slip_size, kNothing * (c.slip_size[0] + speed), c.acceleration_slack * h_,
          false);
  };
  if (c.segment > 0) add_knot(What::knot_below, speeds[idx(c.segment)]);
  if (idx(c.segment) + 1 < speeds.size()) add_knot(What::knot_above, speeds[idx(c.segment) + 1]);
}

/// Coefficients that are rounding become zero: the first within `zero` (or any where on_it), the second within
/// `first`, and those by which the bound would be crossed by no more than `touch` before the next one turns it back.
/// patience: factor on what is taken for rounding.
void FrictionSeries::clean(Bound& bound, const std::vector<double>& size, double zero, double first,
                           bool on_it, double patience, double touch) {
  std::vector<double>& g = bound.g;
  bound.falls = -1;
  if (!on_it && g[0] > zero) return;
  if (!on_it && g[0] < -zero) {
    bound.falls = 0;
    return;
  }
  g[0] = 0.0;
  double lower = size[0], most = 0.0;  // a coefficient's rounding follows from those before it, too
  for (std::size_t d = 1; d < g.size(); ++d) most = std::max(most, std::abs(g[d]));
  const auto touches = [&](std::size_t d) {
    if (!(g[d] < 0.0 && d + 1 < g.size() && g[d + 1] > 0.0)) return false;
    const double back = -g[d] / g[d + 1];  // s where it is back, if those behind are small until there
    return back * most <= 0.5 * g[d + 1] && -g[d] * std::pow(back, static_cast<double>(d)) <= touch;
  };
  for (std::size_t d = 1; d < g.size(); ++d) {
    lower = std::max(lower, size[d]);
    const double rounding =
        patience * std::max({kNothing * size[d], kLeast * lower, kOutgrown * most}) + (d == 1 ? first : 0.0);
    if (std::abs(g[d]) > rounding && !touches(d)) {
      if (g[d] < 0.0) bound.falls = static_cast<int>(d);
      return;
    }
    g[d] = 0.0;
  }
}

namespace {

/// The polynomial g(from + s).
std::vector<double> moved_to(std::vector<double> g, double from) {
  for (std::size_t i = 0; i + 1 < g.size(); ++i)
    for (std::size_t k = g.size() - 1; k-- > i;) g[k] += from * g[k + 1];
  return g;
}

/// First s at which both are below zero; at 0 one of them holds (falls < 0).
std::optional<double> first_both_below(const std::vector<double>* a, bool a_holds,
                                       const std::vector<double>* b, double end) {
  constexpr int kMostTurns = 100;
  if (!a_holds) std::swap(a, b);
  double from = 0.0;
  for (int turn = 0; turn < kMostTurns; ++turn) {
    const auto s = from == 0.0 ? first_crossing(*a, end) : first_crossing(moved_to(*a, from), end - from);
    if (!s) return std::nullopt;
    from += *s;
    if (polynomial_value(*b, from) <= 0.0) return from;
    std::swap(a, b);
  }
  return from;
}

}  // namespace

std::optional<FrictionSeries::Change> FrictionSeries::change_at_once() const {
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const std::vector<Bound>& bounds = contacts_[i].bounds;
    for (std::size_t k = 0; k < bounds.size(); ++k) {
      int falls = bounds[k].falls;
      if (two_lines(bounds, k)) {
        falls = falls < 0 || bounds[k + 1].falls < 0 ? -1 : std::max(falls, bounds[k + 1].falls);
        ++k;
      }
      if (falls >= 0) return Change{0.0, static_cast<int>(i), bounds[k].what, falls};
    }
  }
  return std::nullopt;
}

std::optional<FrictionSeries::Change> FrictionSeries::first_change(double end) const {
  std::optional<Change> first;
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const std::vector<Bound>& bounds = contacts_[i].bounds;
    for (std::size_t k = 0; k < bounds.size(); ++k) {
      const Bound& b = bounds[k];
      std::optional<double> s;
      if (two_lines(bounds, k))
        s = first_both_below(&b.g, b.falls < 0, &bounds[++k].g, end);
      else
        s = first_crossing(b.g, end);
      if (!s) continue;
      first = Change{*s, static_cast<int>(i), b.what, 0};
      end = *s;
    }
  }
  return first;
}

double FrictionSeries::beyond_end(const Change& change) const {
  const Bound* nearest = nullptr;  // of a gear's two lines, the one that holds longer
  for (const Bound& b : contacts_[idx(change.contact)].bounds)
    if (b.what == change.what && (!nearest || polynomial_value(b.g, 1.0) > polynomial_value(nearest->g, 1.0)))
      nearest = &b;
  return nearest ? -polynomial_value(nearest->g, 1.0) / polynomial_slope(nearest->g, 1.0) : 1.0;
}

bool FrictionSeries::pass(const Change& change, const Assembler& assembler, EvaluatedState& point) {
  using What = Change::What;
  Contact& c = contacts_[idx(change.contact)];
  if (change.what == What::knot_above || change.what == What::knot_below) {
    c.segment += change.what == What::knot_above ? 1 : -1;
    return false;
  }
  const bool bound = change.what != What::slip_ends;
  const int order = bound ? change.order : std::max(0, change.order - 1);
  if (bound && change.s > 0.0) {  // the series behind it tells by its derivatives
    if (change.what == What::drive_turns) {
      c.line_root = true;
      return false;
    }
    c.root = true;
    c.root_bound = change.what == What::bound_high ? 1 : -1;
    return false;
  }
  if (change.s == 0.0) patience_ *= 2.0;
  bool released = false;
  if (change.s == 0.0 && order > 0) {
    std::vector<char> rested(contacts_.size(), 0);
    for (std::size_t i = 0; i < contacts_.size(); ++i) rested[i] = contacts_[i].stuck || contacts_[i].tied;
    pass_derivative(change, order, point);
    Contact* first = nullptr;  // the contact that breaks away first; the others are asked again
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      Contact& other = contacts_[i];
      // From an engagement of zero its torque does not jump.
      const bool jumps = breaks_away(i) && other.capacity[0] > 0.0;
      if (!rested[i] || other.stuck || other.tied || !jumps) continue;
      if (!first || static_cast<int>(i) == change.contact) first = &other;
    }
    released = first != nullptr;
    if (first) first->loose = true;
    if (!released) return false;
  }
  std::vector<char> at_rest(contacts_.size(), 0);
  for (std::size_t i = 0; i < contacts_.size(); ++i)
    at_rest[i] = contacts_[i].stuck || contacts_[i].tied || (contacts_[i].root && !contacts_[i].open);
  if (!released && change.what != What::drive_turns) at_rest[idx(change.contact)] = 1;
  // Where the change was located its own slip is rounding: of others that meet zero with it (a clutch beside a freewheel), too.
  const double located = bound ? 0.0 : kSlack * std::abs(slip_of(c, assembler, point.state.v));
  resolve(assembler, point, at_rest, located);
  return true;
}

void FrictionSeries::pass_derivative(const Change& change, int order, EvaluatedState& point) {
  const auto level = idx(order);
  std::vector<std::size_t> of;
  std::vector<int> sides;  // bits: 1 near the high bound, 2 near the low one
  std::vector<GearLossRow> gears;
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const Contact& c = contacts_[i];
    const bool chosen = static_cast<int>(i) == change.contact;
    int near = 0;
    if (c.open) continue;
    if (c.rigid) {
      // It stays.
    } else if (c.tie >= 0) {
      gears.push_back(gear_derivative(i, change, order));
    } else if (c.tied) {
      // Its other bound is the same as far as the contact holds nothing.
      const Limits most = limits(i, false);
      const auto first = c.capacity.begin(),
                 behind = first + std::min<std::ptrdiff_t>(order, c.capacity.size());
      const bool both =
          most.low == most.high || std::all_of(first, behind, [](double g) { return g == 0.0; });
      near = both ? 3 : c.sign > 0 ? 1 : 2;
    } else if (c.stuck) {
      for (const Bound& b : c.bounds) {
        bool zero = chosen && b.what == change.what;
        if (!zero) zero = std::all_of(b.g.begin(), b.g.begin() + order, [](double x) { return x == 0.0; });
        if (zero) near |= b.what == Change::What::bound_high ? 1 : 2;
      }
    } else {
      const std::vector<double>& g = c.bounds.front().g;  // series of the slip speed
      const bool zero = std::all_of(g.begin(), g.begin() + order + 1, [](double x) { return x == 0.0; });
      if (!chosen && !zero) continue;
      near = c.sign > 0 ? 1 : 2;
    }
    of.push_back(i);
    sides.push_back(near);
  }
  const auto m = static_cast<Eigen::Index>(of.size());
  const std::vector<Eigen::Index> rows(of.begin(), of.end());
  for (GearLossRow& g : gears)  // rows of the system, until here
    for (Eigen::Index* row : {&g.loss, &g.tie})
      *row = std::find(rows.begin(), rows.end(), *row) - rows.begin();
  BoxComplementarity problem{.w = w_(rows, rows),
                             .r = Vector(m),
                             .low = Vector::Constant(m, -kInfinity),
                             .high = Vector::Constant(m, kInfinity),
                             .rounding = Vector(m),
                             .free = std::vector<char>(of.size(), 0)};
  Vector torque(m);
  for (Eigen::Index k = 0; k < m; ++k) {
    const Contact& c = contacts_[of[static_cast<std::size_t>(k)]];
    torque[k] = level < c.torque.size() ? c.torque[level] : 0.0;
    problem.r[k] = static_cast<double>(order + 1) / h_ * c.slip[level + 1];
    const Limits most = limits(of[static_cast<std::size_t>(k)], false);
    const double g = level < c.capacity.size() ? c.capacity[level] : 0.0;
    const int near = sides[static_cast<std::size_t>(k)];
    if (near & 1) problem.high[k] = g == 0.0 ? 0.0 : g * most.high;
    if (near & 2) problem.low[k] = g == 0.0 ? 0.0 : g * most.low;
    problem.free[static_cast<std::size_t>(k)] = near == 0;
  }
  problem.r += problem.w * torque;
  const double largest = torque.lpNorm<Eigen::Infinity>();
  for (Eigen::Index k = 0; k < m; ++k) {
    const bool chosen = static_cast<int>(of[static_cast<std::size_t>(k)]) == change.contact;
    const double own = problem.w.row(k).cwiseAbs().dot(torque.cwiseAbs());
    const double all = problem.w.row(k).lpNorm<1>() * largest;
    problem.rounding[k] = patience_ * kSameSlope * (std::abs(problem.r[k]) + (chosen ? own : all));
  }
  const FrictionSolution found = solve_at(point.state.t, problem, gears, of);
  if (gears_) problem.rounding += patience_ * kSameSlope * (problem.w.cwiseAbs() * found.lambda.cwiseAbs());
  begin_stuck();
  take(of, found, problem, gears);
  factor_stuck();
  for (std::size_t i = 0; i < contacts_.size(); ++i)
    if (!contacts_[i].rigid)
      point.state.history[system_.frictions()[i].history_begin + FrictionHistory::kState] =
          static_cast<int>(state(static_cast<int>(i)));
}

void FrictionSeries::forget_roots() {
  for (Contact& c : contacts_) c.root = c.loose = c.line_root = false;
  resolved_ = false;
  patience_ = 1.0;
}

double FrictionSeries::heat(const Contact& c, double s) const {
  if (c.open || c.stuck || c.tied) return 0.0;
  return h_ * integral_of_product(c.torque, c.slip.data(), c.slip.size(), s);
}

double FrictionSeries::dissipated(double s) const {
  double sum = 0.0;
  for (const Contact& c : contacts_) sum += heat(c, s);
  return sum;
}

double FrictionSeries::input(double s) const {
  double sum = 0.0;
  for (const Contact& c : contacts_)
    if (c.known[0] != 0.0 || c.known[1] != 0.0)
      sum += h_ * integral_of_product(c.torque, c.known.data(), 2, s);
  return sum;
}

void FrictionSeries::write(double s, const Vector& start, Vector& history) const {
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const int begin = system_.frictions()[i].history_begin;
    history[begin + FrictionHistory::kTorque] = polynomial_value(contacts_[i].torque, s);
    history[begin + FrictionHistory::kState] = static_cast<int>(state(static_cast<int>(i)));
    history[begin + FrictionHistory::kHeat] = start[begin + FrictionHistory::kHeat] + heat(contacts_[i], s);
    if (contacts_[i].tie >= 0) note_gear(i, polynomial_value(contacts_[i].slip, s), history);
  }
}

std::optional<StepMotion::Range> FrictionSeries::torque_range(int place, double s) const {
  using History = FrictionHistory;
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const FrictionTerm& term = system_.frictions()[i];
    const int which = place - term.history_begin;
    if (which < 0 || which >= History::size(*term.friction)) continue;
    const std::vector<double>& own = contacts_[i].torque;
    if (which == History::kTorque) return range_along(own, s);
    if (which != History::kTorqueIn && which != History::kTorqueOut) break;
    // Of a gear, as note_gear() has them.
    const auto tie = idx(contacts_[i].tie);
    std::vector<double> sum = contacts_[tie].torque;
    if (which == History::kTorqueOut)
      for (double& g : sum) g *= -system_.frictions()[tie].nodes.back().coeff;
    else
      for (std::size_t k = 0; k < std::min(sum.size(), own.size()); ++k) sum[k] += own[k];
    return range_along(sum, s);
  }
  return std::nullopt;
}

}  // namespace drev
