#include <drev/core/element.hpp>
#include <drev/core/error.hpp>
#include <drev/core/law/friction.hpp>
#include <drev/core/system.hpp>

#include "core/names/article.hpp"

namespace drev {

const char* to_text(FrictionState state) {
  switch (state) {
    case FrictionState::backward:
      return "sliding backward";
    case FrictionState::stuck:
      return "stuck";
    case FrictionState::forward:
      return "sliding forward";
    case FrictionState::open:
      return "open";
  }
  return "";
}

int tie_of(const System& system, int loss) {
  return system.frictions()[idx(loss)].friction->gear_loss() ? loss - 1 : -1;
}

std::optional<std::string> why_not_friction(const System& system, const std::string& what) {
  if (system.frictions().empty()) return std::nullopt;
  const ElementInstance& first = system.element_instances()[idx(index(system.frictions().front().element))];
  return first.name + " is " + with_article(first.element->type()) + ", which sticks and slips: " + what +
         " does not take dry friction; take exact propagation from rest (method = \"exact\", start = "
         "\"rest\")";
}

void refuse_friction(const System& system, const std::string& what) {
  if (const auto why = why_not_friction(system, what)) throw SolverError(system.name() + ": " + *why);
}

}  // namespace drev
