#pragma once
/// One entry of the catalogue, as those see it that hold elements without asking for their terms (element.hpp): what it
/// needs, checks and states. An element is immutable, does not know its place in the model, and sees no global matrix:
/// describe() states its terms in its own node order, once.
#include <drev/core/error.hpp>
#include <drev/core/ids.hpp>

#include <string_view>
#include <vector>

namespace drev {

struct Terms;

class Element {
 public:
  virtual ~Element() = default;
  Element() = default;
  Element(const Element&) = delete;
  Element& operator=(const Element&) = delete;

  virtual std::string_view type() const = 0;  ///< as the catalogue calls it, e.g. "shaft spring"
  virtual int min_nodes() const = 0;          ///< named nodes it needs
  virtual int max_nodes() const { return min_nodes(); }
  /// Kinds of the nodes that it brings along, in their order. Asked when the element enters the model, before
  /// check().
  virtual std::vector<NodeKind> internal_nodes() const { return {}; }
  /// True for an element between rotational and translational nodes, named or internal (a rack); else build()
  /// refuses it. A law over nodes of both kinds is a force [N] of a deflection [m].
  virtual bool mixes_kinds() const { return false; }
  /// Reports every parameter out of range. Called by Model::build(); describe() only if none is.
  virtual void check(ParameterCheck& check) const = 0;
  /// Adds its terms; nodes = named nodes given + internal nodes.
  virtual void describe(int nodes, Terms& terms) const = 0;

  /// An element of very many nodes may state its terms in parts, each over few of them, so that memory and time
  /// grow with their number and not with its square. 0: it has no parts, and describe() says all. Otherwise the
  /// parts say together what describe() says.
  virtual int part_count() const { return 0; }
  /// The nodes of a part, in the numbering of describe().
  virtual std::vector<int> part_nodes(int /*part*/) const { return {}; }
  /// Adds the terms of a part, over its own nodes.
  virtual void describe_part(int /*part*/, Terms& /*terms*/) const {}
};

}  // namespace drev
