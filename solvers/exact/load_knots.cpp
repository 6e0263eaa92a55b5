// ExpandedLoads: what they differ behind their knots, and how their slopes change over a step.
#include <algorithm>
#include <cmath>

#include "solvers/exact/expanded_loads.hpp"

namespace drev {

namespace {

// Terms that are left out, relative to the force by which a load differs behind a knot.
constexpr double kOfKnotForce = 1e-17;
constexpr double kJumpsBy = 1e-9;  // a load jumps at a knot, relative to its torque there

using CubicTerms = std::array<double, 4>;
/// The terms about a place further on.
CubicTerms terms_further(CubicTerms c, double by) {
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 3; k-- > i;) c[k] += by * c[k + 1];
  return c;
}

}  // namespace

std::optional<std::span<const double>> ExpandedLoads::behind_knot(const Load& l, const CubicPiece& piece,
                                                                  double about, double knot,
                                                                  const CubicPiece& next, double turn) {
  const CubicTerms before = terms_further(piece.terms, knot - about);
  CubicTerms d;
  for (std::size_t i = 0; i < d.size(); ++i) d[i] = next.terms[i] - before[i];
  const CurveCells::Place at = l.curves->at(knot);
  if (std::abs(d[0]) > kJumpsBy * (std::abs(before[0]) + std::abs(next.terms[0])) ||
      std::abs(at.distance) + turn > l.curves->reach())
    return std::nullopt;
  std::array<double, CurveCells::kTerms> s = at.cell->factor;
  for (std::size_t j = 0; j < s.size(); ++j)
    for (std::size_t k = s.size() - 1; k-- > j;) s[k] += at.distance * s[k + 1];
  difference_.assign(s.size() + 2, 0.0);
  for (std::size_t i = 1; i < d.size(); ++i)
    for (std::size_t j = 0; j < s.size(); ++j) difference_[i + j - 1] += d[i] * s[j];
  double power = turn, sum = 0.0;
  std::size_t terms = 1;
  for (std::size_t q = 0; q < difference_.size(); ++q, power *= turn) {
    const double size = std::abs(difference_[q]) * power;
    sum += size;
    if (size > kOfKnotForce * sum) terms = q + 1;
  }
  return std::span<const double>(difference_).first(terms);
}

ExpandedLoads::SlopeChange ExpandedLoads::slope_change(const TaylorSeries& series) const {
  SlopeChange most;
  for (const Group& group : groups_)
    for (std::size_t lane = 0; lane < idx(group.count); ++lane) {
      const Load& l = loads_[idx(group.load[lane])];
      if (!l.feedback) continue;
      const double reach = group.reach[lane], square = l.speed * l.speed;
      double slope = 0.0, curve = 0.0, power = 1.0;
      for (int j = 1; j <= group.top; ++j, power *= reach) {
        const auto at = idx(j) * kLanes + lane;
        const double g = group.speeds ? std::abs(group.g[at]) : 0.0;
        curve += g * power;
        if (j > 1) slope += j * power * (std::abs(group.p[at]) + g * square);
      }
      const double gain = l.coeff * l.coeff * series.reach(l.row);
      most.by_angle = std::max(most.by_angle, gain * slope);
      most.by_speed = std::max(most.by_speed, gain * 2.0 * std::abs(l.speed) * curve * reach);
    }
  return most;
}

void ExpandedLoads::use_slopes(TaylorSeries& series, double s) {
  for (Group& group : groups_)
    for (std::size_t lane = 0; lane < idx(group.count); ++lane) {
      const Load& l = loads_[idx(group.load[lane])];
      if (!l.feedback) continue;
      const Values x = values(group.x.data(), series.degree(), lane, s);
      const Values p = values(group.p.data(), group.top, lane, x.value);
      const Values g = group.speeds ? values(group.g.data(), group.top, lane, x.value) : Values{};
      const double w = x.slope / h_;
      group.more_slope[lane] = l.coeff * l.coeff * (p.slope + g.slope * w * w - l.slope);
      series.add_row_stiffness(l.row, -group.more_slope[lane]);
      if (!group.speeds || l.row >= system_.size()) continue;
      group.more_by_speed[lane] = l.coeff * l.coeff * (2.0 * g.value * w - l.speed_slope);
      series.add_load_damping(l.row, -group.more_by_speed[lane]);
    }
}

void ExpandedLoads::return_slopes(TaylorSeries& series) {
  for (Group& group : groups_)
    for (std::size_t lane = 0; lane < idx(group.count); ++lane) {
      const Load& l = loads_[idx(group.load[lane])];
      if (!l.feedback) continue;
      series.add_row_stiffness(l.row, group.more_slope[lane]);
      if (group.speeds && l.row < system_.size()) series.take_load_damping();
    }
}

}  // namespace drev
