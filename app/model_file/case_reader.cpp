#include "app/model_file/case_reader.hpp"

#include <drev/app/model_file/element_table.hpp>
#include <drev/core/control/sampled_controller.hpp>
#include <drev/core/system.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/inertia.hpp>
#include <drev/models/modal_damping.hpp>

#include <algorithm>
#include <cmath>

#include "app/model_file/field_reader.hpp"
#include "app/model_file/key_finder.hpp"
#include "app/model_file/node_fields.hpp"
#include "app/model_file/part.hpp"
#include "app/model_file/refused_element.hpp"
#include "app/model_file/run_section.hpp"
#include "app/model_file/strength_section.hpp"

namespace drev::app {

namespace {

constexpr int kMostRepeats = 10000;
constexpr std::size_t kMostParts = 300000;  // nodes and elements
// Names are compared with so many at most: suggestions take time.
constexpr std::size_t kMostCompared = 2000;

const std::string kStandIn = "refused part ";  // begins the names of those that have none of their own

void refuse_entry(ReadContext& context, const Position& at, const std::string& where,
                  const std::string& sentence) {
  context.findings.push_back(fault_at(at, where, sentence));
}

}  // namespace

void BlockEntries::for_each(const Block& block, const Value& table, const Use& use) {
  int first = 1, count = 1;
  std::string counter = "i";
  const std::map<std::string, double> outside = context_.scope.numbers;
  if (block.repeat != nullptr) {
    // What is wrong with them is said once.
    const std::size_t before = context_.findings.size();
    const bool said = !seen_.insert(&block).second;
    const Entry* named = block.repeat->find("counter");
    if (named != nullptr) counter = named->value.text;
    if (counter.empty() || counter == "pi" || outside.contains(counter) ||
        context_.scope.texts.contains(counter))
      refuse_entry(context_, named != nullptr ? named->value.at : block.repeat->at, "repeat.counter",
                   named != nullptr
                       ? "must be a name that is no parameter and not pi, not " + kind_name(named->value)
                       : "must be given: without it i counts, which is a parameter here");
    if (const Entry* e = block.repeat->find("first"))
      first = read_whole(e->value, -kMostRepeats, kMostRepeats, "repeat.first", context_).value_or(1);
    if (const Entry* e = block.repeat->find("count"))
      count = read_whole(e->value, 0, kMostRepeats, "repeat.count", context_).value_or(1);
    if (context_.findings.size() > before) all_read_ = false;
    if (said) context_.findings.resize(before);
  }
  for (int i = first; i < first + count; ++i) {
    if (block.repeat != nullptr) context_.scope.numbers[counter] = i;
    for (const Entry& entry : table.entries) {
      if (too_many_faults()) {
        all_read_ = false;
        break;
      }
      if (read_ >= kMostParts) {
        if (!too_many_)
          refuse_entry(context_, entry.at, entry.key,
                       "a model file may have " + std::to_string(kMostParts) + " nodes and elements at most");
        too_many_ = true;
        all_read_ = false;
        break;
      }
      try {
        const Entry* when = entry.value.is(Value::Kind::table) ? entry.value.find("when") : nullptr;
        if (when == nullptr || is_wanted(*when, entry.key))
          ++read_, use(entry, expand(entry.key, context_.scope));
      } catch (const ExpressionError& error) {
        refuse_entry(context_, entry.at, entry.key, error.sentence);
        all_read_ = false;
      }
    }
  }
  context_.scope.numbers = outside;
}

/// Whether the condition of a node or element holds. One that is wrong is a finding, and holds.
bool BlockEntries::is_wanted(const Entry& when, const std::string& name) {
  const Value& value = when.value;
  if (value.is(Value::Kind::boolean)) return value.flag;
  if (!value.is(Value::Kind::text)) {
    refuse_entry(context_, value.at, name + ".when",
                 "must be a condition in quotes, true or false, not " + kind_name(value));
    return true;
  }
  try {
    return holds(value.text, context_.scope);
  } catch (const ExpressionError& error) {
    refuse_entry(context_, value.at, name + ".when", error.sentence);
    return true;
  }
}

/// Then the rest of the nodes and elements is not read.
bool BlockEntries::too_many_faults() {
  if (context_.findings.size() <= kMostFaults) return false;
  remove_repeated(context_.findings);
  return context_.findings.size() > kMostFaults;
}

namespace {

class CaseReader {
 public:
  CaseReader(const Document& document, ReadContext& context)
      : doc_(document), context_(context), entries_(context), model_(document.name) {}

