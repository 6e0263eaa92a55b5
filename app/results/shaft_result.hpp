#pragma once
/// Results computed from the contours of a model's shafts, as text and JSON.
#include <drev/models/shafts/contour_shaft.hpp>

#include <string>
#include <vector>

#include "app/base/json_values.hpp"
#include "app/run/model_request.hpp"

namespace drev::app {

/// A contour shaft of a model.
struct PlacedShaft {
  std::string name, from_node, to_node;
  const ContourShaft* element = nullptr;  ///< owned by the model
};
std::vector<PlacedShaft> contour_shafts(const Model& model);

/// The results as text, with a drawing of each contour.
std::string shafts_as_text(const ModelRequest& request, const std::vector<PlacedShaft>& shafts);
/// The results as an object of kind "shaft" of docs/results.schema.json.
Json shafts_object(const ModelRequest& request, const std::vector<PlacedShaft>& shafts);

}  // namespace drev::app
