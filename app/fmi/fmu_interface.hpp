#pragma once
/// What an FMU of drev offers, and how its library is told: resources/interface.toml.
#include <drev/core/ids.hpp>
#include <drev/models/model_case.hpp>

#include <string>
#include <vector>

namespace drev::app {

struct FmuInterface {
  std::string model;  ///< the model file, relative to the folder of interface.toml
  std::string run;    ///< named run of it; empty: [run] alone
  std::string token;  ///< ties library and description together: guid of FMI 2, instantiationToken of FMI 3
  std::vector<std::string> torques, speeds;  ///< nodes whose torque or speed is an input
  std::vector<std::string> outputs;          ///< channels
  ParameterValues parameters;                ///< start values that are not the file's defaults
  std::vector<std::string> tunable = {};     ///< parameters that may change while a simulation runs
};

std::string interface_text(const FmuInterface& interface);
/// Throws ModelError for a file that is not one.
FmuInterface read_interface(const std::string& path);

/// One of the FMU's variables. Its value reference is its place in the list; the first is the time.
struct FmuVariable {
  enum class Type { real, integer, text };
  enum class Role { time, parameter, torque, speed, output };
  std::string name;
  Type type = Type::real;
  Role role = Role::time;
  std::size_t place = 0;  ///< among the variables of its role
  std::string unit = {}, meaning = {};
  bool tunable = false;  ///< of a parameter
};

/// Time, parameters, torques, speeds, outputs. kinds: of the torques' nodes, then the speeds'.
std::vector<FmuVariable> fmu_variables(const FmuInterface& interface,
                                       const std::vector<Parameter>& parameters,
                                       const std::vector<NodeKind>& kinds,
                                       const std::vector<std::string>& output_units);

}  // namespace drev::app
