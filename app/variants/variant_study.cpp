#include "app/variants/variant_study.hpp"

#include <drev/app/model_file/model_file.hpp>
#include <drev/core/error.hpp>
#include <drev/core/lanes.hpp>
#include <drev/core/units.hpp>
#include <drev/core/version.hpp>
#include <drev/solvers/batch/simulate_many.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>

#include "app/base/checksum.hpp"
#include "app/base/text_layout.hpp"
#include "app/run/run_computation.hpp"
#include "app/run/static_force.hpp"
#include "solvers/batch/lockstep.hpp"

namespace drev::app {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kKeptText = 1 << 20;  // largest model file whose text the description keeps [bytes]

TransientOptions stepping_options(const Method& method, double duration, const std::function<bool()>& go_on) {
  return {.scheme = step_scheme(method.name),
          .step = method.step,
          .tolerance = method.tolerance,
          .t_end = duration,
          .progress = [&go_on](double) { return go_on(); }};
}

std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A file that the rows depend on. The text of a model file is kept, so that a difference can be shown.
Json file_object(const std::string& name, const std::string& content) {
  Json object{{"file", name}, {"checksum", checksum_text(checksum(content))}};
  if (name.ends_with(".toml") && content.size() <= kKeptText) object["text"] = content;
  return object;
}

VariantStatus status_of(RunStatus status) {
  switch (status) {
    case RunStatus::success:
      return VariantStatus::success;
    case RunStatus::energy_error:
      return VariantStatus::energy_error;
    case RunStatus::unstable:
      return VariantStatus::unstable;
    case RunStatus::no_convergence:
      return VariantStatus::no_convergence;
    case RunStatus::not_finite:
      return VariantStatus::not_finite;
    case RunStatus::interrupted:
      break;
  }
  return VariantStatus::failed;
}

/// The first line in which two texts differ, as the last part of a sentence.
std::string changed_line(const std::string& then, const std::string& now) {
  const std::vector<std::string> a = split(then, '\n'), b = split(now, '\n');
  std::size_t i = 0;
  while (i < a.size() && i < b.size() && a[i] == b[i]) ++i;
  const auto line = [&](const std::vector<std::string>& lines) {
    return i < lines.size() ? "'" + lines[i] + "'" : std::string("its end");
  };
  return " in line " + std::to_string(i + 1) + ": " + line(a) + " then, " + line(b) + " now";
}

std::string value_text(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.is_null() ? "nothing" : value.dump();
}

}  // namespace

const char* status_text(VariantStatus status) {
  constexpr const char* kNames[] = {"success",    "energy_error", "unstable", "no_convergence",
                                    "not_finite", "failed",       "bad_input"};
  return kNames[static_cast<int>(status)];
}

/// A variant, ready to be run.
struct VariantStudy::Built {
  std::optional<System> system;  // nullopt: it cannot be built, or has no start
  VariantStatus status = VariantStatus::success;
  std::string reason;
  std::string warning = {};  ///< of its start; empty: none
  double duration = 0.0;
  std::shared_ptr<const Watched> watched = {};
};

/// The channels that the figures belong to. Variants with the same structure share those of the first one,
/// since finding the channels takes as long as building the variant.
struct VariantStudy::Watched {
  Watched(const ModelCase& model_case, const System& system, const std::vector<std::string>& asked)
      : deflection_name(model_case.deflection),
        torque_names(model_case.torques),
        build(build_of(system)),
        torques(find_channels(system, torque_names)),
        meshes(mesh_channels(system)),
        more(find_channels(system, asked)) {
    if (!deflection_name.empty()) deflection = find_channels(system, {deflection_name});
    for (const auto* list : {&deflection, &torques, &meshes, &more})
      for (const Channel& c : *list) names.push_back(c.name());
  }
  bool fits(const ModelCase& model_case, const System& system) const {
    return model_case.deflection == deflection_name && model_case.torques == torque_names &&
           build_of(system) == build;
  }
  /// Structure of a system: its elements, and which laws have gaps.
  static std::vector<std::string> build_of(const System& system) {
    std::vector<std::string> parts;
    for (const ElementInstance& p : system.element_instances()) parts.push_back(p.name);
    for (const ScalarTerm& t : system.scalars())
      parts.push_back(std::to_string(index(t.element)) + (t.force->gap() ? " gap" : ""));
    return parts;
  }

