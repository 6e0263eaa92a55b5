#pragma once
/// The elements that a model file knows, one row each; every row reads, writes and documents an element
/// through the one list of its fields.
#include <drev/core/element.hpp>

#include <memory>
#include <span>

#include "app/model_file/fields.hpp"

namespace drev::app {

/// Calls its argument with the reader, writer or collector of fields.
using VisitFields = std::function<void(const ListFields&)>;

struct ElementType {
  const char* name;  ///< of `type`
  /// An element of what the fields then hold.
  std::shared_ptr<const Element> (*make)(const VisitFields& read);
  /// False if the element is of another type.
  bool (*list)(const Element& element, const VisitFields& write);
};

std::span<const ElementType> element_types();
/// Null if there is none of this name.
const ElementType* find_element_type(const std::string& name);
std::vector<std::string> element_type_names();

}  // namespace drev::app
