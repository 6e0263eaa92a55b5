#pragma once
/// Single values of a model file: numbers with their expressions, texts with what is filled in.
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "app/model_file/csv_table.hpp"
#include "app/model_file/expression.hpp"
#include "app/model_file/tree.hpp"

namespace drev::app {

/// What the tables of one file share.
struct ReadContext {
  Scope scope;
  std::map<std::string, const Value*> tables = {};  ///< of [tables]
  std::vector<Finding> findings = {};
  std::map<std::string, std::optional<CsvTable>> csv = {};  ///< read already; none: it could not be
  std::set<std::string> files = {};                         ///< that elements name
};

/// A number as it stands in the file, an expression evaluated; nothing, and a finding, if it is none. `unit`
/// is the unit of its key.
std::optional<double> read_number(const Value& value, const std::string& unit, const std::string& where,
                                  ReadContext& context);
/// A whole number in this range.
std::optional<int> read_whole(const Value& value, int low, int high, const std::string& where,
                              ReadContext& context);
/// A text, its {} replaced.
std::optional<std::string> read_text(const Value& value, const std::string& where, ReadContext& context);
/// A text or an array of them.
std::vector<std::string> read_texts(const Value& value, const std::string& where, ReadContext& context);

}  // namespace drev::app