  std::string deflection_name;
  std::vector<std::string> torque_names, build;
  std::vector<Channel> deflection, torques, meshes, more;
  std::vector<std::string> names;  ///< names of all channels, in this order
};

std::shared_ptr<const VariantStudy::Watched> VariantStudy::watched_by(const ModelCase& model_case,
                                                                      const System& system) const {
  if (watched_ && watched_->fits(model_case, system)) return watched_;
  return std::make_shared<const Watched>(model_case, system, channels_);
}

std::vector<FigureColumn> figure_columns(const ModelCase& model_case, const System& system,
                                         const std::vector<std::string>& channels) {
  std::vector<FigureColumn> figures;
  figures.push_back({"energy_error", ""});
  if (!model_case.deflection.empty()) {
    const bool angle = find_channel(system, model_case.deflection).unit() == "rad";
    figures.push_back(angle ? FigureColumn{"deflection_deg", "deg"} : FigureColumn{"deflection_m", "m"});
  }
  if (!model_case.torques.empty()) {
    const bool turning = find_channel(system, model_case.torques.front()).unit() == "N m";
    figures.push_back(turning ? FigureColumn{"max_torque_Nm", "N m"} : FigureColumn{"max_force_N", "N"});
  }
  if (!mesh_channels(system).empty()) {
    figures.push_back({"max_mesh_force_N", "N"});
    figures.push_back({"front_contacts", ""});
    figures.push_back({"back_contacts", ""});
    figures.push_back({"time_separated_s", "s"});
  }
  for (const Channel& channel : find_channels(system, channels)) {
    figures.push_back({channel.name() + ".max", channel.unit()});
    figures.push_back({channel.name() + ".min", channel.unit()});
  }
  return figures;
}

VariantStudy::VariantStudy(RunRequest request, VariantPlan plan, bool record_asked)
    : request_(std::move(request)), plan_(std::move(plan)) {
  if (record_asked) channels_ = request_.record;
  const Method& method = request_.method;
  if (method.exact())
    why_not_lockstep_ = "exact propagation takes the steps of each variant's own modes and contacts";
  else
    why_not_lockstep_ =
        ::drev::why_not_lockstep(request_.model.system, stepping_options(method, 1.0, nullptr)).value_or("");
  block_size_ = why_not_lockstep_.empty() ? kLanes : 1;
  watched_ = watched_by(request_.model.model_case, request_.model.system);
  figures_ = figure_columns(request_.model.model_case, request_.model.system, channels_);
  describe();
}

void VariantStudy::describe() {
  const ModelRequest& model = request_.model;
  Json files = Json::array();
  for (const std::string& file : model.model_case.files) files.push_back(file_object(file, content_of(file)));
  for (const std::string& plugin : loaded_plugins()) files.push_back(file_object(plugin, content_of(plugin)));
  Json varied = Json::array();
  for (const Varied& v : plan_.varied()) varied.push_back(v.name + "=" + v.text);
  Json correlations = Json::array();
  for (const Correlation& c : plan_.correlations())
    correlations.push_back(c.one + "," + c.other + "=" + short_digits(c.value, 17));
  Json columns = Json::array();
  for (const FigureColumn& f : figures_) columns.push_back(f.name);
  const Method& method = request_.method;
  description_ = {{"drev", DREV_VERSION},
                  {"model", request_.words},
                  {"files", std::move(files)},
                  {"parameters", parameters_object(model.parameters)},
                  {"varied", std::move(varied)},
                  {"sample", plan_.sampling() ? Json(sampling_text(*plan_.sampling())) : Json()},
                  {"correlations", std::move(correlations)},
                  {"variants", plan_.count()},
                  {"method", method.name},
                  {"step_s", method.step},
                  {"tolerance", method.tolerance},
                  {"start", to_text(request_.start)},
                  {"duration_s", request_.duration ? Json(*request_.duration) : Json()},
                  {"figures", std::move(columns)},
                  {"block", block_size_}};
  // A varied parameter has no value of its own.
  for (const Varied& v : plan_.varied()) description_["parameters"].erase(v.name);
}

