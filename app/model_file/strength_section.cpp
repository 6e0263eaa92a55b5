#include "app/model_file/strength_section.hpp"

#include <drev/core/channel.hpp>
#include <drev/models/shafts/contour_shaft.hpp>
#include <drev/solvers/strength/class_judgement.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "app/model_file/part.hpp"
#include "app/model_file/run_section.hpp"
#include "core/names/channel_pattern.hpp"

namespace drev::app {

namespace {

using D = Dimension;

/// Elements that carry a torque.
std::vector<std::string> torque_elements(const System& system) {
  constexpr std::string_view kEnd = ".torque_Nm";
  std::vector<std::string> names;
  for (const Channel& channel : all_channels(system))
    if (channel.name().ends_with(kEnd))
      names.push_back(channel.name().substr(0, channel.name().size() - kEnd.size()));
  return names;
}

/// Where the torque of a segment of a contour shaft is meant, diameter, bore and stress concentration that are not given
/// are those of its contour; what cannot be taken from there is said.
std::string take_from_contour(const Model& model, const std::string& name, SectionStrength& section) {
  for (const ElementInstance& placement : model.element_instances()) {
    const auto* shaft = dynamic_cast<const ContourShaft*>(placement.element.get());
    if (shaft == nullptr || shaft->sections() == nullptr) continue;
    const ShaftSections& found = *shaft->sections();
    for (std::size_t k = 0; k < found.segment_station.size(); ++k) {
      if (name != placement.name + "_" + std::to_string(k + 1)) continue;
      const ShaftSection& station = found.sections[static_cast<std::size_t>(found.segment_station[k])];
      if (std::isnan(section.diameter)) section.diameter = station.diameter, section.bore = station.bore;
      if (section.stress_concentration != 1.0) return {};
      if (std::isinf(station.stress_factor.value))
        return "station " + station.name + " has a " + station.stress_place +
               ", at which stress has no limit: give the section a stress_concentration" +
               (station.stress_place == "sharp shoulder" ? ", or the shoulder a fillet" : "");
      section.stress_concentration = std::max(1.0, station.stress_factor.value);
      return {};
    }
  }
  return {};
}

void read_misfire(const Value& table, Strength& strength, ReadContext& context) {
  if (!table.is(Value::Kind::table)) {
    context.findings.push_back(fault_at(table.at, "class.misfire",
                                        "must be a table, { parameter = value }, not " + kind_name(table)));
    return;
  }
  for (const Entry& entry : table.entries) {
    const std::string where = "class.misfire." + entry.key;
    if (!context.scope.numbers.contains(entry.key))
      context.findings.push_back(fault_at(
          entry.at, where,
          "is none of [parameters] that are numbers" + did_you_mean(entry.key, context.scope.names())));
    else if (const auto value = read_number(entry.value, unit_suffix(entry.key), where, context))
      strength.misfire.emplace_back(entry.key, *value);
  }
}

}  // namespace

void list_section(Fields& f, SectionStrength& s) {
  f.number({"diameter", D::length}, s.diameter);
  f.number({"bore", D::length}, s.bore);
  f.number({"stress_concentration", D::none}, s.stress_concentration);
  f.number({"tensile_strength", D::pressure}, s.tensile_strength);
  f.number({"shape_factor", D::none}, s.shape_factor);
  f.number({"permissible_stress", D::pressure}, s.permissible_stress);
  f.number({"transient_stress", D::pressure}, s.transient_stress);
  f.number({"permissible_torque", D::torque}, s.permissible_torque);
  f.number({"transient_torque", D::torque}, s.transient_torque);
  f.number({"permissible_heat", D::power}, s.permissible_heat);
  f.number({"sn_range", D::pressure}, s.sn.reference);
  f.number({"sn_cycles", D::none}, s.sn.cycles);
  f.number({"sn_slope", D::none}, s.sn.slope);
  if (std::isnan(s.sn.reference))
    for (const char* name : {"sn_cycles", "sn_slope"})
      f.without_effect(name, "an S-N line needs an sn_range, with its unit behind it");
}

void read_strength(const Value& table, const System& system, ModelCase& model_case, const LeftOut& left_out,
                   ReadContext& context) {
  Strength strength;
  std::vector<SectionStrength> of_none;  // sections whose element is not known
  Part whole{table.at};
  const bool whole_read = read_fields(
      table, "class", NodeKind::rotational, {"sections", "misfire"},
      [&](Fields& f) {
        f.number({"rated_speed", D::angular_speed}, strength.rated_speed);
      },
      context, &whole.fields);
  std::map<std::string, Part> places;
  std::set<std::string>
      refused;  // sections with a finding of their own: what seems to lack may be what it is of
  const std::vector<std::string> known = torque_elements(system);
  if (const Entry* sections = table.find("sections")) {
    if (!sections->value.is(Value::Kind::table))
      context.findings.push_back(
          fault_at(sections->value.at, "class.sections",
                   "must be a table, [class.sections.NAME], not " + kind_name(sections->value)));
    for (const Entry& entry : sections->value.entries) {
      const std::string where = "class.sections." + entry.key;
      if (!entry.value.is(Value::Kind::table)) {
        context.findings.push_back(
            fault_at(entry.value.at, where, "must be a table, { ... }, not " + kind_name(entry.value)));
        continue;
      }
      SectionStrength section;
      Part part{entry.at};
      const bool read = read_fields(
          entry.value, where, NodeKind::rotational, {}, [&](Fields& f) { list_section(f, section); }, context,
          &part.fields);
      bool fits = false;
      for (const std::string& name : known) {
        if (!fits_pattern(entry.key, name)) continue;
        fits = true;
        section.element = name;
        SectionStrength own = section;
        if (const std::string why = take_from_contour(model_case.model, name, own); !why.empty())
          context.findings.push_back(fault_at(entry.at, where, why));
        places[name] = part;
        if (!read) refused.insert(name);
        // What is said of one element alone counts beside what is said of many.
        std::erase_if(strength.sections, [&](const auto& other) { return other.element == name; });
        strength.sections.push_back(own);
      }
      if (!fits) {
        places[entry.key] = part;
        if (!read) refused.insert(entry.key);
        section.element = entry.key;
        of_none.push_back(section);
      }
      if (!fits && !left_out.may_have(entry.key))
        context.findings.push_back(fault_at(
            entry.at, where, "is the name of no element with a torque" + did_you_mean(entry.key, known)));
    }
  }
  Strength checked = strength;
  checked.sections.insert(checked.sections.end(), of_none.begin(), of_none.end());
  if (!whole_read) checked.rated_speed = 1.0;  // what is wrong with it has been said
  for (const Finding& finding : check_strength(checked)) {
    const std::string name = finding.place.substr(std::min(finding.place.size(), std::size_t{15}));
    const bool no_element =
        std::any_of(of_none.begin(), of_none.end(), [&](const auto& s) { return s.element == name; });
    // A contour that the section would be of may give its diameter.
    if (finding.value.empty() && (refused.contains(name) || (no_element && finding.parameter == "diameter")))
      continue;
    const auto section = places.find(name);
    const Part& part = section != places.end() ? section->second : whole;
    context.findings.push_back(placed(finding, part, finding.place));
  }
  if (const Entry* misfire = table.find("misfire")) read_misfire(misfire->value, strength, context);
  model_case.strength = std::make_shared<const Strength>(std::move(strength));
}

}  // namespace drev::app
