#pragma once
/// Files with drawings of gear pairs, for drev gear. docs/gears.md.
#include <drev/models/gears/gear_drawing.hpp>

#include <string>
#include <utility>
#include <vector>

#include "app/model_file/part.hpp"

namespace drev::app {

struct NamedDrawing {
  std::string name;  ///< of the element, or "geometry"
  GearDrawing drawing;
  Part part = {};          ///< where its fields stand
  std::string where = {};  ///< what faults call its table, "elements.mesh_1.geometry"
};

/// The drawings of a file: its [geometry], or those of the gear meshes of a model file, repeated ones each. settings: name
/// and value of the model file's parameters that are not to have their defaults. Throws ModelError with all that is wrong
/// with them, and where there is none.
std::vector<NamedDrawing> read_gear_drawings(
    const std::string& path, const std::vector<std::pair<std::string, std::string>>& settings = {});

}  // namespace drev::app
