#pragma once
/// What the modes of a model leave out.
#include <string>
#include <vector>

#include "app/run/model_request.hpp"

namespace drev::app {

/// Laws without a gap that are bent: modes are linearised at zero deflection. Of a model that the mean of its loads
/// holds in equilibrium, those alone whose slope is another there, with both slopes. And the load under which modes have the
/// stiffness of couplings that follow it.
std::vector<std::string> modes_notes(const ModelRequest& model);

}  // namespace drev::app
