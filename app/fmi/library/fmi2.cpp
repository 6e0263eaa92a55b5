// The functions of FMI 2.0 for co-simulation, declared from the standard's text (fmi-standard.org, version 2.0.4).
#include <cstdlib>

#include "app/fmi/library/instances.hpp"

namespace {

using namespace drev::app;
using Fmi2Logger = void (*)(void* environment, const char* instance, int status, const char* category,
                            const char* message, ...);

/// Callbacks of the importer; the memory functions and stepFinished are not used.
struct Callbacks {
  Fmi2Logger logger;
  void* (*allocate)(std::size_t, std::size_t);
  void (*free)(void*);
  void (*step_finished)(void*, int);
  void* environment;
};

constexpr int kCoSimulation = 1;  // value of fmi2Type

/// The path of a file:// URI, with %XX decoded; any other text is returned unchanged.
std::string path_of(const std::string& uri) {
  std::string rest = uri;
  if (rest.starts_with("file://"))
    rest = rest.substr(7);
  else if (rest.starts_with("file:"))
    rest = rest.substr(5);
  else
    return rest;
  if (rest.starts_with("localhost/")) rest = rest.substr(9);
  std::string path;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    if (rest[i] == '%' && i + 2 < rest.size()) {
      path += static_cast<char>(std::strtol(rest.substr(i + 1, 2).c_str(), nullptr, 16));
      i += 2;
    } else {
      path += rest[i];
    }
  }
  return path;
}

int fmi2_absent(void* component, const char* call) {
  return guard(component, call,
               [](Component&) -> Status { throw FmuError("this FMU has nothing that the function is for"); });
}

}  // namespace

DREV_FMI const char* fmi2GetTypesPlatform() { return "default"; }
DREV_FMI const char* fmi2GetVersion() { return "2.0"; }

DREV_FMI int fmi2SetDebugLogging(void* component, int /*on*/, std::size_t count,
                                 const char* const* categories) {
  return guard(component, "fmi2SetDebugLogging", [&](Component&) {
    for (std::size_t i = 0; i < count; ++i) {
      const std::string category = categories == nullptr || categories[i] == nullptr ? "" : categories[i];
      if (category != "logStatusWarning" && category != "logStatusError")
        throw FmuError("there is no log category '" + category + "'");
    }
    return kOk;
  });
}

DREV_FMI void* fmi2Instantiate(const char* name, int type, const char* guid, const char* resources,
                               const Callbacks* callbacks, int /*visible*/, int /*logging*/) {
  const Fmi2Logger logger = callbacks != nullptr ? callbacks->logger : nullptr;
  void* environment = callbacks != nullptr ? callbacks->environment : nullptr;
  const auto log = [environment, logger, called = std::string(name != nullptr ? name : "")](
                       Status status, const char* category, const std::string& message) {
    if (logger != nullptr) logger(environment, called.c_str(), status, category, "%s", message.c_str());
  };
  if (type != kCoSimulation || resources == nullptr) {
    log(kError, "logStatusError",
        resources == nullptr ? "the FMU needs the location of its resources"
                             : "the FMU is one for co-simulation only");
    return nullptr;
  }
  return add_component(path_of(resources), guid != nullptr ? guid : "", log);
}

DREV_FMI void fmi2FreeInstance(void* component) { remove_component(component); }

// FMI 2 gives times and tolerance before initialization. They are kept in the state that begins it.
DREV_FMI int fmi2SetupExperiment(void* component, int tolerance_given, double tolerance, double t_start,
                                 int stop_given, double t_stop) {
  return guard(component, "fmi2SetupExperiment", [&](Component& c) {
    FmuState state = c.fmu->state();
    if (state.mode != FmuMode::instantiated) throw FmuError("it belongs ahead of initialization");
    c.fmu->enter_initialization(t_start, stop_given != 0 ? std::optional(t_stop) : std::nullopt,
                                tolerance_given != 0 ? tolerance : 0.0);
    const FmuState& checked = c.fmu->state();
    state.t_start = checked.t_start;
    state.t_stop = checked.t_stop;
    state.tolerance = checked.tolerance;
    c.fmu->set_state(state);
    return kOk;
  });
}

DREV_FMI int fmi2EnterInitializationMode(void* component) {
  return guard(component, "fmi2EnterInitializationMode", [](Component& c) {
    const FmuState& s = c.fmu->state();
    c.fmu->enter_initialization(s.t_start, s.t_stop, s.tolerance);
    return kOk;
  });
}

DREV_FMI int fmi2ExitInitializationMode(void* component) {
  return guard(component, "fmi2ExitInitializationMode",
               [](Component& c) { return warned(c, c.fmu->exit_initialization()); });
}

DREV_FMI int fmi2Terminate(void* component) {
  return guard(component, "fmi2Terminate", [](Component& c) {
    c.fmu->terminate();
    return kOk;
  });
}

DREV_FMI int fmi2Reset(void* component) {
  return guard(component, "fmi2Reset", [](Component& c) {
    c.fmu->reset();
    return kOk;
  });
}

DREV_FMI int fmi2DoStep(void* component, double t, double h, int /*no_set_before*/) {
  return guard(component, "fmi2DoStep", [&](Component& c) { return warned(c, c.fmu->step(t, h).warning); });
}

DREV_FMI int fmi2GetReal(void* component, const unsigned* references, std::size_t count, double* values) {
  return guard(component, "fmi2GetReal", [&](Component& c) {
    check_arrays(references, count, values, count);
    for (std::size_t i = 0; i < count; ++i) values[i] = c.fmu->real(references[i]);
    return kOk;
  });
}

