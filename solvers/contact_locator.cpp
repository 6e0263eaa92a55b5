#include "solvers/contact_locator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solvers/polynomial.hpp"

namespace drev {

namespace {

constexpr double kRounding = 16 * std::numeric_limits<double>::epsilon();
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

double sum(const std::vector<Entry>& entries, const Vector& q) {
  double s = 0.0;
  for (const Entry& e : entries) s += e.coeff * q[e.index];
  return s;
}

}  // namespace

ContactLocator::ContactLocator(const System& system)
    : system_(system), zero_(Vector::Zero(system.size())) {
  for (std::size_t j = 0; j < system.scalars().size(); ++j) {
    const ScalarTerm& term = system.scalars()[j];
    if (!term.force->kinks().empty()) laws_.push_back(j);
    if (term.phase_node >= 0 && (term.force->next_knot(0.0, 1.0) || term.force->next_knot(0.0, -1.0)))
      phased_.push_back(j);
  }
}

std::vector<Entry> ContactLocator::of_phase(const ScalarTerm& term) const {
  const NodeMap& map = system_.node_map(term.phase_node);
  if (map.unknown < 0) return {};
  return {{map.unknown, map.coeff}};
}

ContactLocator::Value ContactLocator::angle(const ScalarTerm& term, const State& state,
                                            double angle) const {
  const NodeMap& map = system_.node_map(term.phase_node);
  double rate = map.unknown >= 0 ? map.coeff * state.v[map.unknown] : 0.0;
  if (map.unknown < 0 && map.prescribed >= 0)
    if (const auto& known = system_.prescribed()[at(map.prescribed)].at)
      rate += map.coeff * known(state.t).rate;
  if (const auto& nominal = system_.reference())
    rate += system_.ratio(term.phase_node) * nominal->at(state.t).rate;
  return {angle, rate};
}

std::pair<double, double> ContactLocator::distance(const Crossing& c, const StepPoint& point) const {
  const ScalarInput& in = point.inputs[c.law];
  const double side = c.side;
  const Value value = c.knot ? angle(system_.scalars()[c.law], point.state, in.angle)
                             : Value{in.x, in.x_dot};
  return {side * (value.value - c.at), side * value.rate};
}

std::optional<ContactLocator::Crossing> ContactLocator::first_of_law(
    std::size_t law, const Coefficients& x) const {
  const auto kinks = system_.scalars()[law].force->kinks();
  std::optional<Crossing> best;
  for (std::size_t k = 0; k < kinks.size(); ++k) {
    Coefficients g = x;
    const double rounding = kRounding * (std::abs(x[0]) + std::abs(kinks[k]));
    g[0] -= kinks[k];
    // On the kink but for rounding: which side it leaves to, and whether it was evaluated on that side.
    const bool on_kink = std::abs(g[0]) <= rounding;
    const int seen = g[0] > 0.0 ? 1 : g[0] < 0.0 ? -1 : 0;
    if (on_kink) g[0] = 0.0;
    const auto leading = std::find_if(g.begin(), g.end(), [](double c) { return c != 0.0; });
    if (leading == g.end()) continue;
    const int side = *leading > 0.0 ? 1 : -1;
    if (side != seen) return Crossing{0.0, law, kinks[k], -side};
    if (side < 0)
      for (double& c : g) c = -c;
    if (const auto s = first_crossing(g, best ? best->s : 1.0)) best = {*s, law, kinks[k], side};
  }
  return best;
}

std::optional<ContactLocator::Crossing> ContactLocator::first_knot(std::size_t law,
                                                                   const Coefficients& angle) const {
  std::optional<Crossing> best;
  for (const int side : {-1, 1}) {  // it is passed going up from below, or down from above
    const auto knot = system_.scalars()[law].force->next_knot(angle[0], -side);
    if (!knot) continue;
    Coefficients g = angle;
    g[0] -= *knot;
    if (side < 0)
      for (double& c : g) c = -c;
    if (!(g[0] > 0.0)) continue;
    if (const auto s = first_crossing(g, best ? best->s : 1.0)) best = {*s, law, *knot, side, true};
  }
  return best;
}

std::optional<ContactLocator::Crossing> ContactLocator::first(const StepPolynomial& motion,
                                                              const StepPoint& from,
                                                              const StepPoint& to,
                                                              Assembler& assembler) const {
  std::optional<Crossing> best;
  const auto take = [&](const std::optional<Crossing>& c) {
    if (c && (!best || c->s < best->s)) best = c;
  };
  for (const std::size_t j : laws_) take(first_of_law(j, deflection(j, motion, from, to, assembler)));
  for (const std::size_t j : phased_) take(first_knot(j, phase(j, motion, from, to, assembler)));
  return best;
}

std::optional<ContactLocator::Crossing> ContactLocator::predict(const StepPoint& point,
                                                                double h) const {
  std::optional<Crossing> best;
  const auto take = [&](const std::optional<Crossing>& c) {
    if (c && (!best || c->s < best->s)) best = c;
  };
  const auto along = [&](const std::vector<Entry>& entries, const Value& now) {
    return Coefficients{now.value, h * now.rate, 0.5 * h * h * sum(entries, point.state.a), 0, 0, 0};
  };
  for (const std::size_t j : laws_) {
    const ScalarInput& in = point.inputs[j];
    take(first_of_law(j, along(system_.scalars()[j].z, {in.x, in.x_dot})));
  }
  for (const std::size_t j : phased_) {
    const ScalarTerm& term = system_.scalars()[j];
    take(first_knot(j, along(of_phase(term), angle(term, point.state, point.inputs[j].angle))));
  }
  return best;
}

StepPolynomial::Coefficients ContactLocator::deflection(std::size_t law,
                                                        const StepPolynomial& motion,
                                                        const StepPoint& from, const StepPoint& to,
                                                        Assembler& assembler) const {
  const ScalarTerm& term = system_.scalars()[law];
  Coefficients x = motion.of(term.z);
  if (term.u.empty() && term.phase_node < 0) return x;
  const double h = motion.h();
  const auto known = [&](const StepPoint& p) {
    const ScalarInput& in = p.inputs[law];
    return Value{in.x - sum(term.z, p.state.z), h * (in.x_dot - sum(term.z, p.state.v))};
  };
  assembler.set_time(from.state.t + 0.5 * h);
  const ScalarInput middle = assembler.input(term, zero_, zero_);
  const Value start = known(from), end = known(to);
  add_known(start.value, start.rate, end.value, end.rate, middle.x, h * middle.x_dot, x);
  return x;
}

StepPolynomial::Coefficients ContactLocator::phase(std::size_t law, const StepPolynomial& motion,
                                                   const StepPoint& from, const StepPoint& to,
                                                   Assembler& assembler) const {
  const ScalarTerm& term = system_.scalars()[law];
  const std::vector<Entry> entries = of_phase(term);
  Coefficients x = motion.of(entries);
  const double h = motion.h();
  const auto known = [&](const StepPoint& p) {
    const Value all = angle(term, p.state, p.inputs[law].angle);
    return Value{all.value - sum(entries, p.state.z), h * (all.rate - sum(entries, p.state.v))};
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
