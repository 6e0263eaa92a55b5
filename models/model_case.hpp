#pragma once
/// ModelCase: an assembled model together with what is worth knowing to run it and to read its results.
#include <drev/core/model.hpp>
#include <drev/models/parameters.hpp>
#include <drev/solvers/start.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace drev {

struct Strength;

/// From when on figures are taken.
struct Settle {
  std::optional<double> time = {};  ///< s; none: found from the damped modes (solvers/modes/damped_modes.hpp)
};

struct ModelCase {
  Model model;
  double duration = 1.0;       ///< s
  double default_step = 1e-4;  ///< s; the model's header says why
  std::string note = {};       ///< e.g. that the data are a reconstruction; shown with every result
  /// Channels whose largest |value| is reported as the deflection (may be empty) and as the torques.
  std::string deflection = {};
  std::vector<std::string> torques = {};
  /// Turn of the reference shaft over which the static torque is sought [rad]; 0: not meaningful.
  double static_turn = 0.0;
  /// Channels recorded unless others are asked for.
  std::vector<std::string> channels = {};
  /// Files that it was read from; none of a model made by a program. Results are not written over them.
  std::vector<std::string> files = {};
  /// Where its runs start, and from when on their figures are taken (none: of the whole run), unless others are
  /// asked for.
  Start start = Start::rest;
  std::optional<Settle> settle = {};
  /// What its sections may carry (drev/solvers/strength/section_strength.hpp), for `drev class` and load cycles;
  /// null: not known.
  std::shared_ptr<const Strength> strength = {};
};

struct ModelEntry {
  std::string name;
  std::string summary;
  std::vector<Parameter> parameters;
  /// Throws ModelError for parameters that cannot be.
  std::function<ModelCase(Parameters)> build;
};

/// Every ready-made model, in the order in which a newcomer should read them.
const std::vector<ModelEntry>& ready_made_models();
/// By name; throws ModelError with the nearest name.
const ModelEntry& find_model(const std::string& name);

/// The defaults of a model with these parameters in their place.
Parameters values_of(const ModelEntry& entry, const ParameterValues& parameters);
/// A ready-made model with parameters; throws ModelError for a name or parameters that cannot be.
ModelCase build_case(const std::string& model, const ParameterValues& parameters);

}  // namespace drev