DREV_FMI int fmi2SetReal(void* component, const unsigned* references, std::size_t count,
                         const double* values) {
  return guard(component, "fmi2SetReal", [&](Component& c) {
    check_arrays(references, count, values, count);
    c.fmu->set_reals(references, values, count);
    return kOk;
  });
}

DREV_FMI int fmi2GetInteger(void* component, const unsigned* references, std::size_t count, int* values) {
  return guard(component, "fmi2GetInteger", [&](Component& c) {
    check_arrays(references, count, values, count);
    for (std::size_t i = 0; i < count; ++i) values[i] = c.fmu->integer(references[i]);
    return kOk;
  });
}

DREV_FMI int fmi2SetInteger(void* component, const unsigned* references, std::size_t count,
                            const int* values) {
  return guard(component, "fmi2SetInteger", [&](Component& c) {
    check_arrays(references, count, values, count);
    c.fmu->set_integers(references, values, count);
    return kOk;
  });
}

DREV_FMI int fmi2GetString(void* component, const unsigned* references, std::size_t count,
                           const char** values) {
  return guard(component, "fmi2GetString", [&](Component& c) {
    check_arrays(references, count, values, count);
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < count; ++i) texts.push_back(c.fmu->text(references[i]));
    c.texts = std::move(texts);
    for (std::size_t i = 0; i < count; ++i) values[i] = c.texts[i].c_str();
    return kOk;
  });
}

DREV_FMI int fmi2SetString(void* component, const unsigned* references, std::size_t count,
                           const char* const* values) {
  return guard(component, "fmi2SetString", [&](Component& c) {
    check_arrays(references, count, values, count);
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < count; ++i) texts.emplace_back(values[i] != nullptr ? values[i] : "");
    c.fmu->set_texts(references, texts);
    return kOk;
  });
}

DREV_FMI int fmi2GetBoolean(void* component, const unsigned* /*references*/, std::size_t count,
                            int* /*values*/) {
  return count == 0 ? kOk : fmi2_absent(component, "fmi2GetBoolean");
}
DREV_FMI int fmi2SetBoolean(void* component, const unsigned* /*references*/, std::size_t count,
                            const int* /*values*/) {
  return count == 0 ? kOk : fmi2_absent(component, "fmi2SetBoolean");
}

DREV_FMI int fmi2SetRealInputDerivatives(void* component, const unsigned* references, std::size_t count,
                                         const int* orders, const double* values) {
  return guard(component, "fmi2SetRealInputDerivatives", [&](Component& c) {
    check_arrays(references, count, values, count);
    check_arrays(references, count, orders, count);
    for (std::size_t i = 0; i < count; ++i)
      if (orders[i] != 1) throw FmuError("only the first derivative of an input is taken");
    c.fmu->set_input_slopes(references, values, count);
    return kOk;
  });
}

DREV_FMI int fmi2GetRealOutputDerivatives(void* component, const unsigned* /*references*/,
                                          std::size_t /*count*/, const int* /*orders*/, double* /*values*/) {
  return fmi2_absent(component, "fmi2GetRealOutputDerivatives");
}
DREV_FMI int fmi2GetDirectionalDerivative(void* component, const unsigned* unknowns,
                                          std::size_t unknown_count, const unsigned* knowns,
                                          std::size_t known_count, const double* seed, double* sensitivity) {
  return guard(component, "fmi2GetDirectionalDerivative", [&](Component& c) {
    return derivative(c, {unknowns, unknown_count, sensitivity, unknown_count},
                      {knowns, known_count, seed, known_count});
  });
}
DREV_FMI int fmi2CancelStep(void* component) { return fmi2_absent(component, "fmi2CancelStep"); }
DREV_FMI int fmi2GetStatus(void* component, int /*kind*/, int* /*value*/) {
  return fmi2_absent(component, "fmi2GetStatus");
}
DREV_FMI int fmi2GetRealStatus(void* component, int /*kind*/, double* /*value*/) {
  return fmi2_absent(component, "fmi2GetRealStatus");
}
DREV_FMI int fmi2GetIntegerStatus(void* component, int /*kind*/, int* /*value*/) {
  return fmi2_absent(component, "fmi2GetIntegerStatus");
}
DREV_FMI int fmi2GetBooleanStatus(void* component, int /*kind*/, int* /*value*/) {
  return fmi2_absent(component, "fmi2GetBooleanStatus");
}
DREV_FMI int fmi2GetStringStatus(void* component, int /*kind*/, const char** /*value*/) {
  return fmi2_absent(component, "fmi2GetStringStatus");
}

DREV_FMI int fmi2GetFMUstate(void* component, void** state) {
  return guard(component, "fmi2GetFMUstate", [&](Component& c) { return get_state(c, state); });
}
DREV_FMI int fmi2SetFMUstate(void* component, void* state) {
  return guard(component, "fmi2SetFMUstate", [&](Component& c) { return set_state(c, state); });
}
DREV_FMI int fmi2FreeFMUstate(void* component, void** state) {
  return guard(component, "fmi2FreeFMUstate", [&](Component& c) { return free_state(c, state); });
}
DREV_FMI int fmi2SerializedFMUstateSize(void* component, void* state, std::size_t* size) {
  return guard(component, "fmi2SerializedFMUstateSize",
               [&](Component& c) { return state_size(c, state, size); });
}
DREV_FMI int fmi2SerializeFMUstate(void* component, void* state, std::uint8_t* bytes, std::size_t size) {
  return guard(component, "fmi2SerializeFMUstate",
               [&](Component& c) { return write_state(c, state, bytes, size); });
}
DREV_FMI int fmi2DeSerializeFMUstate(void* component, const std::uint8_t* bytes, std::size_t size,
                                     void** state) {
  return guard(component, "fmi2DeSerializeFMUstate",
               [&](Component& c) { return read_state(c, bytes, size, state); });
}
