#pragma once
/// The interface of an FMU of drev, which its library reads from resources/interface.toml.
#include <drev/core/ids.hpp>
#include <drev/models/model_case.hpp>

#include <string>
#include <vector>

namespace drev::app {

struct FmuInterface {
  std::string model;  ///< path of the model file relative to the folder of interface.toml
  std::string run;    ///< named run of the model file; empty: [run] alone
  std::string token;  ///< common to library and description: guid of FMI 2, instantiationToken of FMI 3
  std::vector<std::string> torques, speeds;  ///< nodes whose torque or speed is an input
  std::vector<std::string> outputs;          ///< channels that are outputs
  ParameterValues parameters;                ///< start values that differ from the file's defaults
  std::vector<std::string> tunable = {};     ///< parameters that may change while a simulation runs
};

std::string interface_text(const FmuInterface& interface);
/// Throws ModelError for a file that is not an interface.toml.
FmuInterface read_interface(const std::string& path);

/// One of the FMU's variables. Its value reference is its place in the list; the first is the time.
struct FmuVariable {
  enum class Type { real, integer, text };
  enum class Role { time, parameter, torque, speed, output };
  std::string name;
  Type type = Type::real;
  Role role = Role::time;
  std::size_t place = 0;  ///< number among the variables of its role
  std::string unit = {}, meaning = {};
  bool tunable = false;  ///< true: a parameter that may change while a simulation runs
};

/// The variables: time, parameters, torques, speeds, outputs. kinds: kinds of the torque nodes, then of the
/// speed nodes.
std::vector<FmuVariable> fmu_variables(const FmuInterface& interface,
                                       const std::vector<Parameter>& parameters,
                                       const std::vector<NodeKind>& kinds,
                                       const std::vector<std::string>& output_units);

}  // namespace drev::app
