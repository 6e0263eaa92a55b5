#include <drev/core/element.hpp>
#include <drev/elements/couplings/elastic_coupling.hpp>

namespace drev {

void ElasticCoupling::check(ParameterCheck& check) const {
  spring_.check(check);
  check.non_negative("damping", params_.damping, "N m s/rad");
}

void ElasticCoupling::describe(int nodes, Terms& terms) const {
  LocalRow b = LocalRow::Zero(nodes);
  b[0] = -1.0;
  b[1] = 1.0;
  spring_.describe(b, 2, params_.damping, terms);
  terms.speed_ratio_constraints.push_back({.b = b});
}

}  // namespace drev
