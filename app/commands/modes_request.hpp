#pragma once
/// What the command line asks of `drev modes`, checked, and the damped modes that it means.
#include <drev/solvers/modes/damped_modes.hpp>
#include <drev/solvers/modes/modes.hpp>

#include <optional>
#include <string>

#include "app/cli/command_line.hpp"
#include "app/run/model_request.hpp"

namespace drev::app {

struct ModesRequest {
  ModelRequest model;
  ModesOptions options;
  bool damped = false;
  double speed = 0.0;  ///< rad/s, at which loads that follow it act as dampers; 0: without them
  std::optional<int> count = {};
  std::optional<std::string> out = {};  ///< directory for tables
};

/// Throws ModelError with everything wrong with the line.
ModesRequest request_modes(const CommandLine& line);

/// The damped modes: all of them, and how many are shown.
struct DampedModes {
  DampedModeSet set;
  ModeEnergy energy = {};
  std::size_t count = 0;
};
DampedModes find_damped_modes(const ModesRequest& request);

}  // namespace drev::app
