#pragma once
/// An element's terms as they are stated: all at once or part by part. Internal.
#include <drev/core/element.hpp>
#include <drev/core/law/law_piece.hpp>
#include <drev/core/system.hpp>

#include <algorithm>

#include "core/name_index.hpp"

namespace drev {

class ElementParts {
 public:
  /// Calls visit(terms, nodes) for each part of an element, or once where it has none. `nodes` are all nodes
  /// of the element; visit gets those of the part. False, and no more is visited: a part names a node that is none of
  /// the element's.
  template <class Visit>
  bool for_each(const Element& element, const std::vector<int>& nodes, const Visit& visit) {
    const int parts = element.part_count();
    if (parts == 0) {
      element.describe(static_cast<int>(nodes.size()), zeroed(nodes.size()));
      visit(terms_, nodes);
    }
    for (int part = 0; part < parts; ++part) {
      std::vector<int> own = element.part_nodes(part);
      for (int& node : own) {
        if (node < 0 || idx(node) >= nodes.size()) return false;
        node = nodes[idx(node)];
      }
      element.describe_part(part, zeroed(own.size()));
      visit(terms_, own);
    }
    return true;
  }

 private:
  Terms& zeroed(std::size_t nodes) {
    if (zero_.mass.rows() != static_cast<Eigen::Index>(nodes)) zero_ = Terms(static_cast<int>(nodes));
    return terms_ = zero_;
  }

  Terms zero_{0}, terms_{0};  // kept, so that elements of one size allocate their matrices once
};

/// Calls visit(element, terms, nodes) for the terms of every element of a system, part by part, asked of them again.
template <class Visit>
void for_each_stated(const System& system, const Visit& visit) {
  const NameIndex by_name(system.node_count(),
                          [&](int i) -> const std::string& { return system.node_names()[idx(i)]; });
  ElementParts parts;
  for (std::size_t e = 0; e < system.element_instances().size(); ++e) {
    const ElementInstance& p = system.element_instances()[e];
    std::vector<int> nodes;
    for (const NodeRef& ref : p.nodes) nodes.push_back(ref.id ? index(*ref.id) : by_name.find(ref.name));
    for (const NodeId id : p.internal) nodes.push_back(index(id));
    parts.for_each(*p.element, nodes, [&](const Terms& terms, const std::vector<int>& of_part) {
      visit(static_cast<int>(e), terms, of_part);
    });
  }
}

/// The piece k x + c x' of a law that is nothing else, whose term stands in the matrices; null for other laws.
const LawPiece* straight_line(const ScalarSpec& s);

}  // namespace drev
