#pragma once
/// Units in the keys of a model file: stiffness_Nm_per_rad. A key's unit gives the factor into SI.
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace drev::app {

enum class Dimension {
  none,
  angle,
  length,
  time,
  angular_speed,
  speed,
  frequency,
  inertia,
  mass,
  torsional_stiffness,
  stiffness,
  torsional_damping,
  damping,
  torque,
  force,
  pressure,
  density,
  rate,
  mesh_periods,
  power
};

struct Unit {
  const char* suffix;  ///< of the key, without '_'
  double factor;       ///< into SI
};

/// Units of a dimension, the SI unit (factor exactly 1) first; empty for `none`.
std::span<const Unit> units_of(Dimension dimension);

/// Unit that a name ends in, "backlash_mm" -> "mm"; empty if it ends in none.
std::string unit_suffix(std::string_view name);

/// What a unit is made of: powers of kg, m and s, and its size in SI. Angles have none.
struct UnitParts {
  double kg = 0.0, m = 0.0, s = 0.0;
  double factor = 1.0;
};
/// Of a suffix such as "kNm"; all zero and 1 of one that is none.
UnitParts unit_parts(std::string_view suffix);

/// "stiffness_Nm_per_rad, stiffness_kNm_per_rad or ...": the spellings of a key.
std::string spellings(const std::string& name, Dimension dimension);
/// Its spelling in SI.
std::string si_key(const std::string& name, Dimension dimension);

/// Every dimension with its units, for the documentation's table.
struct NamedDimension {
  const char* name;
  Dimension dimension;
};
std::span<const NamedDimension> dimensions();

}  // namespace drev::app
