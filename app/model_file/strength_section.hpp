#pragma once
/// [class] of a model file: what sections may carry.
#include <drev/core/system.hpp>
#include <drev/models/model_case.hpp>
#include <drev/solvers/strength/section_strength.hpp>

#include "app/model_file/part.hpp"

namespace drev::app {

/// The keys of a section.
void list_section(Fields& f, SectionStrength& section);

/// Reads [class] into the case; sections whose name has a '*' become one for each element that it fits. What is wrong
/// goes to the context, but for names that may be of what the system leaves out.
void read_strength(const Value& table, const System& system, ModelCase& model_case, const LeftOut& left_out,
                   ReadContext& context);

}  // namespace drev::app
