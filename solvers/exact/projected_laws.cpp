#include "solvers/exact/projected_laws.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/contact/roots.hpp"
#include "solvers/exact/expanded_laws.hpp"
#include "solvers/run/cubic_peak.hpp"

namespace drev {

namespace {
constexpr double kLawRounding = 1e-15;  // of a force, a deflection and its rate, relative to them
constexpr double kRounding = 2e-14;     // rounding of the last coefficients, relative to the largest
// An angle is clear of a knot, relative to the angle and to 1 rad at least.
constexpr double kAngleClear = 2e-15;
}  // namespace

ProjectedLaws::ProjectedLaws(const System& system)
    : system_(system), assembler_(system), forces_(TaylorSeries::stride(system)) {
  for (std::size_t j = 0; j < system.scalars().size(); ++j) {
    const ScalarTerm& term = system.scalars()[j];
    if (!linear_pieces(term).empty() || ExpandedLaws::takes(term)) continue;
    laws_.push_back({.index = static_cast<int>(j), .term = &term});
    if (term.phase_node >= 0) laws_.back().phase_row = system.row_of(term.phase_node);
  }
}

void ProjectedLaws::add_to(TaylorSeries& series, const EvaluatedState& start, double h) {
  t_ = start.state.t;
  h_ = h;
  for (Law& law : laws_) {
    const ScalarTerm& term = *law.term;
    const ScalarResponse& r = start.responses[idx(law.index)];
    law.k = r.dy_dx;
    law.c = r.dy_dx_dot;
    law.y = r.y;
    law.x = value_along(term.z, start.state.z);
    law.x_dot = value_along(term.z, start.state.v);
    law.angle = start.inputs[idx(law.index)].angle;
    law.stored = r.stored_energy;
    series.add_spring(term, law.k);
    series.add_damper(term, law.c);
    double b_1 = 0.0;
    for (const Entry& e : term.z) b_1 += std::abs(e.coeff);
    for (const Entry& row : term.z) {
      series.widen(row.index, law.k * b_1 * row.coeff, law.c * b_1 * row.coeff);
      series.right_side(0)[row.index] -= row.coeff * (law.y - law.k * law.x - law.c * law.x_dot);
    }
  }
}

void ProjectedLaws::expand_scale(int law, const TaylorSeries& series, std::vector<double>& scale) {
  const ScalarTerm& term = system_.scalars()[idx(law)];
  const GaussRule& rule = gauss_rule();
  std::array<double, GaussRule::kNodes> values{};
  for (std::size_t q = 0; q < GaussRule::kNodes; ++q) {
    series.evaluate(rule.s[q], z_, v_);
    assembler_.set_time(t_ + h_ * rule.s[q]);
    values[q] = term.force->pieces_scale(assembler_.input(term, z_, v_).angle);
  }
  const NodePolynomial polynomial = through_nodes(values, kRounding * std::abs(values[0]));
  scale.assign(polynomial.power.begin(), polynomial.power.end());
}

/// A law on the series' path, where z_ and v_ stand.
struct ProjectedLaws::Point {
  ScalarResponse response;
  double x = 0.0, x_dot = 0.0, beyond = 0.0;  // its tangent
};

ProjectedLaws::Point ProjectedLaws::look(const Law& law) {
  Point p{.response = assembler_.respond(*law.term, z_, v_),
          .x = value_along(law.term->z, z_),
          .x_dot = value_along(law.term->z, v_)};
  p.beyond = p.response.y - law.y - law.k * (p.x - law.x) - law.c * (p.x_dot - law.x_dot);
  return p;
}

double ProjectedLaws::project(const TaylorSeries& series, LegendreProjection& projection) {
  if (laws_.empty()) return 0.0;
  const GaussRule& rule = gauss_rule();
  double gain = 0.0;
  forces_.clear();
  for (Law& law : laws_) law.rounding = law.off = 0.0;
  for (std::size_t q = 0; q < GaussRule::kNodes; ++q) {
    series.evaluate(rule.s[q], z_, v_);
    assembler_.set_time(t_ + h_ * rule.s[q]);
    for (Law& law : laws_) {
      const Point p = look(law);
      const ScalarResponse& r = p.response;
      law.at_nodes[q] = p.beyond;
      law.rounding = std::max(law.rounding, kLawRounding * (std::abs(r.y) + std::abs(r.dy_dx * p.x) +
                                                            std::abs(r.dy_dx_dot * p.x_dot)));
      double mobility = 0.0;
      for (const Entry& e : law.term->z) {
        mobility += e.coeff * e.coeff * series.mobility(e.index);
        forces_.at(q, e.index) -= e.coeff * p.beyond;
      }
      gain = std::max(
          gain, mobility * (0.5 * h_ * h_ * std::abs(r.dy_dx - law.k) + h_ * std::abs(r.dy_dx_dot - law.c)));
    }
  }
  projection.add_nodes(forces_);
  return gain;
}

void ProjectedLaws::look_between(const TaylorSeries& series) {
  const GaussRule& rule = gauss_rule();
  std::vector<NodeFit> fits;
  std::vector<Point> last;
  for (Law& law : laws_) {
    law.off = std::abs(fits.emplace_back(law.at_nodes).at(0.0));
    last.push_back({.response = {}, .x = law.x, .x_dot = law.x_dot});
  }
  const auto stand = [&](double s) {
    series.evaluate(s, z_, v_);
    assembler_.set_time(t_ + h_ * s);
  };
  const auto take = [&](std::size_t j, double s) {
    const Point p = look(laws_[j]);
    laws_[j].off = std::max(laws_[j].off, std::abs(p.beyond - fits[j].at(s)));
    return p;
  };
  double s_last = 0.0;
  for (std::size_t i = 0; i <= GaussRule::kNodes; ++i) {
    const double s = i == 0                  ? 0.5 * rule.s[0]
                     : i < GaussRule::kNodes ? 0.5 * (rule.s[i - 1] + rule.s[i])
                                             : GaussRule::kAheadOfEnd;
    stand(s);
    for (std::size_t j = 0; j < laws_.size(); ++j) {
      const Point p = take(j, s);
      const double length = (s - s_last) * h_;
      // A stop may be reached just where the deflection turns.
      if (const auto turn = cubic_peak(last[j].x, last[j].x_dot, p.x, p.x_dot, length)) {
        const double at = s_last + turn->s * (s - s_last);
        stand(at);
        take(j, at);
        stand(s);
      }
      last[j] = p;
    }
    s_last = s;
  }
}

std::optional<double> ProjectedLaws::first_knot(const TaylorSeries& series, double end) {
  std::optional<double> first;
  for (const Law& law : laws_) {
    if (law.term->phase_node < 0) continue;
    const NodeMap& map = system_.node_map(law.term->phase_node);
    assembler_.set_time(t_);
    g_.assign(idx(series.degree() + 1), 0.0);
    const auto add_known = [&](double factor, const MotionPoint& m) {
      g_[1] += factor * m.rate * h_;
      g_[2] += 0.5 * factor * m.acceleration * h_ * h_;
    };
    add_known(system_.ratio(law.term->phase_node), assembler_.nominal());
    if (map.prescribed >= 0) add_known(map.coeff, assembler_.prescribed(map.prescribed));
    for (const Entry& e : law.phase_row)
      for (int k = 1; k <= series.degree(); ++k) g_[idx(k)] += e.coeff * series.coefficient(k, e.index);
    for (const double side : {1.0, -1.0}) {
      const std::optional<double> knot = law.term->force->next_knot(law.angle, side);
      if (!knot) continue;
      g_[0] = side * (*knot - law.angle);
      if (!(g_[0] > 0.0)) continue;
      std::vector<double> g = g_;
      for (std::size_t k = 1; k < g.size(); ++k) g[k] *= -side;
      if (const auto s = first_crossing(g, end)) {
        first = s;
        end = *s;
        knot_clearance_ = kAngleClear * std::max(1.0, std::abs(law.angle)) * h_ / std::abs(g_[1]);
      }
    }
  }
  return first;
}

LawWork ProjectedLaws::work(const TaylorSeries& series, double s, const EvaluatedState& end) {
  LawWork work;
  if (laws_.empty()) return work;
  const GaussRule& rule = gauss_rule();
  for (std::size_t q = 0; q < GaussRule::kNodes; ++q) {
    series.evaluate(s * rule.s[q], z_, v_);
    assembler_.set_time(t_ + s * h_ * rule.s[q]);
    const double dt = s * h_ * rule.weight[q];
    for (const Law& law : laws_) {
      const ScalarInput in = assembler_.input(*law.term, z_, v_);
      const ScalarResponse r = law.term->force->evaluate(in);
      work.add(dt, r.y, in.x_dot, value_along(law.term->z, v_), r.dissipated_power,
               law.term->force->varies());
    }
  }
  // The same energies as the run's own: at a jump of stiffness rounding may put another look on its other side.
  for (const Law& law : laws_)
    if (law.term->force->varies()) work.input += end.responses[idx(law.index)].stored_energy - law.stored;
  return work;
}

}  // namespace drev