  /// Nothing, and findings, if something is wrong.
  std::optional<ModelCase> read(const RunSection& run) {
    for (const Block& block : doc_.blocks)
      if (block.nodes != nullptr)
        entries_.for_each(block, *block.nodes,
                          [this](const Entry& entry, const std::string& name) { add_node(entry, name); });
    for (const Block& block : doc_.blocks)
      if (block.elements != nullptr)
        entries_.for_each(block, *block.elements,
                          [this](const Entry& entry, const std::string& name) { add_element(entry, name); });
    // Too little is known of the train: nodes and elements that seem to be missing may be in what was not read.
    const bool all_read = entries_.all_read() && doc_.whole;
    if (!all_read && nodes_.empty()) return {};
    if (!all_read) stand_in({"?"});
    check_given_motions();
    std::optional<System> system = build_whole();
    ModelCase model_case{.model = model_, .note = doc_.note};
    // Channels and sections are looked up in what is sound.
    if (!system && all_read) system = build_sound(model_case.model);
    if (!system) return {};
    run.complete(model_case, *system, left_out_, context_);
    if (doc_.strength != nullptr) read_strength(*doc_.strength, *system, model_case, left_out_, context_);
    return model_case;
  }

 private:
  void refuse(const Position& at, const std::string& where, const std::string& sentence) {
    context_.findings.push_back(fault_at(at, where, sentence));
  }

  bool is_new(const std::map<std::string, Part>& parts, const Entry& entry, const std::string& where,
              const std::string& name) {
    const auto same = parts.find(name);
    if (same == parts.end()) return true;
    const bool files = entry.at.file && same->second.at.file && *entry.at.file != *same->second.at.file;
    refuse(entry.at, where,
           "the name " + name + " is used twice; first in " + same->second.at.text() +
               (files ? "; names that a [[repeat]] makes, or files beside each other have, are not laid over "
                        "each other"
                      : ""));
    return false;
  }

  void add_node(const Entry& entry, const std::string& name) {
    const std::string where = "nodes." + name;
    if (!is_new(nodes_, entry, where, name)) return stand_in({name});
    Part& part = nodes_[name];
    part.at = entry.at;
    if (!entry.value.is(Value::Kind::table)) {
      model_.add_node(name, part.kind);
      stand_in({name});
      return refuse(entry.value.at, where,
                    "must be a table, {} for a plain node, not " + kind_name(entry.value));
    }
    if (const Entry* kind = entry.value.find("kind"))
      if (kind->value.is(Value::Kind::text) && kind->value.text == "translational")
        part.kind = NodeKind::translational;
    model_.add_node(name, part.kind);
    NodeParams p;
    if (read_fields(
            entry.value, where, part.kind, {"when"}, [&](Fields& f) { list_fields(f, p); }, context_,
            &part.fields))
      add_motion(name, p, part);
    else
      stand_in({name});
  }

  void add_motion(const std::string& name, const NodeParams& p, const Part& part) {
    if (p.hold) model_.hold(name);
    if (!std::isnan(p.constant_speed)) model_.constant_speed(name, p.constant_speed);
    if (p.has_given) model_.given_motion(name, {.at = p.given, .frequency = p.given.frequency});
    try {
      if (!std::isnan(p.nominal_speed))
        model_.set_reference(name, constant_speed(p.nominal_speed, p.nominal_angle));
      if (p.has_run_up)
        model_.set_reference(name,
                             run_up(p.run_up.speed_0, p.run_up.speed_1, p.run_up.time_0, p.run_up.time_1));
    } catch (const ModelError& error) {
      for (const Finding& finding : error.findings())
        context_.findings.push_back(placed(finding, part, "nodes." + name));
      stand_in({name});
    }
    if (!std::isnan(p.initial_value) || !std::isnan(p.initial_rate))
      model_.set_initial(name, std::isnan(p.initial_value) ? 0.0 : p.initial_value,
                         std::isnan(p.initial_rate) ? 0.0 : p.initial_rate);
  }

