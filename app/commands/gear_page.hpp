#pragma once
/// The report of drev gear: one page of tables and drawings, without network or program.
#include <string>
#include <vector>

#include "app/results/gear_result.hpp"

namespace drev::app {

std::string gear_page(const std::string& file, const std::vector<GearCase>& cases);

}  // namespace drev::app
