#include <drev/app/model_file/units.hpp>
#include <drev/core/units.hpp>

#include <array>

namespace drev::app {

namespace {

constexpr Unit kAngleUnits[] = {{"rad", 1.0}, {"deg", deg(1.0)}, {"mrad", 1e-3}};
constexpr Unit kLengthUnits[] = {{"m", 1.0}, {"mm", mm(1.0)}, {"um", 1e-6}};
constexpr Unit kTimeUnits[] = {{"s", 1.0}, {"ms", 1e-3}, {"us", 1e-6}};
constexpr Unit kAngularSpeedUnits[] = {{"rad_per_s", 1.0}, {"rpm", rpm(1.0)}, {"deg_per_s", deg(1.0)}};
constexpr Unit kSpeedUnits[] = {{"m_per_s", 1.0}, {"mm_per_s", 1e-3}};
constexpr Unit kFrequencyUnits[] = {{"Hz", 1.0}, {"kHz", 1e3}};
constexpr Unit kInertiaUnits[] = {{"kg_m2", 1.0}, {"kgm2", 1.0}, {"kg_mm2", 1e-6}};
constexpr Unit kMassUnits[] = {{"kg", 1.0}};
constexpr Unit kTorsionalStiffnessUnits[] = {
    {"Nm_per_rad", 1.0}, {"kNm_per_rad", 1e3}, {"MNm_per_rad", 1e6}, {"Nm_per_deg", to_deg(1.0)}};
constexpr Unit kStiffnessUnits[] = {{"N_per_m", 1.0}, {"N_per_mm", 1e3}, {"N_per_um", 1e6}};
constexpr Unit kTorsionalDampingUnits[] = {{"Nms_per_rad", 1.0}, {"kNms_per_rad", 1e3}};
constexpr Unit kDampingUnits[] = {{"Ns_per_m", 1.0}, {"Ns_per_mm", 1e3}};
constexpr Unit kTorqueUnits[] = {{"Nm", 1.0}, {"kNm", 1e3}, {"MNm", 1e6}};
constexpr Unit kForceUnits[] = {{"N", 1.0}, {"kN", 1e3}, {"MN", 1e6}};
constexpr Unit kPressureUnits[] = {{"Pa", 1.0}, {"MPa", 1e6}, {"GPa", 1e9}, {"bar", 1e5}};
constexpr Unit kDensityUnits[] = {{"kg_per_m3", 1.0}};
constexpr Unit kRateUnits[] = {{"per_s", 1.0}};
constexpr Unit kMeshPeriodsUnits[] = {{"periods", 1.0}};
constexpr Unit kPowerUnits[] = {{"W", 1.0}, {"kW", 1e3}, {"MW", 1e6}};

constexpr std::array<NamedDimension, 19> kDimensions{{{"angle", Dimension::angle},
                                                      {"length", Dimension::length},
                                                      {"time", Dimension::time},
                                                      {"angular speed", Dimension::angular_speed},
                                                      {"speed", Dimension::speed},
                                                      {"frequency", Dimension::frequency},
                                                      {"inertia", Dimension::inertia},
                                                      {"mass", Dimension::mass},
                                                      {"torsional stiffness", Dimension::torsional_stiffness},
                                                      {"stiffness", Dimension::stiffness},
                                                      {"torsional damping", Dimension::torsional_damping},
                                                      {"damping", Dimension::damping},
                                                      {"torque", Dimension::torque},
                                                      {"force", Dimension::force},
                                                      {"pressure", Dimension::pressure},
                                                      {"density", Dimension::density},
                                                      {"rate", Dimension::rate},
                                                      {"mesh phase", Dimension::mesh_periods},
                                                      {"power", Dimension::power}}};

/// Powers of kg, m and s.
UnitParts powers_of(Dimension dimension) {
  switch (dimension) {
    case Dimension::none:
    case Dimension::angle:
    case Dimension::mesh_periods:
      return {};
    case Dimension::length:
      return {0, 1, 0};
    case Dimension::time:
      return {0, 0, 1};
    case Dimension::angular_speed:
    case Dimension::frequency:
    case Dimension::rate:
      return {0, 0, -1};
    case Dimension::speed:
      return {0, 1, -1};
    case Dimension::inertia:
      return {1, 2, 0};
    case Dimension::mass:
      return {1, 0, 0};
    case Dimension::torsional_stiffness:
    case Dimension::torque:
      return {1, 2, -2};
    case Dimension::stiffness:
      return {1, 0, -2};
    case Dimension::torsional_damping:
      return {1, 2, -1};
    case Dimension::damping:
      return {1, 0, -1};
    case Dimension::force:
      return {1, 1, -2};
    case Dimension::pressure:
      return {1, -1, -2};
    case Dimension::density:
      return {1, -3, 0};
    case Dimension::power:
      return {1, 2, -3};
  }
  return {};
}

}  // namespace

std::span<const Unit> units_of(Dimension dimension) {
  switch (dimension) {
    case Dimension::none:
      return {};
    case Dimension::angle:
      return kAngleUnits;
    case Dimension::length:
      return kLengthUnits;
    case Dimension::time:
      return kTimeUnits;
    case Dimension::angular_speed:
      return kAngularSpeedUnits;
    case Dimension::speed:
      return kSpeedUnits;
    case Dimension::frequency:
      return kFrequencyUnits;
    case Dimension::inertia:
      return kInertiaUnits;
    case Dimension::mass:
      return kMassUnits;
    case Dimension::torsional_stiffness:
      return kTorsionalStiffnessUnits;
    case Dimension::stiffness:
      return kStiffnessUnits;
    case Dimension::torsional_damping:
      return kTorsionalDampingUnits;
    case Dimension::damping:
      return kDampingUnits;
    case Dimension::torque:
      return kTorqueUnits;
    case Dimension::force:
      return kForceUnits;
    case Dimension::pressure:
      return kPressureUnits;
    case Dimension::density:
      return kDensityUnits;
    case Dimension::rate:
      return kRateUnits;
    case Dimension::mesh_periods:
      return kMeshPeriodsUnits;
    case Dimension::power:
      return kPowerUnits;
  }
  return {};
}

std::span<const NamedDimension> dimensions() { return kDimensions; }

std::string unit_suffix(std::string_view name) {
  std::string longest;
  for (const NamedDimension& d : kDimensions)
    for (const Unit& unit : units_of(d.dimension)) {
      const std::string suffix = std::string("_") + unit.suffix;
      if (name.size() > suffix.size() && name.ends_with(suffix) && suffix.size() > longest.size() + 1)
        longest = unit.suffix;
    }
  return longest;
}

UnitParts unit_parts(std::string_view suffix) {
  for (const NamedDimension& d : kDimensions)
    for (const Unit& unit : units_of(d.dimension))
      if (suffix == unit.suffix) {
        UnitParts parts = powers_of(d.dimension);
        parts.factor = unit.factor;
        return parts;
      }
  return {};
}

std::string spellings(const std::string& name, Dimension dimension) {
  std::string text;
  const std::span<const Unit> units = units_of(dimension);
  for (std::size_t i = 0; i < units.size(); ++i)
    text += (i == 0 ? "" : i + 1 == units.size() ? " or " : ", ") + name + "_" + units[i].suffix;
  return units.empty() ? name : text;
}

std::string si_key(const std::string& name, Dimension dimension) {
  const std::span<const Unit> units = units_of(dimension);
  return units.empty() ? name : name + "_" + units.front().suffix;
}

}  // namespace drev::app