  void add_element(const Entry& entry, const std::string& name) {
    const std::string where = "elements." + name;
    const Value& table = entry.value;
    Part part{entry.at};
    std::vector<std::string> nodes;
    bool nodes_read = false;
    if (table.is(Value::Kind::table)) nodes = nodes_of(table, where, part, nodes_read);
    const std::vector<NodeRef> at(nodes.begin(), nodes.end());
    if (!is_new(elements_, entry, where, name)) return stand_in(at);
    Part& kept = elements_[name] = part;
    std::shared_ptr<const Element> element;
    bool right = false;
    const ElementType* type = type_of(table, where);
    if (type != nullptr) try {
        element = type->make([&](const ListFields& list) {
          right = read_fields(table, where, kept.kind, {"type", "node", "nodes", "when"}, list, context_,
                              &kept.fields);
        });
        for (const char* key : {"node", "nodes"})
          if (const Entry* e = table.find(key)) kept.fields[key] = {e->value.at};
      } catch (const ModelError& error) {
        for (const Finding& finding : error.findings())
          context_.findings.push_back(placed(finding, kept, where));
      }
    const auto* modal = dynamic_cast<const ModalDamping*>(element.get());
    if (modal != nullptr && !nodes.empty())
      refuse(table.at, where, "takes no node: it damps the whole train");
    if (modal != nullptr) {
      if (right)
        modal_damping_.emplace_back(name, modal->params());  // once the train is whole
      else
        left_out_.elements.insert(name);
    } else if (right && nodes_read) {
      model_.add(name, at, element);
    } else {
      left_out_.elements.insert(name);
      // Where its nodes are not known, any may be its.
      if (!nodes_read) stand_in({"?"});
      model_.add(name, at, std::make_shared<const RefusedElement>(element, right, nodes_read));
    }
  }

  /// Null, and a finding, where there is none.
  const ElementType* type_of(const Value& table, const std::string& where) {
    const Entry* named = nullptr;
    if (!table.is(Value::Kind::table))
      refuse(table.at, where, "must be a table, { type = ... }, not " + kind_name(table));
    else if ((named = table.find("type")) == nullptr)
      refuse(table.at, where, "lacks type: " + list_of(element_type_names()));
    if (named == nullptr) return nullptr;
    const ElementType* type =
        named->value.is(Value::Kind::text) ? find_element_type(named->value.text) : nullptr;
    if (type == nullptr) {
      const std::string hint = did_you_mean(named->value.text, element_type_names());
      refuse(named->value.at, where + ".type",
             "is " + kind_name(named->value) + ", which is no element" +
                 (hint.empty() ? "; there are " + list_of(element_type_names()) : hint));
    }
    return type;
  }

  /// Names of an element's nodes, which are looked up; sets the kind of the part. `all_read`: whether these are the
  /// nodes that the file says, all of them.
  std::vector<std::string> nodes_of(const Value& table, const std::string& where, Part& part,
                                    bool& all_read) {
    const Entry *one = table.find("node"), *several = table.find("nodes");
    if (one != nullptr && several != nullptr)
      refuse(several->at, where + ".nodes", "is given together with node");
    all_read = one == nullptr || several == nullptr;
    if (one == nullptr && several == nullptr) return {};
    const Entry& given = one != nullptr ? *one : *several;
    std::vector<std::string> names;
    bool kind_known = false;
    const auto look_up = [&](const Value& value) {
      const std::optional<std::string> name = read_text(value, where + "." + given.key, context_);
      if (!name) {
        all_read = false;
        return;
      }
      names.push_back(*name);
      const auto node = nodes_.find(*name);
      if (node == nodes_.end()) {
        if (known_nodes_.size() != nodes_.size()) {
          known_nodes_.clear();
          for (const auto& [known, place] : nodes_) known_nodes_.push_back(known);
        }
        refuse(value.at, where + "." + given.key,
               "\"" + *name + "\" is none of the nodes" +
                   (nodes_.size() > kMostCompared ? "" : did_you_mean(*name, known_nodes_)));
      } else if (!kind_known) {
        part.kind = node->second.kind;
        kind_known = true;
      }
    };
    if (given.value.is(Value::Kind::array))
      for (const Value& item : given.value.items) look_up(item);
    else
      look_up(given.value);
    if (!kind_known && !nodes_.empty() && std::all_of(nodes_.begin(), nodes_.end(), [](const auto& n) {
          return n.second.kind == NodeKind::translational;
        }))
      part.kind = NodeKind::translational;
    return names;
  }

