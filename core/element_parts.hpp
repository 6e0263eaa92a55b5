#pragma once
/// An element's terms as they are stated: all at once or part by part. Internal.
#include <drev/core/element.hpp>

#include <algorithm>

namespace drev {

class ElementParts {
 public:
  /// Calls visit(terms, nodes) for each part of an element, or once where it has none. `nodes` are all nodes
  /// of the element; visit gets those of the part.
  template <class Visit>
  void for_each(const Element& element, const std::vector<int>& nodes, const Visit& visit) {
    const int parts = element.part_count();
    if (parts == 0) {
      element.describe(static_cast<int>(nodes.size()), zeroed(nodes.size()));
      visit(terms_, nodes);
    }
    for (int part = 0; part < parts; ++part) {
      std::vector<int> own = element.part_nodes(part);
      for (int& node : own) node = nodes[idx(node)];
      element.describe_part(part, zeroed(own.size()));
      visit(terms_, own);
    }
  }

 private:
  Terms& zeroed(std::size_t nodes) {
    if (zero_.mass.rows() != static_cast<Eigen::Index>(nodes)) zero_ = Terms(static_cast<int>(nodes));
    return terms_ = zero_;
  }

  Terms zero_{0}, terms_{0};  // kept, so that elements of one size allocate their matrices once
};

}  // namespace drev
