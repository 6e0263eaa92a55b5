#include "app/model_file/units.hpp"

#include <array>

#include "core/units.hpp"

namespace drev::app {

namespace {

constexpr Unit kAngle[] = {{"rad", 1.0}, {"deg", deg(1.0)}, {"mrad", 1e-3}};
constexpr Unit kLength[] = {{"m", 1.0}, {"mm", mm(1.0)}, {"um", 1e-6}};
constexpr Unit kTime[] = {{"s", 1.0}, {"ms", 1e-3}, {"us", 1e-6}};
constexpr Unit kAngularSpeed[] = {{"rad_per_s", 1.0}, {"rpm", rpm(1.0)}, {"deg_per_s", deg(1.0)}};
constexpr Unit kSpeed[] = {{"m_per_s", 1.0}, {"mm_per_s", 1e-3}};
constexpr Unit kFrequency[] = {{"Hz", 1.0}, {"kHz", 1e3}};
constexpr Unit kInertia[] = {{"kg_m2", 1.0}, {"kgm2", 1.0}, {"kg_mm2", 1e-6}};
constexpr Unit kMass[] = {{"kg", 1.0}};
constexpr Unit kTorsionalStiffness[] = {
    {"Nm_per_rad", 1.0}, {"kNm_per_rad", 1e3}, {"MNm_per_rad", 1e6}, {"Nm_per_deg", to_deg(1.0)}};
constexpr Unit kStiffness[] = {{"N_per_m", 1.0}, {"N_per_mm", 1e3}, {"N_per_um", 1e6}};
constexpr Unit kTorsionalDamping[] = {{"Nms_per_rad", 1.0}, {"kNms_per_rad", 1e3}};
constexpr Unit kDamping[] = {{"Ns_per_m", 1.0}, {"Ns_per_mm", 1e3}};
constexpr Unit kTorque[] = {{"Nm", 1.0}, {"kNm", 1e3}, {"MNm", 1e6}};
constexpr Unit kForce[] = {{"N", 1.0}, {"kN", 1e3}, {"MN", 1e6}};
constexpr Unit kPressure[] = {{"Pa", 1.0}, {"MPa", 1e6}, {"GPa", 1e9}};
constexpr Unit kDensity[] = {{"kg_per_m3", 1.0}};
constexpr Unit kRate[] = {{"per_s", 1.0}};
constexpr Unit kMeshPeriods[] = {{"periods", 1.0}};

constexpr std::array<NamedDimension, 18> kDimensions{{{"angle", Dimension::angle},
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
                                                      {"mesh phase", Dimension::mesh_periods}}};

}  // namespace

std::span<const Unit> units_of(Dimension dimension) {
  switch (dimension) {
    case Dimension::none:
      return {};
    case Dimension::angle:
      return kAngle;
    case Dimension::length:
      return kLength;
    case Dimension::time:
      return kTime;
    case Dimension::angular_speed:
      return kAngularSpeed;
    case Dimension::speed:
      return kSpeed;
    case Dimension::frequency:
      return kFrequency;
    case Dimension::inertia:
      return kInertia;
    case Dimension::mass:
      return kMass;
    case Dimension::torsional_stiffness:
      return kTorsionalStiffness;
    case Dimension::stiffness:
      return kStiffness;
    case Dimension::torsional_damping:
      return kTorsionalDamping;
    case Dimension::damping:
      return kDamping;
    case Dimension::torque:
      return kTorque;
    case Dimension::force:
      return kForce;
    case Dimension::pressure:
      return kPressure;
    case Dimension::density:
      return kDensity;
    case Dimension::rate:
      return kRate;
    case Dimension::mesh_periods:
      return kMeshPeriods;
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
