#pragma once
/// The content of an FMU's modelDescription.xml that drev uses: FMI 2.0 and 3.0, co-simulation.
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace drev::app {

/// A scalar variable of an FMU.
struct ImportedVariable {
  enum class Type { real, integer, boolean, text, other };
  std::string name;
  unsigned reference = 0;
  Type type = Type::other;
  std::string type_name;  ///< as the description spells it, for messages
  std::string causality;  ///< input, output, parameter, ...
  std::string variability;
  double low = -std::numeric_limits<double>::infinity();  ///< its own min and max
  double high = std::numeric_limits<double>::infinity();
  bool array = false;  ///< true: an array of FMI 3; drev accepts scalars only
};

struct FmuDescription {
  int fmi = 0;                                ///< version of FMI: 2 or 3
  std::string model_name, token, identifier;  ///< identifier: name of the library for co-simulation
  bool interpolates_inputs = false;           ///< FMI 2: canInterpolateInputs
  std::vector<ImportedVariable> variables;

  const ImportedVariable* find(const std::string& name) const;
  /// Names of the variables with a causality.
  std::vector<std::string> names(std::string_view causality) const;
};

/// Throws std::runtime_error with line and reason for a text that is not a model description, and for an FMU
/// without co-simulation.
FmuDescription read_description(const std::string& xml);

}  // namespace drev::app
