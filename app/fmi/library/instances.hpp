#pragma once
/// The part that both versions of FMI share: the existing instances, and errors, which do not pass the
/// interface.
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "app/fmi/fmu_instance.hpp"

/// Exported by the library; everything else is hidden (fmu.map).
#define DREV_FMI extern "C" __attribute__((visibility("default")))

namespace drev::app {

/// The status codes of both versions.
enum Status : int { kOk = 0, kWarning = 1, kDiscard = 2, kError = 3, kFatal = 4 };

/// A component that an importer holds a pointer to.
struct Component {
  std::unique_ptr<FmuInstance> fmu;
  std::function<void(Status, const char* category, const std::string&)> log;
  std::vector<std::string> texts;  ///< storage of the strings handed out, valid until the next such call
  std::map<void*, std::unique_ptr<FmuState>> states;
  // FMI 3:
  bool uses_events = false, in_event = false;  ///< event mode
  bool may_end_early = false;
  /// Intermediate values: called with times inside a step and its end [s]; empty: not wanted.
  std::function<void(double t)> update = {};
  bool updating = false;  ///< true: the importer is in that call
};

/// Makes a component from a folder of resources; null, with a message, if that fails. token: token of the
/// importer.
Component* add_component(const std::string& resources, const std::string& token,
                         std::function<void(Status, const char*, const std::string&)> log);
/// The component of a pointer; null if it does not exist.
Component* find_component(void* pointer);
void remove_component(void* pointer);

/// Executes the call. An exception is logged under the call's name and returned as an error; so is an unknown
/// component.
Status guard(void* pointer, const char* call, const std::function<Status(Component&)>& body);

/// kOk without a warning; else logs it.
Status warned(Component& component, const std::string& warning);

/// Getting and setting of values and of states, which are the same in both versions.
Status get_state(Component& component, void** state);
Status set_state(Component& component, void* state);
Status free_state(Component& component, void** state);
Status state_size(Component& component, void* state, std::size_t* size);
Status write_state(Component& component, void* state, std::uint8_t* bytes, std::size_t size);
Status read_state(Component& component, const std::uint8_t* bytes, std::size_t size, void** state);
/// Value references of outputs with their sensitivities, and of inputs with their seeds.
template <class Value>
struct ReferenceArray {
  const std::uint32_t* references;
  std::size_t count;
  Value* values;
  std::size_t value_count;
};
Status derivative(Component& component, const ReferenceArray<double>& unknowns,
                  const ReferenceArray<const double>& knowns);
/// Throws FmuError if one of the arrays is missing or the sizes differ.
void check_arrays(const void* references, std::size_t count, const void* values, std::size_t value_count);

}  // namespace drev::app
