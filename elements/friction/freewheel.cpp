#include <drev/core/element.hpp>
#include <drev/elements/friction/freewheel.hpp>

namespace drev {

void Freewheel::check(ParameterCheck& /*check*/) const {}

void Freewheel::describe(int nodes, Terms& terms) const {
  terms.frictions.push_back({.b = relative_motion(nodes), .friction = this});
}

}  // namespace drev
