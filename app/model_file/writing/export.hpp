#pragma once
/// A model case as a model file: every number in SI with the digits that read back to the same double.
#include <drev/app/model_file/model_file.hpp>

#include <string>

namespace drev::app {

/// Throws ModelError for what a file cannot hold: functions of one's own, elements of one's own. `options`: what the
/// file that the case is of says of its runs; the folder of results is left out, so that the written file's do not
/// take the place of the other's.
std::string export_model(const ModelEntry& entry, const Parameters& parameters, const ModelCase& model_case,
                         const RunOptions& options = {});

/// What a written file does not hold and why, as a clause: the misfire case of [class]. Empty: nothing is left out.
std::string left_out_of(const ModelCase& model_case);

}  // namespace drev::app
