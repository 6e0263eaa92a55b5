#include "app/fmi/inputs.hpp"

#include <drev/core/element.hpp>
#include <drev/core/system.hpp>

namespace drev::app {

namespace {

/// The speed input of a node; null if it has none.
const InputNode* speed_of(const std::vector<InputNode>& inputs, const std::string& node) {
  for (const InputNode& input : inputs)
    if (input.speed && input.node == node) return &input;
  return nullptr;
}

/// The model without the prescribed motions of nodes whose speed is an input.
Model without_motions(const Model& model, const std::vector<InputNode>& inputs) {
  Model all(model.name());
  std::vector<bool> internal(model.node_names().size(), false);
  for (const ElementInstance& instance : model.element_instances())
    for (const NodeId node : instance.internal) internal[idx(index(node))] = true;
  for (std::size_t i = 0; i < internal.size(); ++i)
    if (!internal[i]) all.add_node(model.node_names()[i], model.node_kinds()[i]);
  for (const ElementInstance& instance : model.element_instances()) {
    std::vector<NodeRef> nodes;
    for (const NodeRef& node : instance.nodes) nodes.emplace_back(model.name_of(node));
    all.add(instance.name, nodes, instance.element);
  }
  for (const auto& [node, motion] : model.references()) all.set_reference(model.name_of(node), motion);
  bool has_reference = !model.references().empty();
  for (const Model::Prescription& given : model.prescriptions()) {
    const std::string& node = model.name_of(given.node);
    const bool is_input = speed_of(inputs, node) != nullptr;
    if (given.omega && is_input && !has_reference) all.set_reference(node, constant_speed(*given.omega));
    if (given.omega) has_reference = true;
    if (is_input) continue;
    if (given.deviation)
      all.given_motion(node, *given.deviation);
    else if (given.omega)
      all.constant_speed(node, *given.omega);
    else
      all.hold(node);
  }
  for (const Model::Initial& initial : model.initials())
    if (!speed_of(inputs, model.name_of(initial.node)))
      all.set_initial(model.name_of(initial.node), initial.deviation, initial.rate);
  return all;
}

bool has_mass_coupling(const System& system, int prescribed) {
  const SparseMatrix& mass = system.coupling_zu().mass;
  if (prescribed >= mass.cols()) return false;
  for (SparseMatrix::InnerIterator entry(mass, prescribed); entry; ++entry)
    if (entry.value() != 0.0) return true;
  return false;
}

void check_inputs(const Model& model, const System& system, const std::vector<InputNode>& inputs) {
  std::vector<Finding> findings;
  const auto refuse = [&](const InputNode& input, const std::string& why) {
    findings.push_back({model.name(), input.speed ? "--speed" : "--torque", input.node, "", why});
  };
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const InputNode& input = inputs[i];
    for (std::size_t j = 0; j < i; ++j)
      if (inputs[j].node == input.node && bool(inputs[j].speed) == bool(input.speed))
        refuse(input, "is given twice");
    const std::vector<std::string>& names = system.node_names();
    if (std::find(names.begin(), names.end(), input.node) == names.end()) {
      refuse(input, "is none of the nodes" + did_you_mean(input.node, names));
      continue;
    }
    if (!input.speed) continue;
    bool prescribed = false;
    for (const Model::Prescription& given : model.prescriptions())
      prescribed = prescribed || model.name_of(given.node) == input.node;
    if (!prescribed) {
      refuse(input,
             "is free; a speed can be an input where the model prescribes the node's motion (hold, "
             "constant_speed, given)");
      continue;
    }
    for (int k = 0; k < system.prescribed_count(); ++k)
      if (system.node_names()[idx(system.prescribed_node(k))] == input.node && has_mass_coupling(system, k))
        refuse(input,
               "shares an inertia matrix with a free node, so that a jump of its speed would be an "
               "impulse; put a shaft_spring between them");
  }
  if (!findings.empty()) throw ModelError(std::move(findings));
}

}  // namespace

MotionPoint SpeedInput::at(double t, double ratio, const std::optional<Motion>& nominal) const {
  const double past = t - signal.t_0;
  MotionPoint point{deviation + (signal.value + 0.5 * signal.slope * past) * past, signal.at(t),
                    signal.slope};
  if (ratio == 0.0 || !nominal) return point;
  const MotionPoint now = nominal->at(t), then = nominal->at(signal.t_0);
  point.value -= ratio * (now.value - then.value);
  point.rate -= ratio * now.rate;
  point.acceleration -= ratio * now.acceleration;
  return point;
}

std::string input_element(const std::string& node) { return "input_" + node; }

Model with_inputs(const Model& model, const std::vector<InputNode>& inputs) {
  const System system = model.build();
  check_inputs(model, system, inputs);
  bool any_speed = false;
  for (const InputNode& input : inputs) any_speed = any_speed || input.speed;
  Model all = any_speed ? without_motions(model, inputs) : model;
  for (const InputNode& input : inputs) {
    if (!input.speed) {
      all.add(input_element(input.node), std::vector<NodeRef>{input.node},
              std::make_shared<const InputTorque>(input.torque));
      continue;
    }
    const std::optional<Motion> nominal = system.reference();
    const double ratio = system.ratio(system.node(input.node));
    all.given_motion(
        input.node,
        {.at = [speed = input.speed, nominal, ratio](double t) { return speed->at(t, ratio, nominal); },
         .piecewise_quadratic = ratio == 0.0 || !nominal || nominal->piecewise_quadratic});
  }
  return all;
}

void InputTorque::describe(int /*nodes*/, Terms& terms) const { terms.loads.push_back({0, this}); }

}  // namespace drev::app
