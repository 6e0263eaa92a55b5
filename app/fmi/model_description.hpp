#pragma once
/// modelDescription.xml of an FMU, for FMI 2.0 or 3.0 (fmi-standard.org, co-simulation).
#include <string>

#include "app/fmi/fmu_instance.hpp"

namespace drev::app {

/// fmi: version 2 or 3. identifier: name of the library, a C identifier. instance: an instance with its start
/// values.
std::string model_description(FmuInstance& instance, int fmi, const std::string& identifier);

}  // namespace drev::app
