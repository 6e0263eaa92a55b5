#pragma once
/// Everything that changes in an instance of an FMU, as a value whose copy is a checkpoint.
#include <drev/core/state.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/fmi/inputs.hpp"

namespace drev::app {

/// The mode of an instance, which determines the calls allowed next.
enum class FmuMode : std::uint8_t { instantiated, initialization, step, terminated };

/// The value that the importer has set an input to, and its time derivative over the next step.
struct InputValue {
  double value = 0.0, slope = 0.0;
};

struct FmuState {
  FmuMode mode = FmuMode::instantiated;
  bool started = false;                 ///< true: the start state has been found
  double t_start = 0.0;                 ///< start time [s]
  std::optional<double> t_stop = {};    ///< stop time [s], which no step may pass
  double tolerance = 0.0;               ///< relative tolerance [-]; 0: the default of exact propagation
  std::vector<std::string> parameters;  ///< values as text, in the model's order
  std::vector<InputValue> torque_values, speed_values;  ///< inputs for the next step
  std::vector<InputSignal> torques;                     ///< torques of the last step; speeds likewise
  std::vector<SpeedInput> speeds;
  State state;
};

/// The state as bytes, and back; token: token of the FMU that it belongs to. from_bytes throws
/// std::invalid_argument for bytes that to_bytes did not write for the same FMU.
std::vector<std::uint8_t> to_bytes(const FmuState& state, const std::string& token);
FmuState from_bytes(const std::uint8_t* bytes, std::size_t size, const std::string& token);

}  // namespace drev::app
