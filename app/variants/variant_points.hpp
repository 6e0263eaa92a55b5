#pragma once
/// Some rows of a study's table for scatter plots: one random row of each part of the table, so that neither
/// the order of a grid nor that of a sample shows.
#include <string>

#include "app/base/json_values.hpp"
#include "app/variants/variant_study.hpp"

namespace drev::app {

inline constexpr std::uint64_t kMostPoints = 2000;

/// {count, of, parameters: [{name, unit, values, names}], figures: [{name, unit, values}]}. Parameters that are texts
/// have the place of their text in `names` as values, from 1 on. names is null for numbers, and empty for
/// more than 12 texts (orders), which have no values. A figure that a variant does not have is null. Reads
/// DIR/variants.h5; throws OutputError if that cannot be read.
Json variant_points(const VariantStudy& study, const std::string& folder);

}  // namespace drev::app
