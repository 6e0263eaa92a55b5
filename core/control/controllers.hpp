#pragma once
/// The sampled controllers (sampled_controller.hpp) of a system, and who does not take them.
#include <optional>
#include <string>
#include <vector>

namespace drev {

class SampledController;
class System;

/// The sampled controllers of a system, with the names of their elements.
struct PlacedController {
  std::string name;
  const SampledController* controller = nullptr;
};
std::vector<PlacedController> sampled_controllers(const System& system);

/// Throws ModelError for a controller whose inputs are no signals of the system.
void check_controllers(const System& system);

/// Throws SolverError where the system has a sampled controller: `what` (a method or computation) does not take it.
void refuse_controllers(const System& system, const std::string& what);
/// The sentence that it says, without full stop; nullopt: there is none.
std::optional<std::string> why_not_controllers(const System& system, const std::string& what);

}  // namespace drev
