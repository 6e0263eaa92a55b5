#pragma once
/// The Campbell diagram's data: the orders at which loads and meshes excite, and where they meet the natural
/// frequencies, which do not depend on speed in drev.
///
/// The orders of a load are those of its torque over two turns of its node. How much order o excites mode m
/// is the static response of the mode to the phase sum over all loads,
///
///   q_om = |sum_l x_l A_lo exp(i phase_lo)| / omega_m^2,   x_m' M x_m = 1,
///
/// times the shape's largest entry [rad or m]. At resonance it is 1 / (2 zeta_m) times as large.
#include <drev/core/system.hpp>
#include <drev/solvers/modes/modes.hpp>

#include "app/base/json_values.hpp"

namespace drev::app {

/// Null where no shaft turns. Else {shaft, speed: [rad/s at the start, at the end], orders: [{order, of}],
/// crossings: [{mode, order, speed, static}], shafts: [{name, ratio}]}: speeds of the reference shaft
/// [rad/s], orders per its revolution; shafts: one of each speed.
Json campbell_object(const Model& model, const System& system, const ModeSet& modes, double duration);

}  // namespace drev::app
