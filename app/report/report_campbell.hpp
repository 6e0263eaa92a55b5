#pragma once
/// The Campbell diagram's data: the orders at which loads (app/run/excitation.hpp) and meshes excite, and where
/// they meet the natural frequencies.
#include <drev/core/system.hpp>
#include <drev/solvers/modes/modes.hpp>

#include "app/base/json_values.hpp"

namespace drev::app {

/// The node of the reference shaft; "reference shaft" if there is none.
std::string reference_name(const Model& model);

/// Null if no shaft turns, otherwise {shaft, speed: [slowest, fastest of the run, rad/s], orders: [{order,
/// of}], crossings: [{mode, order, speed, static}], shafts: [{name, ratio}]}: speeds of the reference shaft
/// [rad/s], orders per revolution of it; shafts: one for each distinct speed.
Json campbell_object(const Model& model, const System& system, const ModeSet& modes, double duration);

}  // namespace drev::app
