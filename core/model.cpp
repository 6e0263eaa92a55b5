#include <drev/core/element.hpp>
#include <drev/core/model.hpp>

#include <algorithm>

#include "core/system_builder.hpp"

namespace drev {

NodeId Model::add_node(std::string name, NodeKind kind) {
  own(node_names_).push_back(std::move(name));
  node_kinds_.push_back(kind);
  return NodeId{static_cast<int>(node_names_->size()) - 1};
}

NodeList::NodeList(std::span<const NodeRef> nodes) {
  const auto is_id = [](const NodeRef& ref) { return ref.id && index(*ref.id) >= 0; };
  if (nodes.size() > ids_.size() || !std::all_of(nodes.begin(), nodes.end(), is_id))
    given_ = std::make_unique<const std::vector<NodeRef>>(nodes.begin(), nodes.end());
  else
    for (std::size_t i = 0; i < nodes.size(); ++i) ids_[i] = index(*nodes[i].id);
}

NodeList::NodeList(const NodeList& other)
    : ids_(other.ids_),
      given_(other.given_ ? std::make_unique<const std::vector<NodeRef>>(*other.given_) : nullptr) {}

NodeList& NodeList::operator=(NodeList other) noexcept {
  ids_ = other.ids_;
  given_ = std::move(other.given_);
  return *this;
}

NodeList::operator std::vector<NodeRef>() const {
  std::vector<NodeRef> nodes;
  for (const NodeRef& node : *this) nodes.push_back(node);
  return nodes;
}

ElementId Model::place(std::string name, NodeList nodes, std::shared_ptr<const Element> element) {
  const std::vector<NodeKind> kinds = element ? element->internal_nodes() : std::vector<NodeKind>{};
  const NodeRange internal{static_cast<int>(node_names_->size()), static_cast<int>(kinds.size())};
  for (int i = 1; i <= internal.count; ++i) add_node(name + "_" + std::to_string(i), kinds[idx(i - 1)]);
  own(element_instances_).push_back({std::move(name), std::move(element), std::move(nodes), internal});
  return ElementId{static_cast<int>(element_instances_->size()) - 1};
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
