// A plugin that calls what no drev has.
#include <drev/app/model_file/plugin.hpp>

namespace drev {
void from_a_later_version();
}

DREV_PLUGIN() { drev::from_a_later_version(); }
