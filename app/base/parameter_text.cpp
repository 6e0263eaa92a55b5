#include "app/base/parameter_text.hpp"

#include <vector>

#include "app/base/text_layout.hpp"

namespace drev::app {

std::string parameters_text(const Parameters& parameters) {
  std::vector<std::string> items;
  for (std::size_t i = 0; i < parameters.known().size(); ++i)
    items.push_back(parameters.known()[i].name + " " + parameters.values()[i]);
  return join(items);
}

}  // namespace drev::app
