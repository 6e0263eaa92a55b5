#include "solvers/exact/law_offsets.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/contact/roots.hpp"
#include "solvers/series/legendre_projection.hpp"
#include "solvers/series/taylor_series.hpp"

namespace drev {

namespace {
// What is left of rounding in the last coefficients: of an offset, and of the angle that it is looked up at.
constexpr double kOffsetRounding = 2e-14, kAngleRounding = 1e-15;
}  // namespace

LawOffsets::LawOffsets(const System& system) : system_(system), offsets_(system.scalars().size()) {
  for (std::size_t j = 0; j < offsets_.size(); ++j)
    if (system.scalars()[j].phase_node >= 0 && system.scalars()[j].force->has_offset()) phased_.push_back(j);
}

double LawOffsets::expand(const TaylorSeries& series, double t, double h) {
  double rest = 0.0;
  const GaussRule& rule = gauss_rule();
  for (const std::size_t j : phased_) {
    const ScalarTerm& term = system_.scalars()[j];
    offsets_[j].clear();
    const double ratio = system_.ratio(term.phase_node);
    std::array<double, GaussRule::kNodes> values{};
    double largest = 0.0, rounding = 0.0;
    for (std::size_t q = 0; q < GaussRule::kNodes; ++q) {
      const double angle =
          system_.reference() ? ratio * system_.reference()->at(t + h * rule.s[q]).value : 0.0;
      const Offset at_node = term.force->offset(angle);
      values[q] = -at_node.e;
      largest = std::max(largest, std::abs(at_node.e));
      rounding = std::max(rounding, std::abs(at_node.de_dangle * angle));
    }
    if (largest == 0.0) continue;
    const double known_to = kOffsetRounding * largest + kAngleRounding * rounding;
    const NodePolynomial polynomial = through_nodes(values, known_to);
    offsets_[j].assign(polynomial.power.begin(), polynomial.power.end());
    double scale = largest;
    for (const Entry& e : term.z)
      scale = std::max(scale, std::abs(e.coeff) * series.z_scale()[idx(series.kind(e.index))]);
    rest = std::max(rest, (polynomial.tail - known_to) / scale);
  }
  return rest;
}

std::optional<double> LawOffsets::next_break(double t, double end) const {
  std::optional<double> first;
  if (phased_.empty() || !system_.reference()) return first;
  const MotionPoint phi = system_.reference()->at(t);
  for (const std::size_t j : phased_) {
    const ScalarTerm& term = system_.scalars()[j];
    const double ratio = system_.ratio(term.phase_node);
    for (const double side : {1.0, -1.0}) {
      const auto knot = term.force->next_offset_knot(ratio * phi.value, side);
      if (!knot) continue;
      const std::array<double, 3> g{side * (*knot - ratio * phi.value), -side * ratio * phi.rate,
                                    -0.5 * side * ratio * phi.acceleration};
      if (!(g[0] > 0.0)) continue;
      if (const auto s = first_crossing(g, end - t)) {
        first = t + *s;
        end = *first;
      }
    }
  }
  return first;
}

}  // namespace drev
