#include "app/model_file/writing/export.hpp"

#include <drev/app/model_file/element_table.hpp>
#include <drev/elements/applied_torque.hpp>
#include <drev/elements/friction/dry_friction.hpp>
#include <drev/elements/machines/torque_function.hpp>
#include <drev/elements/modal_damping.hpp>

#include <cmath>
#include <map>

#include "app/model_file/document.hpp"
#include "app/model_file/node_fields.hpp"
#include "app/model_file/strength_section.hpp"
#include "app/model_file/writing/field_writer.hpp"

namespace drev::app {

namespace {

class CaseWriter {
 public:
  CaseWriter(const ModelCase& model_case, const RunOptions& options)
      : model_case_(model_case), model_(model_case.model), options_(options.values) {}

  std::string text(const ModelEntry& entry, const Parameters& parameters) {
    const std::string nodes = write_nodes(), elements = write_elements();
    std::string head = "# Written by drev export " + entry.name + settings_of(parameters) + ".\n";
    head += "format = " + std::to_string(kFormat) + "\nname = " + toml_text(model_.name()) + "\n";
    if (!entry.summary.empty()) head += "summary = " + toml_text(entry.summary) + "\n";
    if (!model_case_.note.empty()) head += "note = " + toml_text(model_case_.note) + "\n";
    std::string all =
        head + "\n" + nodes + "\n" + store_.text() + elements + "\n" + write_run() + write_strength();
    if (!findings_.empty()) throw ModelError(std::move(findings_));
    return all;
  }

 private:
  static std::string settings_of(const Parameters& parameters) {
    std::string all;
    for (std::size_t i = 0; i < parameters.known().size(); ++i)
      if (parameters.values()[i] != parameters.known()[i].default_text)
        all += (all.empty() ? " --set " : " ") + parameters.known()[i].name + "=" + parameters.values()[i];
    return all;
  }

  void refuse(const std::string& name, const std::string& what) {
    findings_.push_back({model_.name() + (name.empty() ? "" : "/" + name), "", "", "",
                         "cannot be written as a file: " + what});
  }
  const std::string& checked(const std::string& name) {
    if (name.find('{') != std::string::npos) refuse(name, "its name has a '{'");
    return name;
  }

  std::string write_nodes() {
    std::map<std::string, NodeParams> params;
    for (const Model::Prescription& p : model_.prescriptions()) {
      NodeParams& node = params[model_.name_of(p.node)];
      if (const auto* given = p.deviation ? p.deviation->at.target<NodeParams::Given>() : nullptr) {
        node.given = *given;
        node.has_given = true;
      } else if (p.deviation)
        refuse(model_.name_of(p.node), "its given motion is a function of C++");
      else if (p.omega)
        node.constant_speed = *p.omega;
      else
        node.hold = true;
    }
    for (const auto& [ref, motion] : model_.references()) take_reference(model_.name_of(ref), motion, params);
    for (const Model::Initial& initial : model_.initials()) {
      NodeParams& node = params[model_.name_of(initial.node)];
      node.initial_value = initial.deviation;
      node.initial_rate = initial.rate;
    }
    std::vector<bool> internal(model_.node_names().size(), false);
    for (const ElementInstance& placement : model_.element_instances())
      for (const NodeId node : placement.internal) internal[idx(index(node))] = true;
    std::string text = "[nodes]\n";
    for (std::size_t i = 0; i < internal.size(); ++i) {
      if (internal[i]) continue;
      const std::string& name = checked(model_.node_names()[i]);
      const NodeKind kind = model_.node_kinds()[i];
      kinds_[name] = kind;
      NodeParams node = params[name], plain;
      node.kind = static_cast<int>(kind);
      const FieldKeys defaults(kind, [&](Fields& f) { list_fields(f, plain); });
      FieldWriter writer(kind, defaults, store_, name);
      list_fields(writer, node);
      text += toml_key(name) + " = " + writer.inline_table() + "\n";
    }
    return text;
  }

  /// Constant speed and run-up are told from their values: both are polynomials between their breakpoints.
  void take_reference(const std::string& name, const Motion& motion,
                      std::map<std::string, NodeParams>& params) {
    NodeParams& node = params[name];
    const MotionPoint start = motion.at(0.0);
    if (motion.piecewise_quadratic && motion.breakpoints.empty() && start.acceleration == 0.0) {
      node.nominal_speed = start.rate;
      node.nominal_angle = start.value;
      return;
    }
    if (motion.piecewise_quadratic && motion.breakpoints.size() == 2) {
      const double t_0 = motion.breakpoints[0], t_1 = motion.breakpoints[1];
      node.run_up = {motion.at(t_0 - 1.0).rate, motion.at(t_1).rate, t_0, t_1};
      node.has_run_up = true;
      const Motion same = run_up(node.run_up.speed_0, node.run_up.speed_1, t_0, t_1);
      bool equal = true;
      for (const double t : {t_0 - 1.0, t_0, 0.5 * (t_0 + t_1), t_1, t_1 + 1.0})
        equal = equal && same.at(t).value == motion.at(t).value && same.at(t).rate == motion.at(t).rate;
      if (equal) return;
    }
    refuse(name, "its nominal motion is a function of C++");
  }

