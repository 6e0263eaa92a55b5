#include <drev/core/control/sampled_controller.hpp>
#include <drev/core/element.hpp>
#include <drev/core/system.hpp>

#include "core/control/signal.hpp"

namespace drev {

SampledController::SampledController(double step, Hold hold, std::size_t outputs) : step_(step), hold_(hold) {
  for (std::size_t i = 0; i < outputs; ++i) held_.push_back(std::make_unique<Held>());
}

void SampledController::check(ParameterCheck& check) const { check.positive("step", step_, "s"); }

void SampledController::describe(int /*nodes*/, Terms& terms) const {
  for (std::size_t i = 0; i < held_.size(); ++i)
    terms.loads.push_back({static_cast<int>(i), held_[i].get(), i == 0 ? "" : std::to_string(i + 1)});
}

void SampledController::release() const {
  for (std::size_t i = 0; i < held_.size(); ++i) set(i, 0.0, 0.0, 0.0);
  taken_ = false;
}

void SampledController::set(std::size_t output, double t, double value, double slope) const {
  Held& held = *held_[output];
  held.t_0 = t;
  held.value = value;
  held.slope = slope;
}

std::vector<PlacedController> sampled_controllers(const System& system) {
  std::vector<PlacedController> found;
  for (const ElementInstance& instance : system.element_instances())
    if (const auto* controller = dynamic_cast<const SampledController*>(instance.element.get()))
      found.push_back({instance.name, controller});
  return found;
}

void check_controllers(const System& system) {
  std::vector<Finding> findings;
  for (const auto& [name, controller] : sampled_controllers(system)) try {
      find_signals(system, controller->inputs());
    } catch (const ModelError& error) {
      for (const Finding& finding : error.findings())
        findings.push_back(
            {system.name() + "/" + name, "inputs", finding.value, finding.unit, finding.range});
    }
  if (!findings.empty()) throw ModelError(std::move(findings));
}

std::optional<std::string> why_not_controllers(const System& system, const std::string& what) {
  const std::vector<PlacedController> found = sampled_controllers(system);
  if (found.empty()) return std::nullopt;
  return found.front().name + " is a controller that is sampled every " +
         to_text(found.front().controller->step()) + " s (" + std::string(found.front().controller->type()) +
         "): " + what + " does not take it; run the model in time, or leave it out";
}

void refuse_controllers(const System& system, const std::string& what) {
  if (const auto why = why_not_controllers(system, what)) throw SolverError(system.name() + ": " + *why);
}

}  // namespace drev