  /// Something that was refused has to do with these nodes.
  void stand_in(const std::vector<NodeRef>& nodes) {
    model_.add(kStandIn + std::to_string(++stand_ins_), nodes,
               std::make_shared<const RefusedElement>(nullptr, false, false));
  }

  /// A node whose motion is given, and that no element is at, has no effect unless it is the reference shaft: its name is
  /// mistaken.
  void check_given_motions() {
    std::set<std::string> used;
    for (const ElementInstance& instance : model_.element_instances())
      for (const NodeRef& node : instance.nodes) used.insert(model_.name_of(node));
    for (const auto& [node, motion] : model_.references()) used.insert(model_.name_of(node));
    if (used.contains("?")) return;
    for (const Model::Prescription& given : model_.prescriptions())
      if (const std::string& name = model_.name_of(given.node); !given.omega && !used.contains(name))
        refuse(nodes_.at(name).at, "nodes." + name,
               std::string(given.deviation ? "has a given motion" : "is held") +
                   " without effect: no element is at this node");
  }

  /// Nothing, and findings, where something is wrong with the train.
  std::optional<System> build_whole() {
    Model whole = model_;
    for (const auto& [name, params] : modal_damping_) try {
        add_modal_damping(whole, name, params);
      } catch (const ModelError& error) {
        left_out_.elements.insert(name);
        take_findings(error);
      }
    try {
      System system = whole.build();
      model_ = std::move(whole);
      check_controllers(system);
      return system;
    } catch (const ModelError& error) {
      take_findings(error);
      return {};
    }
  }

  /// The elements that nothing has been said of, with an inertia at each node: its channels are channels of the whole
  /// train. What keeps even these from being built leaves more out.
  std::optional<System> build_sound(Model& sound) {
    constexpr int kTries = 3;
    for (int k = 0; k < kTries; ++k) {
      sound = Model(doc_.name);
      int inertias = 0;
      for (const auto& [name, part] : nodes_) {
        sound.add_node(name, part.kind);
        sound.add(kStandIn + std::to_string(++inertias), {name},
                  std::make_shared<const Inertia>(Inertia::Params{1.0}));
      }
      for (const ElementInstance& placement : model_.element_instances())
        if (!left_out_.elements.contains(placement.name) && !placement.name.starts_with(kStandIn))
          sound.add(placement.name, placement.nodes, placement.element);
      try {
        return sound.build();
      } catch (const ModelError& error) {
        const std::size_t before = left_out_.elements.size();
        leave_out(error);
        if (left_out_.elements.size() == before) break;
      }
    }
    return {};
  }

  std::string name_in(const Finding& finding) const {
    const std::string prefix = doc_.name + "/";
    return finding.place.starts_with(prefix) ? finding.place.substr(prefix.size()) : finding.value;
  }

  void leave_out(const ModelError& error) {
    for (const Finding& finding : error.findings())
      if (const std::string name = name_in(finding); elements_.contains(name))
        left_out_.elements.insert(name);
  }

