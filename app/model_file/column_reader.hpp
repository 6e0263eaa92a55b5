#pragma once
/// Columns of one length, from arrays in the file or from a CSV file that it names.
#include <drev/app/model_file/fields.hpp>

#include "app/model_file/read_values.hpp"

namespace drev::app {

/// Fills the columns from a table; false if they could not be, for which there is a finding (of this call or,
/// for a CSV file, of an earlier one).
bool read_columns(const Value& source, const std::string& where, NodeKind kind,
                  const std::vector<Column>& columns, ReadContext& context);

}  // namespace drev::app
