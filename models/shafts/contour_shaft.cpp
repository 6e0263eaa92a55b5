#include <drev/core/element.hpp>
#include <drev/models/shafts/contour_shaft.hpp>

#include "elements/segment_chain.hpp"

namespace drev {

ContourShaft::ContourShaft(Params params) : params_(std::move(params)) {
  try {
    sections_ = std::make_shared<const ShaftSections>(shaft_sections(params_));
  } catch (const ModelError& error) {
    findings_ = error.findings();
  }
}

int ContourShaft::part_count() const {
  return sections_ ? static_cast<int>(sections_->segment_inertia.size()) : 1;
}

std::vector<NodeKind> ContourShaft::internal_nodes() const {
  return std::vector(static_cast<std::size_t>(part_count() - 1), NodeKind::rotational);
}

void ContourShaft::check(ParameterCheck& check) const {
  for (const Finding& f : findings_) check.fail(f.parameter, f.value, f.unit, f.range);
}

std::vector<int> ContourShaft::part_nodes(int part) const { return chain_nodes(part, part_count()); }

void ContourShaft::describe_part(int part, Terms& terms) const {
  const auto k = static_cast<std::size_t>(part);
  describe_segment(part, params_.shear_modulus / sections_->segment_flexibility[k],
                   sections_->segment_inertia[k], params_.mass, terms);
}

void ContourShaft::describe(int nodes, Terms& terms) const { describe_chain(*this, nodes, terms); }

}  // namespace drev
