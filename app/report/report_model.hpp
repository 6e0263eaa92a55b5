#pragma once
/// The model as the report draws it: nodes with their inertias, joints between them, loads; and its modes.
///
/// Everything is taken from the elements' own descriptions (Element::describe), so that user-defined elements
/// are drawn, too: a constant stiffness between two nodes is a shaft, a law along a line of action is a mesh,
/// a constraint is an ideal gear, dry friction is a clutch.
#include <drev/core/system.hpp>
#include <drev/solvers/modes/modes.hpp>

#include "app/base/json_values.hpp"

namespace drev::app {

/// {nodes: [{name, turns, ratio, inertia, held}], joints: [{name, type, kind, nodes, ...}], loads: [{name,
/// type, node}], unknowns}. kind of a joint: shaft, mesh, gear, spring (a law), damper, friction, other; one node: to
/// ground.
Json model_object(const Model& model, const System& system);

/// [{frequency_Hz, shape: [one number for each node, largest 1], energy: [{element, share}]}]: share of the
/// mode's potential energy, for the three largest shares above 0.5 %.
Json modes_object(const System& system, const ModeSet& modes);

}  // namespace drev::app
