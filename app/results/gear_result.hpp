#pragma once
/// A gear pair from its drawing as text and JSON.
#include <drev/models/gears/gear_drawing.hpp>

#include <string>
#include <vector>

#include "app/base/json_values.hpp"

namespace drev::app {

struct GearCase {
  std::string name;  ///< name of the element, or of the file
  GearDrawing drawing;
  GearMeshData data;
};

/// A row of the text for a quantity: name, value with its error, unit. A quantity may have several rows.
struct GearRow {
  std::string name, value;
};
std::vector<GearRow> gear_rows(const GearCase& c);
/// Dimensions of the two gears: rows of name, gear 1, gear 2.
std::vector<std::vector<std::string>> gear_dimensions(const GearCase& c);
/// The conventions and methods behind the figures, one sentence each.
std::vector<std::string> gear_conventions(const GearCase& c);

std::string gear_as_text(const std::vector<GearCase>& cases);
/// The result as an object of kind "gear" of docs/results.schema.json.
Json gear_object(const std::string& file, const std::vector<GearCase>& cases);

}  // namespace drev::app
