#pragma once
/// The elements that a model file knows, one row each; every row reads, writes and documents an element
/// through the one list of its fields. Elements of one's own are entered by register_element() before a file
/// is read, in a program of one's own or in a plugin (plugin.hpp):
///
///   register_element<LawElement<CubicLaw>>("cubic_coupling", [](Fields& f, CubicLaw& p) {
///     f.number({"stiffness", Dimension::torsional_stiffness}, p.k, Need::required);
///     f.number({"cubic_Nm_per_rad3", Dimension::none}, p.k3);
///   });
#include <drev/app/model_file/fields.hpp>
#include <drev/core/element_interface.hpp>

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace drev::app {

/// Calls its argument with the reader, writer or collector of fields.
using VisitFields = std::function<void(const ListFields&)>;

struct ElementType {
  std::string name;  ///< of `type`
  /// An element of what the fields then hold.
  std::function<std::shared_ptr<const Element>(const VisitFields& read)> make;
  /// False if the element is of another type.
  std::function<bool(const Element& element, const VisitFields& write)> list;
  std::string plugin = {};  ///< the file that it came from; empty: drev itself or this program
};

/// The row of an element E: list(Fields&, E::Params&) names its fields. E is made of its Params and gives
/// them back by params().
template <class E, class List>
ElementType element_type(std::string name, List list) {
  return {std::move(name),
          [list](const VisitFields& read) -> std::shared_ptr<const Element> {
            typename E::Params params{};
            read([&](Fields& f) { list(f, params); });
            return std::make_shared<const E>(std::move(params));
          },
          [list](const Element& element, const VisitFields& write) {
            const auto* self = dynamic_cast<const E*>(&element);
            if (self == nullptr) return false;
            typename E::Params params = self->params();
            write([&](Fields& f) { list(f, params); });
            return true;
          }};
}

/// Throws ModelError for a name that is empty or taken, and for keys that are there twice or are those of
/// every element (type, node, nodes).
void register_element_type(ElementType type);

/// Enters an element of one's own; `name` is what files call its type, in the manner of shaft_spring.
template <class E, class List>
void register_element(std::string name, List list) {
  register_element_type(element_type<E>(std::move(name), std::move(list)));
}

/// drev's own first, then what was registered.
std::span<const ElementType> element_types();
/// Null if there is none of this name.
const ElementType* find_element_type(const std::string& name);
std::vector<std::string> element_type_names();

/// Registers what `add` does; `plugin` is then the file that it came from. If it throws, nothing has been.
void register_from(const std::string& plugin, const std::function<void()>& add);

}  // namespace drev::app
