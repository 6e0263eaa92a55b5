// The functions of FMI 3.0 for co-simulation, declared from the standard's text (fmi-standard.org, version 3.0).
#include <algorithm>

#include "app/fmi/library/instances.hpp"

namespace {

using namespace drev::app;
using Instance = void*;
using Reference = std::uint32_t;
using Logger = void (*)(void* environment, int status, const char* category, const char* message);
using IntermediateUpdate = void (*)(void* environment, double t, bool set_requested, bool get_allowed,
                                    bool step_finished, bool can_return_early, bool* early_return_requested,
                                    double* early_return_time);

constexpr std::size_t kMostValues = std::size_t{1} << 24;

const char* text_or_empty(const char* text) { return text == nullptr ? "" : text; }

}  // namespace

DREV_FMI const char* fmi3GetVersion() { return "3.0"; }

DREV_FMI int fmi3SetDebugLogging(Instance instance, bool /*on*/, std::size_t count,
                                 const char* const* categories) {
  return guard(instance, "fmi3SetDebugLogging", [&](Component&) {
    for (std::size_t i = 0; i < count; ++i) {
      const std::string category = categories == nullptr ? "" : text_or_empty(categories[i]);
      if (category != "logStatusWarning" && category != "logStatusError")
        throw FmuError("there is no log category '" + category + "'");
    }
    return kOk;
  });
}

DREV_FMI Instance fmi3InstantiateCoSimulation(const char* name, const char* token, const char* resources,
                                              bool /*visible*/, bool /*logging*/, bool event_mode, bool early,
                                              const Reference* /*intermediate*/,
                                              std::size_t /*intermediate_count*/, void* environment,
                                              Logger logger, IntermediateUpdate update) {
  (void)name;
  const auto log = [environment, logger](Status status, const char* category, const std::string& message) {
    if (logger != nullptr) logger(environment, status, category, message.c_str());
  };
  if (resources == nullptr) {
    log(kError, "logStatusError", "the FMU needs the path of its resources");
    return nullptr;
  }
  Component* component = add_component(resources, text_or_empty(token), log);
  if (component == nullptr) return nullptr;
  component->uses_events = event_mode;
  component->may_end_early = early;
  if (update != nullptr)
    component->update = [environment, update](double t) {
      bool ends_early = false;
      double end = t;
      update(environment, t, false, true, true, false, &ends_early, &end);
    };
  return component;
}

DREV_FMI void fmi3FreeInstance(Instance instance) { remove_component(instance); }

DREV_FMI int fmi3EnterInitializationMode(Instance instance, bool tolerance_given, double tolerance,
                                         double t_start, bool stop_given, double t_stop) {
  return guard(instance, "fmi3EnterInitializationMode", [&](Component& c) {
    c.fmu->enter_initialization(t_start, stop_given ? std::optional(t_stop) : std::nullopt,
                                tolerance_given ? tolerance : 0.0);
    return kOk;
  });
}

DREV_FMI int fmi3ExitInitializationMode(Instance instance) {
  return guard(instance, "fmi3ExitInitializationMode", [](Component& c) {
    const std::string warning = c.fmu->exit_initialization();
    c.in_event = c.uses_events;
    return warned(c, warning);
  });
}

DREV_FMI int fmi3Terminate(Instance instance) {
  return guard(instance, "fmi3Terminate", [](Component& c) {
    c.fmu->terminate();
    return kOk;
  });
}

DREV_FMI int fmi3Reset(Instance instance) {
  return guard(instance, "fmi3Reset", [](Component& c) {
    c.fmu->reset();
    c.in_event = false;
    return kOk;
  });
}

DREV_FMI int fmi3DoStep(Instance instance, double t, double h, bool /*no_set_before*/, bool* event,
                        bool* terminate, bool* early, double* last) {
  return guard(instance, "fmi3DoStep", [&](Component& c) {
    if (c.in_event) throw FmuError("it belongs in step mode: fmi3EnterStepMode comes first");
    FmuStepWishes wishes{.end_at_change = c.uses_events && c.may_end_early};
    const auto tell = [&c](double at) {
      c.updating = true;
      c.update(at);
      c.updating = false;
    };
    if (c.update) wishes.inside = tell;
    const FmuStepped stepped = c.fmu->step(t, h, wishes);
    if (event != nullptr) *event = stepped.at_change;
    if (terminate != nullptr) *terminate = false;
    const double ended = c.fmu->state().state.t;
    if (early != nullptr) *early = ended < t + h;
    if (last != nullptr) *last = ended;
    return warned(c, stepped.warning);
  });
}

DREV_FMI int fmi3EnterEventMode(Instance instance) {
  return guard(instance, "fmi3EnterEventMode", [](Component& c) {
    if (!c.uses_events) throw FmuError("the instance was made without event mode");
    if (c.in_event || c.fmu->mode() != FmuMode::step) throw FmuError("it belongs in step mode");
    c.in_event = true;
    return kOk;
  });
}

