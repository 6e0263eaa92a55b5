#include "app/fmi/library/instances.hpp"

#include <drev/core/error.hpp>

#include <mutex>
#include <new>
#include <string_view>

namespace drev::app {

namespace {

struct Registry {
  std::mutex mutex;
  std::map<void*, std::unique_ptr<Component>> components;
};

Registry& registry() {
  static Registry all;
  return all;
}

FmuState& known_state(Component& component, void* state) {
  const auto found = component.states.find(state);
  if (found == component.states.end()) throw FmuError("the pointer is of no state of this instance");
  return *found->second;
}

void keep(Component& component, FmuState state, void** pointer) {
  if (*pointer != nullptr) {
    known_state(component, *pointer) = std::move(state);
    return;
  }
  auto kept = std::make_unique<FmuState>(std::move(state));
  *pointer = kept.get();
  component.states.emplace(*pointer, std::move(kept));
}

void check_pointer(const void* pointer) {
  if (pointer == nullptr) throw FmuError("a pointer is null");
}

}  // namespace

Component* add_component(const std::string& resources, const std::string& token,
                         std::function<void(Status, const char*, const std::string&)> log) {
  try {
    auto component = std::make_unique<Component>();
    component->fmu = std::make_unique<FmuInstance>(resources);
    if (token != component->fmu->interface().token)
      throw FmuError("the token " + token + " is not that of this FMU, " + component->fmu->interface().token);
    component->log = log;
    Registry& all = registry();
    const std::lock_guard lock(all.mutex);
    Component* made = component.get();
    all.components.emplace(made, std::move(component));
    return made;
  } catch (const std::exception& error) {
    log(kError, "logStatusError", std::string("the FMU cannot be instantiated: ") + error.what());
  } catch (...) {
    log(kError, "logStatusError", "the FMU cannot be instantiated");
  }
  return nullptr;
}

Component* find_component(void* pointer) {
  Registry& all = registry();
  const std::lock_guard lock(all.mutex);
  const auto found = all.components.find(pointer);
  return found == all.components.end() ? nullptr : found->second.get();
}

void remove_component(void* pointer) {
  std::unique_ptr<Component> last;
  Registry& all = registry();
  const std::lock_guard lock(all.mutex);
  const auto found = all.components.find(pointer);
  if (found == all.components.end()) return;
  last = std::move(found->second);
  all.components.erase(found);
}

Status guard(void* pointer, const char* call, const std::function<Status(Component&)>& body) {
  Component* component = find_component(pointer);
  if (component == nullptr) return kError;
  std::string why = "failed";
  try {
    if (component->updating && std::string_view(call) != "fmi3GetFloat64")
      throw FmuError("inside a step only real values are to be had");
    return body(*component);
  } catch (const std::bad_alloc&) {
    why = "there is not enough memory";
  } catch (const std::exception& error) {
    why = error.what();
  } catch (...) {
  }
  component->log(kError, "logStatusError", std::string(call) + ": " + why);
  return kError;
}

Status warned(Component& component, const std::string& warning) {
  if (warning.empty()) return kOk;
  component.log(kWarning, "logStatusWarning", warning);
  return kWarning;
}

Status get_state(Component& component, void** state) {
  check_pointer(state);
  keep(component, component.fmu->state(), state);
  return kOk;
}

Status set_state(Component& component, void* state) {
  component.fmu->set_state(known_state(component, state));
  return kOk;
}

Status free_state(Component& component, void** state) {
  if (state == nullptr || *state == nullptr) return kOk;
  known_state(component, *state);
  component.states.erase(*state);
  *state = nullptr;
  return kOk;
}

Status state_size(Component& component, void* state, std::size_t* size) {
  check_pointer(size);
  *size = to_bytes(known_state(component, state), component.fmu->interface().token).size();
  return kOk;
}

Status write_state(Component& component, void* state, std::uint8_t* bytes, std::size_t size) {
  check_pointer(bytes);
  const std::vector<std::uint8_t> all =
      to_bytes(known_state(component, state), component.fmu->interface().token);
  if (size < all.size())
    throw FmuError("the state has " + std::to_string(all.size()) + " bytes, there is room for " +
                   std::to_string(size));
  std::copy(all.begin(), all.end(), bytes);
  return kOk;
}

Status read_state(Component& component, const std::uint8_t* bytes, std::size_t size, void** state) {
  check_pointer(bytes);
  check_pointer(state);
  keep(component, from_bytes(bytes, size, component.fmu->interface().token), state);
  return kOk;
}

Status derivative(Component& component, const ReferenceArray<double>& unknowns,
                  const ReferenceArray<const double>& knowns) {
  check_arrays(unknowns.references, unknowns.count, unknowns.values, unknowns.value_count);
  check_arrays(knowns.references, knowns.count, knowns.values, knowns.value_count);
  const std::vector<double> found = component.fmu->directional_derivative(
      {unknowns.references, unknowns.references + unknowns.count},
      {knowns.references, knowns.references + knowns.count}, {knowns.values, knowns.values + knowns.count});
  std::copy(found.begin(), found.end(), unknowns.values);
  return kOk;
}

void check_arrays(const void* references, std::size_t count, const void* values, std::size_t value_count) {
  if (count != value_count)
    throw FmuError(std::to_string(count) + " value references, but " + std::to_string(value_count) +
                   " values; every variable is a scalar");
  if (count > 0 && (references == nullptr || values == nullptr)) throw FmuError("a pointer is null");
}

}  // namespace drev::app
