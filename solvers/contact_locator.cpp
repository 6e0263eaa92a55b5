#include "solvers/contact_locator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solvers/polynomial.hpp"

namespace drev {

namespace {
constexpr double kRounding = 16 * std::numeric_limits<double>::epsilon();
}

ContactLocator::ContactLocator(const System& system)
    : system_(system), zero_(Vector::Zero(system.size())) {
  for (std::size_t j = 0; j < system.scalars().size(); ++j)
    if (!system.scalars()[j].force->kinks().empty()) laws_.push_back(j);
}

std::pair<double, double> ContactLocator::distance(const Crossing& c, const StepPoint& point) const {
  const ScalarInput& in = point.inputs[c.law];
  const double side = c.side;
  return {side * (in.x - system_.scalars()[c.law].force->kinks()[c.kink]), side * in.x_dot};
}

std::optional<ContactLocator::Crossing> ContactLocator::first_of_law(
    std::size_t law, const StepPolynomial::Coefficients& x) const {
  const auto kinks = system_.scalars()[law].force->kinks();
  std::optional<Crossing> best;
  for (std::size_t k = 0; k < kinks.size(); ++k) {
    StepPolynomial::Coefficients g = x;
    const double rounding = kRounding * (std::abs(x[0]) + std::abs(kinks[k]));
    g[0] -= kinks[k];
    // On the kink but for rounding: which side it leaves to, and whether it was evaluated on that side.
    const bool on_kink = std::abs(g[0]) <= rounding;
    const int seen = g[0] > 0.0 ? 1 : g[0] < 0.0 ? -1 : 0;
    if (on_kink) g[0] = 0.0;
    const auto leading = std::find_if(g.begin(), g.end(), [](double c) { return c != 0.0; });
    if (leading == g.end()) continue;
    const int side = *leading > 0.0 ? 1 : -1;
    if (side != seen) return Crossing{0.0, law, k, -side};
    if (side < 0)
      for (double& c : g) c = -c;
    if (const auto s = first_crossing(g, best ? best->s : 1.0)) best = {*s, law, k, side};
  }
  return best;
}

std::optional<ContactLocator::Crossing> ContactLocator::first(const StepPolynomial& motion,
                                                              const StepPoint& from,
                                                              const StepPoint& to,
                                                              Assembler& assembler) const {
  std::optional<Crossing> best;
  for (const std::size_t j : laws_) {
    const auto c = first_of_law(j, deflection(j, motion, from, to, assembler));
    if (c && (!best || c->s < best->s)) best = c;
  }
  return best;
}

std::optional<ContactLocator::Crossing> ContactLocator::predict(const StepPoint& point,
                                                                double h) const {
  std::optional<Crossing> best;
  for (const std::size_t j : laws_) {
    double x_ddot = 0.0;
    for (const Entry& e : system_.scalars()[j].z) x_ddot += e.coeff * point.state.a[e.index];
    const ScalarInput& in = point.inputs[j];
    const auto c = first_of_law(j, {in.x, h * in.x_dot, 0.5 * h * h * x_ddot, 0.0, 0.0, 0.0});
    if (c && (!best || c->s < best->s)) best = c;
  }
  return best;
}

StepPolynomial::Coefficients ContactLocator::deflection(std::size_t law,
                                                        const StepPolynomial& motion,
                                                        const StepPoint& from, const StepPoint& to,
                                                        Assembler& assembler) const {
  const ScalarTerm& term = system_.scalars()[law];
  StepPolynomial::Coefficients x = motion.of(term.z);
  if (term.u.empty() && term.phase_node < 0) return x;
  // Known part at both ends and in the middle.
  const auto known = [&](const StepPoint& point) {
    double value = point.inputs[law].x, rate = point.inputs[law].x_dot;
    for (const Entry& e : term.z)
      value -= e.coeff * point.state.z[e.index], rate -= e.coeff * point.state.v[e.index];
    return std::pair(value, motion.h() * rate);
  };
  assembler.set_time(from.state.t + 0.5 * motion.h());
  const ScalarInput middle = assembler.input(term, zero_, zero_);
  const auto [y_0, d_0] = known(from);
  const auto [y_1, d_1] = known(to);
  const double r = y_1 - y_0 - d_0, q = d_1 - d_0;
  const double m = middle.x - y_0 - 0.5 * d_0, w = motion.h() * middle.x_dot - d_0;
  const double c_2 = 16 * m + 7 * r - q - 8 * w, c_3 = 16 * w - 20 * r + 3 * q - 2 * c_2;
  const double c_4 = 5 * r - q - 3 * c_2 - 2 * c_3, c_5 = r - c_2 - c_3 - c_4;
  x[0] += y_0, x[1] += d_0, x[2] += c_2, x[3] += c_3, x[4] += c_4, x[5] += c_5;
  return x;
}

}  // namespace drev