DREV_FMI int fmi3EnterStepMode(Instance instance) {
  return guard(instance, "fmi3EnterStepMode", [](Component& c) {
    if (!c.in_event) throw FmuError("it belongs in event mode");
    c.in_event = false;
    return kOk;
  });
}

// The train has no discrete states: its contacts follow the motion.
DREV_FMI int fmi3UpdateDiscreteStates(Instance instance, bool* needs_update, bool* terminate,
                                      bool* nominals_changed, bool* states_changed, bool* next_defined,
                                      double* /*next*/) {
  return guard(instance, "fmi3UpdateDiscreteStates", [&](Component& c) {
    if (!c.in_event) throw FmuError("it belongs in event mode");
    for (bool* answer : {needs_update, terminate, nominals_changed, states_changed, next_defined})
      if (answer != nullptr) *answer = false;
    return kOk;
  });
}

DREV_FMI int fmi3GetDirectionalDerivative(Instance instance, const Reference* unknowns,
                                          std::size_t unknown_count, const Reference* knowns,
                                          std::size_t known_count, const double* seed, std::size_t seed_count,
                                          double* sensitivity, std::size_t sensitivity_count) {
  return guard(instance, "fmi3GetDirectionalDerivative", [&](Component& c) {
    return derivative(c, {unknowns, unknown_count, sensitivity, sensitivity_count},
                      {knowns, known_count, seed, seed_count});
  });
}

DREV_FMI int fmi3GetFloat64(Instance instance, const Reference* references, std::size_t count, double* values,
                            std::size_t value_count) {
  return guard(instance, "fmi3GetFloat64", [&](Component& c) {
    check_arrays(references, count, values, value_count);
    for (std::size_t i = 0; i < count; ++i) values[i] = c.fmu->real(references[i]);
    return kOk;
  });
}

DREV_FMI int fmi3SetFloat64(Instance instance, const Reference* references, std::size_t count,
                            const double* values, std::size_t value_count) {
  return guard(instance, "fmi3SetFloat64", [&](Component& c) {
    check_arrays(references, count, values, value_count);
    c.fmu->set_reals(references, values, count);
    return kOk;
  });
}

DREV_FMI int fmi3GetInt32(Instance instance, const Reference* references, std::size_t count,
                          std::int32_t* values, std::size_t value_count) {
  return guard(instance, "fmi3GetInt32", [&](Component& c) {
    check_arrays(references, count, values, value_count);
    for (std::size_t i = 0; i < count; ++i) values[i] = c.fmu->integer(references[i]);
    return kOk;
  });
}

DREV_FMI int fmi3SetInt32(Instance instance, const Reference* references, std::size_t count,
                          const std::int32_t* values, std::size_t value_count) {
  return guard(instance, "fmi3SetInt32", [&](Component& c) {
    check_arrays(references, count, values, value_count);
    c.fmu->set_integers(references, values, count);
    return kOk;
  });
}

DREV_FMI int fmi3GetString(Instance instance, const Reference* references, std::size_t count,
                           const char** values, std::size_t value_count) {
  return guard(instance, "fmi3GetString", [&](Component& c) {
    check_arrays(references, count, values, value_count);
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < count; ++i) texts.push_back(c.fmu->text(references[i]));
    c.texts = std::move(texts);
    for (std::size_t i = 0; i < count; ++i) values[i] = c.texts[i].c_str();
    return kOk;
  });
}

DREV_FMI int fmi3SetString(Instance instance, const Reference* references, std::size_t count,
                           const char* const* values, std::size_t value_count) {
  return guard(instance, "fmi3SetString", [&](Component& c) {
    check_arrays(references, count, values, value_count);
    if (count > kMostValues) throw FmuError("there are too many values");
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < count; ++i) texts.emplace_back(text_or_empty(values[i]));
    c.fmu->set_texts(references, texts);
    return kOk;
  });
}

DREV_FMI int fmi3GetFMUState(Instance instance, void** state) {
  return guard(instance, "fmi3GetFMUState", [&](Component& c) { return get_state(c, state); });
}
DREV_FMI int fmi3SetFMUState(Instance instance, void* state) {
  return guard(instance, "fmi3SetFMUState", [&](Component& c) { return set_state(c, state); });
}
DREV_FMI int fmi3FreeFMUState(Instance instance, void** state) {
  return guard(instance, "fmi3FreeFMUState", [&](Component& c) { return free_state(c, state); });
}
DREV_FMI int fmi3SerializedFMUStateSize(Instance instance, void* state, std::size_t* size) {
  return guard(instance, "fmi3SerializedFMUStateSize",
               [&](Component& c) { return state_size(c, state, size); });
}
DREV_FMI int fmi3SerializeFMUState(Instance instance, void* state, std::uint8_t* bytes, std::size_t size) {
  return guard(instance, "fmi3SerializeFMUState",
               [&](Component& c) { return write_state(c, state, bytes, size); });
}
DREV_FMI int fmi3DeserializeFMUState(Instance instance, const std::uint8_t* bytes, std::size_t size,
                                     void** state) {
  return guard(instance, "fmi3DeserializeFMUState",
               [&](Component& c) { return read_state(c, bytes, size, state); });
}
