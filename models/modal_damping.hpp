#pragma once
/// Damping ratios of modes as an input.
#include <drev/core/model.hpp>
#include <drev/elements/modal_damping.hpp>

namespace drev {

/// Adds ModalDamping over all that is free to move in the model as it is now: call it last. Throws ModelError with what
/// is wrong with the model or the ratios; a train of more than 1000 unknowns, whose damping matrix would be dense; or
/// one with motions given in time, from which deviations of a mode cannot be told.
void add_modal_damping(Model& model, const std::string& name, const ModalDamping::Params& params);

}  // namespace drev