  /// What has not been said when the file was read: of stand-ins, of nodes that are none, of names with control characters.
  void take_findings(const ModelError& error) {
    std::vector<Finding> fresh;
    for (const Finding& finding : error.findings()) {
      const bool no_node = finding.parameter.starts_with("node ") && !nodes_.contains(finding.value);
      if (finding.parameter != RefusedElement::kRefused && !name_in(finding).starts_with(kStandIn) &&
          !no_node && !has_control_characters(finding.value))
        fresh.push_back(finding);
    }
    leave_out(error);
    if (fresh.empty()) return;
    for (Finding& finding : placed(ModelError(std::move(fresh)), doc_.name, doc_.at, nodes_, elements_))
      context_.findings.push_back(std::move(finding));
  }

  const Document& doc_;
  ReadContext& context_;
  BlockEntries entries_;
  Model model_;
  std::map<std::string, Part> nodes_, elements_;
  std::vector<std::string> known_nodes_;
  std::vector<std::pair<std::string, ModalDamping::Params>> modal_damping_;
  LeftOut left_out_;
  int stand_ins_ = 0;
};

}  // namespace

ReadContext context_of(const Document& document, const Parameters& parameters) {
  ReadContext context;
  for (const Parameter& parameter : parameters.known())
    if (parameter.kind == Parameter::Kind::choice)
      context.scope.texts[parameter.name] = parameters.text(parameter.name);
    else
      context.scope.numbers[parameter.name] = parameters.number(parameter.name);
  context.scope.lists = document.lists;
  context.tables = document.tables;
  return context;
}

FileCase read_case(const Document& document, const Parameters& parameters, const std::string& run,
                   bool options_only) {
  ReadContext context = context_of(document, parameters);
  FileCase result;
  const RunSection section(document, run, context);
  result.options = section.options();
  if (!options_only) result.model_case = CaseReader(document, context).read(section);
  if (result.model_case) {
    for (const Value& root : document.roots) result.model_case->files.push_back(*root.at.file);
    for (const auto& [path, table] : context.csv) result.model_case->files.push_back(path);
    result.model_case->files.insert(result.model_case->files.end(), context.files.begin(),
                                    context.files.end());
  }
  limit_findings(context.findings, document.at);
  if (!context.findings.empty()) result.model_case.reset();
  result.findings = std::move(context.findings);
  return result;
}

namespace {

/// Of one table, [run] or that of a run.
void set_parameters(const Document& document, const Value& table, const std::string& where,
                    std::vector<Parameter>& parameters, std::vector<Finding>& findings) {
  const Entry* given = table.find("parameters");
  if (given == nullptr) return;
  if (!given->value.is(Value::Kind::table)) {
    findings.push_back(fault_at(given->value.at, where, "must be a table, { name = value }"));
    return;
  }
  for (const Entry& entry : given->value.entries) {
    std::vector<std::string> names;
    for (const Parameter& s : parameters) names.push_back(s.name);
    const auto found = std::find(names.begin(), names.end(), entry.key);
    if (found == names.end()) {
      findings.push_back(fault_at(entry.at, where + "." + entry.key,
                                  "is none of [parameters]" + did_you_mean(entry.key, names)));
      continue;
    }
    Parameter& parameter = parameters[static_cast<std::size_t>(found - names.begin())];
    Parameters probe(document.name, {parameter});
    const bool text = parameter.kind == Parameter::Kind::choice && entry.value.is(Value::Kind::text);
    const std::string given_text = entry.value.numeric() ? to_text(entry.value.number)
                                   : text                ? entry.value.text
                                                         : kind_name(entry.value);
    probe.set(entry.key, given_text);
    try {
      probe.check();
      parameter.default_text = given_text;
    } catch (const ModelError& error) {
      for (Finding finding : error.findings()) {
        finding.place = entry.value.at.text() + ": " + where;
        findings.push_back(std::move(finding));
      }
    }
  }
}

}  // namespace

void set_run_parameters(const Document& document, const std::string& run, std::vector<Parameter>& parameters,
                        std::vector<Finding>& findings) {
  if (document.run == nullptr) return;
  set_parameters(document, *document.run, "run.parameters", parameters, findings);
  if (const Entry* named = document.run->find(run); !run.empty() && named != nullptr)
    set_parameters(document, named->value, "run." + run + ".parameters", parameters, findings);
}

}  // namespace drev::app