VariantStudy::Built VariantStudy::build(const ParameterValues& values) const {
  Built built;
  try {
    Parameters parameters = request_.model.parameters;
    for (const auto& [name, value] : values) parameters.set(name, value);
    parameters.check();
    const ModelCase model_case = request_.model.entry->build(parameters);
    System system = model_case.model.build();
    built.duration = request_.duration.value_or(model_case.duration);
    if (request_.start != Start::rest) {
      FoundStart found =
          find_start(system, request_.start, {.duration = built.duration, .method = request_.method});
      built.warning = found.unsettled();
      system = std::move(found.system);
    }
    if (const std::vector<std::string> soft = soft_chain_warnings(system); !soft.empty())
      built.warning += (built.warning.empty() ? "" : "; ") + join(soft, "; ");
    built.watched = watched_by(model_case, system);
    built.system.emplace(std::move(system));
  } catch (const ModelError& error) {
    built.status = VariantStatus::bad_input;
    built.reason = error.findings().empty() ? error.what() : error.findings().front().text();
  } catch (const SolverError& error) {
    built.status = VariantStatus::failed;
    built.reason = error.what();
  }
  return built;
}

/// Enters the row of a finished variant, with figures only if its run can be trusted or at least reached its
/// end.
void VariantStudy::enter(const Built& built, const VariantResult& result, std::size_t place,
                         BlockRows& rows) const {
  VariantStatus status = built.status;
  std::string reason = built.reason;
  if (built.system) {
    status = result.error.empty() ? status_of(result.summary.status) : VariantStatus::failed;
    reason = result.error.empty() ? result.summary.reason : result.error;
  }
  if (status == VariantStatus::success) {  // the warnings of its run are its reason
    std::vector<std::string> warnings = result.summary.warnings;
    if (!built.warning.empty()) warnings.push_back(built.warning);
    reason = join(warnings, "; ");
  } else if (reason.empty()) {
    reason = status_text(status);
  }
  if (!reason.empty()) rows.set_reason(place, reason);
  double* row = rows.numbers.data() + place * row_size();
  *row++ = static_cast<double>(status);
  if (status != VariantStatus::success && status != VariantStatus::energy_error) return;
  const Watched& watched = *built.watched;
  auto peak = result.peaks.begin();
  const auto next_largest = [&](const std::vector<Channel>& channels) {
    const std::vector<Peak> peaks(peak, peak + std::ssize(channels));
    peak += std::ssize(channels);
    return largest_of(channels, peaks);
  };
  const std::optional<Largest> deflection = next_largest(watched.deflection),
                               force = next_largest(watched.torques), mesh = next_largest(watched.meshes);
  const auto in_unit = [](const std::optional<Largest>& largest, const char* unit, double factor) {
    return largest && largest->unit == unit ? factor * largest->value : kNone;
  };
  for (const FigureColumn& f : figures_) {
    double& value = *row++;
    if (f.name == "energy_error") {
      value = result.summary.energy.relative_error();
    } else if (f.name == "deflection_deg") {
      value = in_unit(deflection, "rad", to_deg(1.0));
    } else if (f.name == "deflection_m") {
      value = in_unit(deflection, "m", 1.0);
    } else if (f.name == "max_torque_Nm") {
      value = in_unit(force, "N m", 1.0);
    } else if (f.name == "max_force_N") {
      value = in_unit(force, "N", 1.0);
    } else if (f.name == "max_mesh_force_N") {
      value = in_unit(mesh, "N", 1.0);
    } else if (f.name.ends_with(".max")) {
      value = peak->max;
    } else if (f.name.ends_with(".min")) {
      value = (peak++)->min;
    } else {
      if (result.contacts.empty()) continue;  // the variant has no gap
      value = 0.0;
      for (const ContactRecord& c : result.contacts)
        value += f.name == "front_contacts"  ? static_cast<double>(c.front_impacts)
                 : f.name == "back_contacts" ? static_cast<double>(c.back_impacts)
                                             : c.time_separated;
    }
  }
}

