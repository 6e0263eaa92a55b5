#pragma once
/// The drev model of a Spec, through drev's public interface alone.
#include <drev/core/system.hpp>

#include "tests/stability/coverage/spec.hpp"

namespace coverage {

drev::System to_drev(const Spec& spec);

}  // namespace coverage
