#pragma once
/// Takes in the elements of plugins (plugin.hpp).
#include <string>
#include <vector>

namespace drev::app {

/// Loads shared libraries, which stay until the program ends; their types then stand in every model file.
/// Throws ModelError with what is wrong with each: no such file, no plugin of drev, one for another drev, a
/// type that is there already. The program must export its symbols (CMake: ENABLE_EXPORTS), as the command
/// drev does.
void load_plugins(const std::vector<std::string>& files);

/// Those that were loaded, as they were named.
const std::vector<std::string>& loaded_plugins();

}  // namespace drev::app