/// Runs the variants of a block that can be built: together, or one by one if their topologies differ.
void VariantStudy::run_together(std::vector<Built>& built, std::uint64_t block, std::size_t first,
                                std::size_t count, const std::function<bool()>& go_on,
                                BlockRows& rows) const {
  std::vector<std::size_t> places;
  bool alike = true;
  for (std::size_t i = first; i < first + count; ++i) {
    if (!built[i].system) continue;
    places.push_back(i);
    alike = alike && built[i].duration == built[places.front()].duration &&
            built[i].watched->names == built[places.front()].watched->names;
  }
  if (places.empty()) return;
  const Built& leader = built[places.front()];
  const ManyOptions many{.channels = leader.watched->names, .threads = 1};
  const VariantBuilder take = [&](std::size_t i) { return std::move(*built[places[i]].system); };
  try {
    if (!alike) throw ModelError(std::vector<Finding>{{"", "", "", "", "not of one duration"}});
    ManyResult result;
    const Method& method = request_.method;
    if (method.exact())
      result = propagate_many(places.size(), take,
                              {.tolerance = method.tolerance,
                               .t_end = leader.duration,
                               .progress = [&go_on](double) { return go_on(); }},
                              many);
    else
      result = simulate_many(places.size(), take, stepping_options(method, leader.duration, go_on), many);
    if (result.interrupted) return;
    for (std::size_t i = 0; i < places.size(); ++i)
      enter(built[places[i]], result.variants[i], places[i], rows);
  } catch (const ModelError& error) {
    if (places.size() == 1) {
      VariantResult failed;
      failed.error = error.findings().empty() ? error.what() : error.findings().front().text();
      enter(leader, failed, places.front(), rows);
      return;
    }
    for (const std::size_t i : places) {
      built[i] = build(plan_.parameters(first_of(block) + i));  // its System has been moved from
      run_together(built, block, i, 1, go_on, rows);
    }
  }
}

std::optional<BlockRows> VariantStudy::run(std::uint64_t block, const std::function<bool()>& go_on) const {
  const auto count = static_cast<std::size_t>(count_of(block));
  bool stopped = false;
  const std::function<bool()> ask = [&] {
    stopped = stopped || !go_on();
    return !stopped;
  };
  std::vector<Built> built;
  BlockRows rows;
  rows.numbers.assign(block_size_ * row_size(), kNone);
  for (std::size_t i = 0; i < count; ++i) {
    if (!ask()) return {};
    built.push_back(build(plan_.parameters(first_of(block) + i)));
  }
  for (std::size_t i = 0; i < count; ++i)
    if (!built[i].system) enter(built[i], {}, i, rows);
  run_together(built, block, 0, count, ask, rows);
  if (stopped) return {};
  return rows;
}

std::optional<BlockRows> VariantStudy::run_one(const ParameterValues& values,
                                               const std::function<bool()>& go_on) const {
  bool stopped = false;
  const std::function<bool()> ask = [&] {
    stopped = stopped || !go_on();
    return !stopped;
  };
  BlockRows rows;
  rows.numbers.assign(row_size(), kNone);
  std::vector<Built> built;
  built.push_back(build(values));
  if (!built[0].system) enter(built[0], {}, 0, rows);
  run_together(built, 0, 0, 1, ask, rows);
  if (stopped) return {};
  return rows;
}

std::vector<std::string> differences(const Json& then, const Json& now) {
  std::vector<std::string> all;
  const auto say = [&](const std::string& what, const Json& a, const Json& b) {
    all.push_back(what + " was " + value_text(a) + " and is " + value_text(b));
  };
  const auto at = [](const Json& object, const std::string& key) {
    return object.is_object() && object.contains(key) ? object.at(key) : Json();
  };
  for (const auto& [key, value] : now.items()) {
    const Json before = at(then, key);
    if (before == value) continue;
    if (key == "parameters") {
      for (const auto& [name, number] : value.items())
        if (at(before, name) != number) say("parameter " + name, at(before, name), number);
      for (const auto& [name, number] : before.items())
        if (!value.contains(name)) say("parameter " + name, number, Json());
    } else if (key == "files") {
      for (std::size_t i = 0; i < std::max(before.size(), value.size()); ++i) {
        const Json a = i < before.size() ? before[i] : Json(), b = i < value.size() ? value[i] : Json();
        if (a == b) continue;
        if (at(a, "file") != at(b, "file")) {
          say("a file of the study", at(a, "file"), at(b, "file"));
          continue;
        }
        std::string text = at(b, "file").get<std::string>() + " has changed (checksum " +
                           value_text(at(a, "checksum")) + " then, " + value_text(at(b, "checksum")) +
                           " now)";
        if (at(a, "text").is_string() && at(b, "text").is_string())
          text += changed_line(at(a, "text"), at(b, "text"));
        all.push_back(text);
      }
    } else {
      say(key, before, value);
    }
  }
  return all;
}

}  // namespace drev::app
