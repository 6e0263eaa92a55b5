#pragma once
/// Everything that changes in an instance of an FMU: a value, whose copy is a checkpoint.
#include <drev/core/state.hpp>

#include <cstdint>
#include <string>
#include <vector>

#include "app/fmi/inputs.hpp"

namespace drev::app {

/// What an instance may be asked for next.
enum class FmuMode : std::uint8_t { instantiated, initialization, step, terminated };

/// What the importer has set an input to, and its derivative over the next step.
struct InputValue {
  double value = 0.0, slope = 0.0;
};

struct FmuState {
  FmuMode mode = FmuMode::instantiated;
  bool started = false;                 ///< state is that of a time, and not still to be found
  double t_start = 0.0, t_stop = 0.0;   ///< s; t_stop <= t_start: none given
  double tolerance = 0.0;               ///< relative; 0: exact propagation's own
  std::vector<std::string> parameters;  ///< as text, in the model's order
  std::vector<InputValue> torque_values, speed_values;  ///< for the next step
  std::vector<InputSignal> torques;                     ///< what acted in the last step, as the next line
  std::vector<SpeedInput> speeds;
  State state;
};

/// The state as bytes, and back; token: of the FMU that it belongs to. from_bytes throws std::invalid_argument
/// for bytes that to_bytes did not write for the same FMU.
std::vector<std::uint8_t> to_bytes(const FmuState& state, const std::string& token);
FmuState from_bytes(const std::uint8_t* bytes, std::size_t size, const std::string& token);

}  // namespace drev::app
