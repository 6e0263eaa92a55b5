#include "core/model.hpp"

#include "core/system_builder.hpp"

namespace drev {

NodeId Model::add_node(std::string name, NodeKind kind) {
  own(node_names_).push_back(std::move(name));
  node_kinds_.push_back(kind);
  return NodeId{static_cast<int>(node_names_->size()) - 1};
}

ElementId Model::add(std::string name, std::vector<NodeRef> nodes,
                     std::shared_ptr<const Element> element) {
  Placement placement{std::move(name), std::move(element), std::move(nodes), {}};
  const int internal = placement.element ? placement.element->internal_nodes() : 0;
  for (int i = 1; i <= internal; ++i)
    placement.internal.push_back(add_node(placement.name + "_" + std::to_string(i)));
  own(placements_).push_back(std::move(placement));
  return ElementId{static_cast<int>(placements_->size()) - 1};
}

void Model::hold(NodeRef node) { prescriptions_.push_back({std::move(node), {}, {}}); }

void Model::constant_speed(NodeRef node, double omega) {
  prescriptions_.push_back({std::move(node), {}, omega});
}

void Model::given_motion(NodeRef node, Motion deviation) {
  prescriptions_.push_back({std::move(node), std::move(deviation), {}});
}

void Model::set_reference(NodeRef node, Motion nominal) {
  references_.emplace_back(std::move(node), std::move(nominal));
}

void Model::set_initial(NodeRef node, double deviation, double rate) {
  initials_.push_back({std::move(node), deviation, rate});
}

System Model::build() const { return SystemBuilder(*this).build(); }

}  // namespace drev
