#pragma once
/// The model of an FmuInstance, ready for computation: its system with the inputs, and its outputs.
#include <drev/core/assembler.hpp>
#include <drev/core/control/sampled_controller.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>

#include <cmath>

#include "app/fmi/fmu_instance.hpp"
#include "core/control/signal.hpp"

namespace drev::app {

/// A model with values of its parameters, ready for computation.
struct FmuInstance::Built {
  Built(ModelCase given, const FmuInterface& interface)
      : torques(interface.torques.size()),
        speeds(interface.speeds.size()),
        model_case(std::move(given)),
        original(model_case.model.build()),
        system(with_inputs(model_case.model, nodes(interface)).build()),
        assembler(system) {
    if (const auto why = why_not_exact(system, false))
      throw ModelError({{system.name(), "", "", "",
                         "cannot be an FMU, which is propagated exactly whatever its method: " + *why}});
    refuse_controllers(system, "an FMU");
    outputs = find_signals(system, interface.outputs);
    assembler.set_time(0.0);
    for (const std::string& name : interface.speeds) {
      Assembler at_start(original);
      at_start.set_time(0.0);
      const int node = original.node(name);
      const MotionPoint q = at_start.node_motion(node, State::initial(original));
      start_speeds.push_back(q.rate + original.ratio(node) * at_start.nominal().rate);
      start_deviations.push_back(q.value);
    }
  }

  std::vector<InputNode> nodes(const FmuInterface& interface) {
    std::vector<InputNode> all;
    for (std::size_t i = 0; i < torques.size(); ++i) {
      torques[i] = std::make_shared<InputSignal>();
      all.push_back({interface.torques[i], torques[i], {}});
    }
    for (std::size_t i = 0; i < speeds.size(); ++i) {
      speeds[i] = std::make_shared<SpeedInput>();
      all.push_back({interface.speeds[i], {}, speeds[i]});
    }
    return all;
  }

  std::vector<NodeKind> input_kinds(const FmuInterface& interface) const {
    std::vector<NodeKind> all;
    for (const auto* names : {&interface.torques, &interface.speeds})
      for (const std::string& name : *names) all.push_back(system.node_kind(system.node(name)));
    return all;
  }

  std::vector<std::shared_ptr<InputSignal>> torques;
  std::vector<std::shared_ptr<SpeedInput>> speeds;
  ModelCase model_case;
  System original;  // system without the inputs
  System system;
  Assembler assembler;
  std::vector<Signal> outputs;
  std::vector<double> start_speeds, start_deviations;
  double assembled = std::nan("");
};

}  // namespace drev::app
