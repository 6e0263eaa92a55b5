#pragma once
/// Reads the fields of a table: finds each key with its unit, and reports what is wrong with the others.
#include <drev/app/model_file/fields.hpp>

#include <map>
#include <set>

#include "app/model_file/read_values.hpp"

namespace drev::app {

/// Where a field of a table stands, and how it was given where that is no number in SI: "pressure_angle_deg = 95".
struct FieldPlace {
  Position at;
  std::string given = {};
};

/// By name, for findings that come later.
using FieldPlaces = std::map<std::string, FieldPlace>;

/// Reads `table`, which says what the sentence calls `where` ("elements.shaft"). Keys in `others` are the
/// caller's. False if anything was wrong.
bool read_fields(const Value& table, const std::string& where, NodeKind kind,
                 const std::set<std::string>& others, const ListFields& list, ReadContext& context,
                 FieldPlaces* places = nullptr);

}  // namespace drev::app
