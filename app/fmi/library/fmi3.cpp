// The functions of FMI 3.0 for co-simulation, declared from the standard's text (fmi-standard.org, version 3.0).
#include <algorithm>

#include "app/fmi/library/instances.hpp"

namespace {

using namespace drev::app;
using Instance = void*;
using Reference = std::uint32_t;
using Logger = void (*)(void* environment, int status, const char* category, const char* message);

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
                                              bool /*visible*/, bool /*logging*/, bool event_mode,
                                              bool /*early*/, const Reference* /*intermediate*/,
                                              std::size_t intermediate_count, void* environment,
                                              Logger logger, void* /*update*/) {
  (void)name;
  const auto log = [environment, logger](Status status, const char* category, const std::string& message) {
    if (logger != nullptr) logger(environment, status, category, message.c_str());
  };
  if (event_mode || intermediate_count > 0) {
    log(kError, "logStatusError",
        "the FMU has neither event mode nor intermediate variables: contact changes are located inside a "
        "step");
    return nullptr;
  }
  if (resources == nullptr) {
    log(kError, "logStatusError", "the FMU needs the path of its resources");
    return nullptr;
  }
  return add_component(resources, text_or_empty(token), log);
}

DREV_FMI void fmi3FreeInstance(Instance instance) { remove_component(instance); }

DREV_FMI int fmi3EnterInitializationMode(Instance instance, bool tolerance_given, double tolerance,
                                         double t_start, bool stop_given, double t_stop) {
  return guard(instance, "fmi3EnterInitializationMode", [&](Component& c) {
    c.fmu->enter_initialization(t_start, stop_given ? t_stop : t_start, tolerance_given ? tolerance : 0.0);
    return kOk;
  });
}

DREV_FMI int fmi3ExitInitializationMode(Instance instance) {
  return guard(instance, "fmi3ExitInitializationMode", [](Component& c) {
    c.fmu->exit_initialization();
    return kOk;
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
    return kOk;
  });
}

DREV_FMI int fmi3DoStep(Instance instance, double t, double h, bool /*no_set_before*/, bool* event,
                        bool* terminate, bool* early, double* last) {
  return guard(instance, "fmi3DoStep", [&](Component& c) {
    const std::string warning = c.fmu->step(t, h);
    if (event != nullptr) *event = false;
    if (terminate != nullptr) *terminate = false;
    if (early != nullptr) *early = false;
    if (last != nullptr) *last = c.fmu->state().state.t;
    if (warning.empty()) return kOk;
    c.log(kWarning, "logStatusWarning", warning);
    return kWarning;
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
