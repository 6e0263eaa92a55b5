#pragma once
/// Files with drawings of gear pairs, for drev gear. docs/gears.md.
#include <drev/models/gears/gear_drawing.hpp>

#include <string>
#include <vector>

namespace drev::app {

struct NamedDrawing {
  std::string name;  ///< of the element, or "geometry"
  GearDrawing drawing;
};

/// The drawings of a file: its [geometry], or those of the gear meshes of a model file, whose parameters have their
/// defaults. Throws ModelError with all that is wrong with them, and where there is none.
std::vector<NamedDrawing> read_gear_drawings(const std::string& path);

}  // namespace drev::app
