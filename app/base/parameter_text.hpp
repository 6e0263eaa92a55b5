#pragma once
/// Parameters of a model as text.
#include <drev/models/parameters.hpp>

#include <string>

namespace drev::app {

/// "drive gears, backlash_mm 0.15, ...".
std::string parameters_text(const Parameters& parameters);

}  // namespace drev::app
