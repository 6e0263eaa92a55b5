#include "app/model_file/run_section.hpp"

#include <drev/core/channel.hpp>
#include <drev/core/element.hpp>
#include <drev/core/system.hpp>
#include <drev/elements/not_given.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <unordered_set>

#include "core/names/channel_pattern.hpp"

namespace drev::app {

namespace {

using D = Dimension;

constexpr std::size_t kMostNodesRecorded = 20;

/// What shafts, springs, couplings, meshes and dampers between nodes carry, in one unit: torques, or forces where there are no
/// torques. A load, the torque of a governor, and what drags on a single node act on the train; they are none of them.
std::vector<std::string> carried(const System& system) {
  constexpr std::array<std::string_view, 4> kDrag{"dashpot", "absolute damper", "bearing friction", "brake"};
  std::unordered_map<std::string, std::string_view> types;
  std::unordered_set<std::string> acts;
  for (const ElementInstance& placement : system.element_instances()) {
    const std::string_view type = types[placement.name] = placement.element->type();
    const bool drag =
        placement.nodes.size() == 1 && std::find(kDrag.begin(), kDrag.end(), type) != kDrag.end();
    if (drag || type == "speed governor") acts.insert(placement.name);
  }
  std::unordered_set<std::string> loads;
  for (const LoadTerm& load : system.loads())
    loads.insert(system.element_instances()[static_cast<std::size_t>(index(load.element))].name +
                 (load.suffix.empty() ? "" : "_" + load.suffix));
  const auto carries = [&](const std::string& object) {
    if (loads.contains(object) || acts.contains(object)) return false;
    if (types.contains(object)) return true;
    const auto segments = types.find(object.substr(0, object.rfind('_')));
    return segments != types.end() &&
           (segments->second == "distributed shaft" || segments->second == "contour shaft");
  };
  std::vector<std::string> torques, forces;
  for (const Channel& channel : all_channels(system)) {
    const bool torque = channel.name().ends_with(".torque_Nm");
    if (!torque && !channel.name().ends_with(".force_N")) continue;
    if (carries(channel.name().substr(0, channel.name().rfind('.'))))
      (torque ? torques : forces).push_back(channel.name());
  }
  return torques.empty() ? forces : torques;
}

std::vector<std::string> node_motions(const System& system) {
  std::vector<std::string> names;
  for (const Channel& channel : all_channels(system))
    if ((channel.name().ends_with(".angle_rad") || channel.name().ends_with(".position_m")) &&
        names.size() < kMostNodesRecorded)
      names.push_back(channel.name());
  return names;
}

}  // namespace

RunSection::Params::Params()
    : every(kNotGiven), tolerance(kNotGiven), accuracy(kNotGiven), settle_time(kNotGiven) {}

void RunSection::list(Fields& f, Params& p) {
  f.number({"duration", D::time}, p.duration);
  f.number({"step", D::time}, p.step);
  f.text("method", p.method);
  f.number({"tolerance", D::none}, p.tolerance);
  f.number({"accuracy", D::none}, p.accuracy);
  f.text("start", p.start);
  f.number({"settle", D::time}, p.settle_time);
  f.text("settle", p.settle);
  f.text("deflection", p.deflection);
  f.texts("torques", p.torques);
  f.number({"static_turn", D::angle}, p.static_turn);
  f.texts("record", p.record);
  f.number({"every", D::time}, p.every);
  f.text("out", p.out);
}

RunSection::RunSection(const Document& document, const std::string& run, ReadContext& context) {
  const ListFields fields = [&](Fields& f) { list(f, params_); };
  if (document.run != nullptr) {
    std::vector<std::string> others = document.run_names();
    others.push_back("parameters");
    tables_.push_back(document.run);
    read_fields(*document.run, "run", NodeKind::rotational, {others.begin(), others.end()}, fields, context);
    if (const Entry* named = document.run->find(run); !run.empty() && named != nullptr) {
      tables_.push_back(&named->value);
      read_fields(named->value, "run." + run, NodeKind::rotational, {"parameters"}, fields, context);
    }
  }
  const auto refuse = [&](const char* key, const std::string& sentence) {
    if (const Entry* e = entry(key))
      context.findings.push_back(fault_at(e->value.at, "run." + e->key, sentence));
  };
  const auto not_value = [&](const char* key) { return ", not " + kind_name(entry(key)->value); };
  for (const auto& [key, value] : {std::pair{"duration", params_.duration}, {"step", params_.step}})
    if (!(value > 0.0) && entry(key) != nullptr) refuse(key, "must be > 0" + not_value(key));
  if (params_.static_turn < 0.0)
    refuse("static_turn", "must be >= 0" + not_value("static_turn") + "; 0: no static torque is sought");
  if (const Entry* out = entry("out");
      out != nullptr && out->value.is(Value::Kind::text) && out->value.text.empty())
    refuse("out", "must be the name of a folder, not empty");
}

const Entry* RunSection::entry(const std::string& key) const {
  for (auto table = tables_.rbegin(); table != tables_.rend(); ++table)
    for (const Entry& e : (*table)->entries)
      if (!e.value.is(Value::Kind::table) && (e.key == key || e.key.starts_with(key + "_"))) return &e;
  return nullptr;
}

RunOptions RunSection::options() const {
  RunOptions options;
  const auto add = [&](const char* key, const std::string& value) {
    if (value.empty()) return;
    options.values[std::string("--") + key] = value;
    if (const Entry* e = entry(key)) options.places[std::string("--") + key] = e->value.at;
  };
  const auto number = [](double value) { return std::isnan(value) ? std::string() : to_text(value); };
  add("method", params_.method);
  add("tolerance", number(params_.tolerance));
  add("accuracy", number(params_.accuracy));
  add("start", params_.start);
  const Entry* settle = entry("settle");
  add("settle", settle != nullptr && settle->key == "settle" ? params_.settle : number(params_.settle_time));
  add("every", number(params_.every));
  add("out", params_.out);
  for (const char* key : {"duration", "step"})
    if (const Entry* e = entry(key)) options.places[std::string("--") + key] = e->value.at;
  return options;
}

std::vector<std::string> RunSection::channels(const std::string& key, const std::vector<std::string>& asked,
                                              const System& system, const LeftOut& left_out,
                                              ReadContext& context) const {
  const Entry* given = entry(key);
  const auto place = [&](std::size_t i) {
    const Value& value = given->value;
    return value.is(Value::Kind::array) && i < value.items.size() ? value.items[i].at : value.at;
  };
  std::unordered_map<std::string, std::size_t> origin;
  for (std::size_t i = 0; i < asked.size(); ++i)
    if (!origin.emplace(asked[i], i).second)
      context.findings.push_back(fault_at(place(i), "run." + key, asked[i] + " is named twice"));
  std::vector<std::string> found;
  try {
    for (const Channel& channel :
         find_channels(system, asked, key == "record" ? OverRun::taken : OverRun::refused))
      found.push_back(channel.name());
  } catch (const ModelError& error) {
    for (Finding finding : error.findings()) {
      if (left_out.may_have(finding.value)) continue;
      finding.place = place(origin[finding.value]).text() + ": run." + key;
      context.findings.push_back(std::move(finding));
    }
  }
  return found;
}

/// Of a start or settling time that cannot be, the command that runs the file says so (run_request.cpp), with the
/// other faults of the run.
void RunSection::set_span(ModelCase& model_case) const {
  if (const auto start = start_of(params_.start)) model_case.start = *start;
  const Entry* settle = entry("settle");
  if (settle == nullptr) return;
  if (settle->key == "settle") {
    if (params_.settle == "auto") model_case.settle = Settle{};
  } else if (params_.settle_time >= 0.0 && params_.settle_time < params_.duration) {
    model_case.settle = Settle{params_.settle_time};
  }
}

void RunSection::complete(ModelCase& model_case, const System& system, const LeftOut& left_out,
                          ReadContext& context) const {
  model_case.duration = params_.duration;
  set_span(model_case);
  model_case.default_step = params_.step;
  model_case.static_turn = params_.static_turn;
  if (!params_.deflection.empty()) {
    if (is_pattern(params_.deflection))
      context.findings.push_back(
          fault_at(entry("deflection")->value.at, "run.deflection", "must be one channel, without '*'"));
    else
      channels("deflection", {params_.deflection}, system, left_out, context);
    model_case.deflection = params_.deflection;
  }
  model_case.torques =
      entry("torques") ? channels("torques", params_.torques, system, left_out, context) : carried(system);
  model_case.channels =
      entry("record") ? channels("record", params_.record, system, left_out, context) : node_motions(system);
}

}  // namespace drev::app
