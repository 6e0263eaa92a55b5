#pragma once
/// A gear pair from its drawing as text and JSON.
#include <drev/models/gears/gear_drawing.hpp>

#include <string>
#include <vector>

#include "app/base/json_values.hpp"

namespace drev::app {

struct GearCase {
  std::string name;  ///< of the element, or of the file
  GearDrawing drawing;
  GearMeshData data;
};

/// Two rows a quantity or more: name, value with its error, unit; in the order of the text.
struct GearRow {
  std::string name, value;
};
std::vector<GearRow> gear_rows(const GearCase& c);
/// By gear: name, gear 1, gear 2.
std::vector<std::vector<std::string>> gear_dimensions(const GearCase& c);
/// What the figures rest on, a sentence each.
std::vector<std::string> gear_conventions(const GearCase& c);

std::string gear_as_text(const std::vector<GearCase>& cases);
/// As docs/results.schema.json describes it, kind "gear".
Json gear_object(const std::string& file, const std::vector<GearCase>& cases);

}  // namespace drev::app
