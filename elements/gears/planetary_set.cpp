#include <drev/core/element.hpp>
#include <drev/elements/gears/planetary_set.hpp>

namespace drev {

void PlanetarySet::check(ParameterCheck& check) const {
  const Params& p = params_;
  const bool teeth = p.teeth_sun != 0 || p.teeth_ring != 0;
  if (teeth && (p.teeth_sun <= 0 || p.teeth_ring <= 0))
    check.fail("teeth_sun", std::to_string(p.teeth_sun) + ", teeth_ring " + std::to_string(p.teeth_ring), "",
               "must both be > 0");
  if (teeth && !std::isnan(p.ratio))
    check.fail("ratio", to_text(p.ratio), "", "must not be given together with teeth; give one of them");
  if (!teeth) check.positive("ratio", p.ratio, "");
}

void PlanetarySet::describe(int nodes, Terms& terms) const {
  LocalRow b = LocalRow::Zero(nodes);
  b[0] = -1.0;
  b[1] = -ratio();
  b[2] = 1.0 + ratio();
  terms.constraints.push_back(b);
  if (!params_.together) return;
  for (const Eigen::Index other : {1, 2}) {
    LocalRow alike = LocalRow::Zero(nodes);
    alike[0] = 1.0;
    alike[other] = -1.0;
    terms.speed_ratio_constraints.push_back({.b = alike, .ratio_only = true});
  }
}

}  // namespace drev
