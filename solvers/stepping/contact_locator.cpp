#include "solvers/stepping/contact_locator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solvers/contact/pieces.hpp"
#include "solvers/contact/roots.hpp"

namespace drev {

namespace {

constexpr double kEdgeRounding = 16 * std::numeric_limits<double>::epsilon();
constexpr double kOnKnot =
    1e-11;  // distance from a knot over the angle: above what next_knot() takes for none
using Coefficients = StepPolynomial::Coefficients;

/// Adds the quintic through values and rates (per step) at both ends and in the middle.
void add_known(double y_0, double d_0, double y_1, double d_1, double middle, double d_middle,
               Coefficients& x) {
  const double r = y_1 - y_0 - d_0, q = d_1 - d_0;
  const double m = middle - y_0 - 0.5 * d_0, w = d_middle - d_0;
  const double c_2 = 16 * m + 7 * r - q - 8 * w, c_3 = 16 * w - 20 * r + 3 * q - 2 * c_2;
  const double c_4 = 5 * r - q - 3 * c_2 - 2 * c_3, c_5 = r - c_2 - c_3 - c_4;
  x[0] += y_0, x[1] += d_0, x[2] += c_2, x[3] += c_3, x[4] += c_4, x[5] += c_5;
}

double value(const LawBound& b, double x, double x_dot) { return b.a + b.b_x * x + b.b_v * x_dot; }

}  // namespace

ContactLocator::ContactLocator(const System& system) : system_(system), zero_(Vector::Zero(system.size())) {
  for (std::size_t j = 0; j < system.scalars().size(); ++j) {
    const ScalarTerm& term = system.scalars()[j];
    if (auto pieces = pieces_or_stretches(term); pieces.size() > 1) laws_.push_back({j, std::move(pieces)});
    if (term.phase_node >= 0 && (term.force->next_knot(0.0, 1.0) || term.force->next_knot(0.0, -1.0)))
      phased_.push_back(j);
  }
}

std::vector<Entry> ContactLocator::of_phase(const ScalarTerm& term) const {
  return system_.row_of(term.phase_node);
}

ContactLocator::Value ContactLocator::angle(const ScalarTerm& term, const State& state, double angle) const {
  const NodeMap& map = system_.node_map(term.phase_node);
  double rate = value_along(of_phase(term), state.v);
  if (map.prescribed >= 0)
    if (const auto& known = system_.prescribed()[idx(map.prescribed)].at)
      rate += map.coeff * known(state.t).rate;
  if (const auto& nominal = system_.reference())
    rate += system_.ratio(term.phase_node) * nominal->at(state.t).rate;
  return {angle, rate};
}

double ContactLocator::acceleration(const ScalarTerm& term, const State& state) const {
  double a = value_along(term.z, state.a);
  for (const Entry& e : term.u)
    if (const auto& known = system_.prescribed()[idx(e.index)].at) a += e.coeff * known(state.t).acceleration;
  return a;
}

std::pair<double, double> ContactLocator::distance(const Crossing& c, const EvaluatedState& point) const {
  const ScalarTerm& term = system_.scalars()[c.law];
  const ScalarInput& in = point.inputs[c.law];
  const LawBound& b = c.bound;
  const Value x = c.knot ? angle(term, point.state, in.angle) : Value{in.x, in.x_dot};
  const double bend = b.b_v != 0.0 ? b.b_v * acceleration(term, point.state) : 0.0;
  return {value(b, x.value, x.rate), b.b_x * x.rate + bend};
}

std::optional<ContactLocator::Crossing> ContactLocator::first_of_law(const Law& law, const ScalarInput& from,
                                                                     const Coefficients& x, double h) const {
  std::optional<Crossing> best;
  for (const LawBound& b : law.pieces[idx(piece_at(law.pieces, from.x, from.x_dot))].bounds) {
    Coefficients g;
    for (std::size_t k = 0; k < g.size(); ++k) g[k] = b.b_x * x[k];
    if (b.b_v != 0.0)
      for (std::size_t k = 1; k < g.size(); ++k) g[k - 1] += b.b_v / h * static_cast<double>(k) * x[k];
    const double seen = g[0] = value(b, from.x, from.x_dot);
    const double rounding =
        kEdgeRounding * (std::abs(b.a) + std::abs(b.b_x * from.x) + std::abs(b.b_v * from.x_dot));
    if (seen <= rounding) {  // on the bound, or beyond: which side it leaves to decides
      if (seen >= -rounding) g[0] = 0.0;
      const auto leading = std::find_if(g.begin(), g.end(), [](double c) { return c != 0.0; });
      if (leading == g.end()) continue;
      if (*leading < 0.0) return Crossing{0.0, law.index, b};
      if (!(seen > 0.0)) return Crossing{0.0, law.index, {-b.a, -b.b_x, -b.b_v}};
    }
    if (const auto s = first_crossing(g, best ? best->s : 1.0)) best = {*s, law.index, b};
  }
  return best;
}

std::optional<ContactLocator::Crossing> ContactLocator::first_knot(std::size_t law,
                                                                   const Coefficients& angle) const {
  const ScalarForce& force = *system_.scalars()[law].force;
  const double near = kOnKnot * std::max(1.0, std::abs(angle[0]));
  const double rounding = kEdgeRounding * std::max(kOnKnot, std::abs(angle[0]));
  std::optional<Crossing> best;
  for (const int side : {-1, 1}) {  // it is passed going up from below, or down from above
    // The bound lies beyond the knot by rounding, so that what starts on a knot is led over it.
    LawBound bound{0.0, static_cast<double>(side), 0.0};
    const auto set_from = [&](double start) {
      const auto knot = force.next_knot(start, -side);
      if (knot) bound.a = -side * *knot + rounding;
      return knot.has_value() && value(bound, angle[0], 0.0) > 0.0;
    };
    if (!set_from(angle[0] + side * near) && !set_from(angle[0])) continue;
    Coefficients g = angle;
    if (side < 0)
      for (double& c : g) c = -c;
    g[0] = value(bound, angle[0], 0.0);
    if (const auto s = first_crossing(g, best ? best->s : 1.0)) best = {*s, law, bound, true};
  }
  return best;
}

std::optional<ContactLocator::Crossing> ContactLocator::first(const StepPolynomial& motion,
                                                              const EvaluatedState& from,
                                                              const EvaluatedState& to,
                                                              Assembler& assembler) const {
  std::optional<Crossing> best;
  const auto take = [&](const std::optional<Crossing>& c) {
    if (c && (!best || c->s < best->s)) best = c;
  };
  for (const Law& law : laws_)
    take(first_of_law(law, from.inputs[law.index], deflection(law.index, motion, from, to, assembler),
                      motion.h()));
  for (const std::size_t j : phased_) take(first_knot(j, phase(j, motion, from, to, assembler)));
  return best;
}

std::optional<ContactLocator::Crossing> ContactLocator::predict(const EvaluatedState& point, double h) const {
  std::optional<Crossing> best;
  const auto take = [&](const std::optional<Crossing>& c) {
    if (c && (!best || c->s < best->s)) best = c;
  };
  const auto along = [&](const Value& now, double bend) {
    return Coefficients{now.value, h * now.rate, 0.5 * h * h * bend, 0, 0, 0};
  };
  for (const Law& law : laws_) {
    const ScalarInput& in = point.inputs[law.index];
    const double bend = acceleration(system_.scalars()[law.index], point.state);
    take(first_of_law(law, in, along({in.x, in.x_dot}, bend), h));
  }
  for (const std::size_t j : phased_) {
    const ScalarTerm& term = system_.scalars()[j];
    take(first_knot(j, along(angle(term, point.state, point.inputs[j].angle),
                             value_along(of_phase(term), point.state.a))));
  }
  return best;
}

StepPolynomial::Coefficients ContactLocator::deflection(std::size_t law, const StepPolynomial& motion,
                                                        const EvaluatedState& from, const EvaluatedState& to,
                                                        Assembler& assembler) const {
  const ScalarTerm& term = system_.scalars()[law];
  Coefficients x = motion.of(term.z);
  if (term.u.empty() && term.phase_node < 0) return x;
  const double h = motion.h();
  const auto known = [&](const EvaluatedState& p) {
    const ScalarInput& in = p.inputs[law];
    return Value{in.x - value_along(term.z, p.state.z), h * (in.x_dot - value_along(term.z, p.state.v))};
  };
  assembler.set_time(from.state.t + 0.5 * h);
  const ScalarInput middle = assembler.input(term, zero_, zero_);
  const Value start = known(from), end = known(to);
  add_known(start.value, start.rate, end.value, end.rate, middle.x, h * middle.x_dot, x);
  return x;
}

StepPolynomial::Coefficients ContactLocator::phase(std::size_t law, const StepPolynomial& motion,
                                                   const EvaluatedState& from, const EvaluatedState& to,
                                                   Assembler& assembler) const {
  const ScalarTerm& term = system_.scalars()[law];
  const std::vector<Entry> entries = of_phase(term);
  Coefficients x = motion.of(entries);
  const double h = motion.h();
  const auto known = [&](const EvaluatedState& p) {
    const Value all = angle(term, p.state, p.inputs[law].angle);
    return Value{all.value - value_along(entries, p.state.z),
                 h * (all.rate - value_along(entries, p.state.v))};
  };
  State between;
  between.t = from.state.t + 0.5 * h;
  between.v = zero_;
  assembler.set_time(between.t);
  const Value middle = angle(term, between, assembler.input(term, zero_, zero_).angle);
  const Value start = known(from), end = known(to);
  add_known(start.value, start.rate, end.value, end.rate, middle.value, h * middle.rate, x);
  return x;
}

}  // namespace drev
