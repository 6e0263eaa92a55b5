#pragma once
/// Model: the description of a drivetrain, in names. build() validates it and returns a System.
#include <drev/core/ids.hpp>
#include <drev/core/motion.hpp>

#include <array>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace drev {

class Element;
class System;

/// A node by its id or by its name. Names are looked up by build(), so that all errors come at once.
struct NodeRef {
  NodeRef(NodeId node) : id(node) {}                    // NOLINT: implicit by intent
  NodeRef(std::string node) : name(std::move(node)) {}  // NOLINT
  NodeRef(const char* node) : name(node) {}             // NOLINT
  std::optional<NodeId> id;
  std::string name;
};

/// What list[i] gives, from position to position.
template <class List>
struct ByPosition {
  const List* list;
  int position;
  auto operator*() const { return (*list)[position]; }
  ByPosition& operator++() { return ++position, *this; }
  bool operator==(const ByPosition&) const = default;
};

/// Nodes as they were given; one or two ids, which is what most elements have, take no memory of their own.
class NodeList {
 public:
  explicit NodeList(std::span<const NodeRef> nodes);
  NodeList(const NodeList& other);
  NodeList(NodeList&&) noexcept = default;
  NodeList& operator=(NodeList other) noexcept;

  int size() const { return given_ ? static_cast<int>(given_->size()) : (ids_[0] >= 0) + (ids_[1] >= 0); }
  NodeRef operator[](int i) const { return given_ ? (*given_)[idx(i)] : NodeRef(NodeId{ids_[idx(i)]}); }
  NodeRef front() const { return (*this)[0]; }
  ByPosition<NodeList> begin() const { return {this, 0}; }
  ByPosition<NodeList> end() const { return {this, size()}; }
  operator std::vector<NodeRef>() const;  // NOLINT: implicit by intent

 private:
  std::array<int, 2> ids_{-1, -1};  // -1: none; not used where given_ is there
  std::unique_ptr<const std::vector<NodeRef>> given_;
};

/// Nodes that follow each other in their model.
struct NodeRange {
  int first = 0, count = 0;
  NodeId operator[](int i) const { return NodeId{first + i}; }
  ByPosition<NodeRange> begin() const { return {this, 0}; }
  ByPosition<NodeRange> end() const { return {this, count}; }
};

/// One element in its place.
struct ElementInstance {
  std::string name;
  std::shared_ptr<const Element> element;
  NodeList nodes;
  NodeRange internal;  ///< nodes that the element brought along
};

class Model {
 public:
  explicit Model(std::string name) : name_(std::move(name)) {}

  /// Adds a node. Names are unique and non-empty, without '.', ',', quotes and control characters
  /// (channel names are NODE.angle_rad); build() reports those that are not.
  NodeId add_node(std::string name, NodeKind kind = NodeKind::rotational);

  /// Adds an element of the catalogue or of one's own, e.g.
  ///   model.add<ShaftSpring>("shaft", {"motor", "pinion"}, {.stiffness = 8.5e3});
  template <class E>
  ElementId add(std::string name, std::initializer_list<NodeRef> nodes, typename E::Params params) {
    return place(std::move(name), NodeList(nodes), std::make_shared<const E>(std::move(params)));
  }
  ElementId add(std::string name, const std::vector<NodeRef>& nodes, std::shared_ptr<const Element> element) {
    return place(std::move(name), NodeList(nodes), std::move(element));
  }

  /// The node follows its nominal motion exactly (stands still where there is none): q = 0.
  void hold(NodeRef node);
  /// The node turns at constant speed omega [rad/s]: q = 0. Becomes the reference shaft if the model
  /// has none; otherwise omega must equal the node's nominal speed.
  void constant_speed(NodeRef node, double omega);
  /// The node's deviation from its nominal motion is given: q = u(t).
  void given_motion(NodeRef node, Motion deviation);
  /// Nominal motion phi(t) of the reference shaft, through this node: theta_i = n_i phi(t) + q_i.
  void set_reference(NodeRef node, Motion nominal);
  /// Deviation and its rate at the start; zero unless set. rad, rad/s (or m, m/s). Internal nodes of elements that are
  /// not set then start where no elastic force acts on them, and as fast.
  void set_initial(NodeRef node, double deviation, double rate);

  /// Validates, finds the nominal ratios, numbers the unknowns and fixes the sparsity.
  /// Throws ModelError with every finding.
  System build() const;

  struct Prescription {
    NodeRef node;
    std::optional<Motion> deviation;  ///< none: q = 0
    std::optional<double> omega;      ///< from constant_speed
  };
  struct Initial {
    NodeRef node;
    double deviation, rate;
  };
  const std::string& name() const { return name_; }
  const std::vector<std::string>& node_names() const { return *node_names_; }
  const std::string& name_of(const NodeRef& ref) const {
    return ref.id ? node_names_->at(static_cast<std::size_t>(*ref.id)) : ref.name;
  }
  const std::vector<NodeKind>& node_kinds() const { return node_kinds_; }
  const std::vector<ElementInstance>& element_instances() const { return *element_instances_; }
  const std::vector<Prescription>& prescriptions() const { return prescriptions_; }
  const std::vector<Initial>& initials() const { return initials_; }
  const std::vector<std::pair<NodeRef, Motion>>& references() const { return references_; }

 private:
  friend class SystemBuilder;
  ElementId place(std::string name, NodeList nodes, std::shared_ptr<const Element> element);
  /// To write to; a copy first where a System or another Model has it too.
  template <class T>
  static T& own(std::shared_ptr<T>& shared) {
    if (shared.use_count() > 1) shared = std::make_shared<T>(*shared);
    return *shared;
  }

  std::string name_;
  std::shared_ptr<std::vector<std::string>> node_names_ = std::make_shared<std::vector<std::string>>();
  std::vector<NodeKind> node_kinds_;
  std::shared_ptr<std::vector<ElementInstance>> element_instances_ =
      std::make_shared<std::vector<ElementInstance>>();
  std::vector<Prescription> prescriptions_;
  std::vector<Initial> initials_;
  std::vector<std::pair<NodeRef, Motion>> references_;
};

}  // namespace drev