  std::string write_elements() {
    std::string text = "[elements]\n";
    for (const ElementInstance& placement : model_.element_instances()) {
      const std::string& name = checked(placement.name);
      std::vector<std::string> nodes;  // modal damping is over the whole train
      if (dynamic_cast<const ModalDamping*>(placement.element.get()) == nullptr)
        for (const NodeRef& ref : placement.nodes) nodes.push_back(checked(model_.name_of(ref)));
      const NodeKind kind = nodes.empty() ? NodeKind::rotational : kinds_[nodes.front()];
      bool written = false;
      for (const ElementType& type : element_types()) {
        written = type.list(*placement.element, [&](const ListFields& list) {
          FieldKeys defaults(kind);
          type.make([&](const ListFields& plain) { plain(defaults); });
          FieldWriter writer(kind, defaults, store_, name);
          writer.add("type", toml_text(type.name));
          if (nodes.size() == 1) writer.add("node", toml_text(nodes.front()));
          if (nodes.size() > 1) writer.add("nodes", toml_texts(nodes));
          list(writer);
          text += toml_key(name) + " = " + writer.inline_table() + "\n";
        });
        if (written) break;
      }
      if (!written) refuse(name, "it is an element of C++ whose keys are not registered");
      if (const auto* torque = dynamic_cast<const AppliedTorque*>(placement.element.get()))
        if (torque->params().torque) refuse(name, "its torque is a function of C++");
      if (const auto* torque = dynamic_cast<const TorqueFunction*>(placement.element.get()))
        if (torque->params().torque) refuse(name, "its torque is a function of C++");
      if (const auto* friction = dynamic_cast<const DryFriction*>(placement.element.get()))
        if (const auto& g = friction->params().engagement_formula; g && g->params().function)
          refuse(name, "its engagement is a function of C++");
    }
    return text;
  }

  std::string write_run() {
    std::string text = "[run]\n";
    const auto add = [&](const char* key, const std::string& value) {
      text += std::string(key) + " = " + value + "\n";
    };
    add("duration_s", toml_number(model_case_.duration));
    add("step_s", toml_number(model_case_.default_step));
    const auto add_option = [&](const std::string& key, bool text, const std::string& unit = "") {
      if (const auto given = options_.find("--" + key); given != options_.end())
        add((key + unit).c_str(), text ? toml_text(given->second) : given->second);
    };
    add_option("method", true);
    add_option("tolerance", false);
    add_option("accuracy", false);
    if (!model_case_.deflection.empty()) add("deflection", toml_text(model_case_.deflection));
    add("torques", toml_texts(model_case_.torques));
    if (model_case_.static_turn != 0.0) add("static_turn_rad", toml_number(model_case_.static_turn));
    if (model_case_.start != Start::rest) add("start", toml_text(to_text(model_case_.start)));
    if (const auto& settle = model_case_.settle; settle && settle->time)
      add("settle_s", toml_number(*settle->time));
    else if (settle)
      add("settle", toml_text("auto"));
    add("record", toml_texts(model_case_.channels));
    add_option("every", false, "_s");
    return text;
  }

  /// [class], without its misfire case: the file has no parameters.
  std::string write_strength() {
    if (!model_case_.strength) return {};
    const Strength& strength = *model_case_.strength;
    std::string text = "\n[class]\n";
    if (!std::isnan(strength.rated_speed))
      text += "rated_speed_rad_per_s = " + toml_number(strength.rated_speed) + "\n";
    text += "[class.sections]\n";
    for (SectionStrength section : strength.sections) {
      FieldKeys defaults(NodeKind::rotational, [](Fields& f) {
        SectionStrength plain;
        list_section(f, plain);
      });
      FieldWriter writer(NodeKind::rotational, defaults, store_, section.element);
      list_section(writer, section);
      text += toml_key(section.element) + " = " + writer.inline_table() + "\n";
    }
    return text;
  }

  const ModelCase& model_case_;
  const Model& model_;
  const std::map<std::string, std::string>& options_;
  TableStore store_;
  std::map<std::string, NodeKind> kinds_;
  std::vector<Finding> findings_;
};

}  // namespace

std::string left_out_of(const ModelCase& model_case) {
  if (!model_case.strength || model_case.strength->misfire.empty()) return {};
  std::string set;
  for (const auto& [name, value] : model_case.strength->misfire)
    set += (set.empty() ? "" : ", ") + name + " = " + toml_number(value);
  return "class.misfire, { " + set +
         " }: a written file has no parameters, so that it is judged without a cylinder that misfires";
}

std::string export_model(const ModelEntry& entry, const Parameters& parameters, const ModelCase& model_case,
                         const RunOptions& options) {
  return CaseWriter(model_case, options).text(entry, parameters);
}

}  // namespace drev::app
