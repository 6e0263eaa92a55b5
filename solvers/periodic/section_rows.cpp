#include "solvers/periodic/section_rows.hpp"

#include <drev/core/channel.hpp>
#include <drev/core/scalar_force.hpp>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/names/channel_pattern.hpp"

namespace drev {

namespace {

std::vector<Entry> over_unknowns(const System& system, const std::vector<Entry>& nodes, double factor = 1.0) {
  std::vector<Entry> row;
  for (const Entry& node : nodes)
    for (const Entry& e : system.row_of(node.index)) row.push_back({e.index, factor * node.coeff * e.coeff});
  return row;
}

double largest_coefficient(const std::vector<Entry>& row) {
  double largest = 0.0;
  for (const Entry& e : row) largest = std::max(largest, std::abs(e.coeff));
  return largest;
}

/// Sections of the elements whose terms are in the matrices, by channel name.
std::map<std::string, SectionRows> element_sections(const System& system,
                                                    std::vector<std::string>& in_order) {
  std::map<std::string, SectionRows> sections;
  const std::vector<OutputTerm> outputs = system.outputs();
  for (std::size_t o = 0; o < outputs.size(); ++o) {
    const OutputTerm& term = outputs[o];
    if (term.deflection) continue;
    const std::vector<Entry>& given = term.stiffness.empty() ? term.damping : term.stiffness;
    const bool turns = std::all_of(given.begin(), given.end(), [&](const Entry& e) {
      return system.node_kind(e.index) == NodeKind::rotational;
    });
    const bool torque = turns && !term.along_line_of_action;
    SectionRows section;
    section.unit = torque ? "N m" : "N";
    section.name = system.element_instances()[idx(index(term.element))].name +
                   (term.suffix.empty() ? "" : "_" + term.suffix) + (torque ? ".torque_Nm" : ".force_N");
    section.stiffness = over_unknowns(system, term.stiffness);
    section.damping = section.damper = over_unknowns(system, term.damping);
    section.twist_unit = torque ? "rad" : "m";
    const bool stated =
        o + 1 < outputs.size() && outputs[o + 1].deflection && outputs[o + 1].element == term.element;
    if (stated)
      section.twist = over_unknowns(system, outputs[o + 1].stiffness);
    else if (const double size = largest_coefficient(given); size > 0.0)
      section.twist = over_unknowns(system, given, 1.0 / size);
    for (std::size_t f = 0; f < system.frequency_terms().size(); ++f)
      if (system.frequency_terms()[f].element == term.element) section.frequency_term = static_cast<int>(f);
    if (!sections.emplace(section.name, section).second) continue;
    in_order.push_back(section.name);
  }
  return sections;
}

/// In place of each pattern the sections of elements that fit it, else the other linear channels that do.
std::vector<std::string> sections_asked(const std::vector<std::string>& names,
                                        const std::vector<std::string>& sections,
                                        const std::vector<Channel>& channels) {
  std::vector<std::string> wanted;
  const auto add = [&](const std::string& name) {
    if (std::find(wanted.begin(), wanted.end(), name) == wanted.end()) wanted.push_back(name);
  };
  for (const std::string& name : names) {
    bool fits = false;
    if (is_pattern(name)) {
      for (const std::string& section : sections)
        if (fits_pattern(name, section)) fits = true, add(section);
      const bool of_elements = fits;
      for (const Channel& channel : channels)
        if (!of_elements && channel.is_linear() && fits_pattern(name, channel.name()))
          fits = true, add(channel.name());
    }
    if (!fits) add(name);
  }
  return wanted;
}

}  // namespace

std::vector<SectionRows> find_section_rows(const System& system, const std::vector<std::string>& names,
                                           std::vector<Finding>& findings) {
  std::vector<SectionRows> sections;
  std::vector<std::string> wanted;
  std::map<std::string, SectionRows> known = element_sections(system, wanted);
  const std::vector<Channel> channels =
      names.empty() && system.scalars().empty() ? std::vector<Channel>{} : all_channels(system);
  for (const Channel& channel : channels) {
    if (channel.force_of() < 0) continue;
    const ScalarTerm& term = system.scalars()[idx(channel.force_of())];
    SectionRows section;
    section.name = channel.name();
    section.unit = channel.unit();
    section.twist = term.z;
    section.twist_unit = channel.unit() == "N" ? "m" : "rad";
    section.contact = term.force->gap().has_value();
    section.law = channel.force_of();
    for (const Entry& e : term.z) {
      section.stiffness.push_back({e.index, term.force->closed_stiffness() * e.coeff});
      section.damping.push_back({e.index, term.force->closed_damping() * e.coeff});
    }
    section.damper = section.damping;
    known[section.name] = section;
    wanted.push_back(section.name);
  }
  if (!names.empty()) wanted = sections_asked(names, wanted, channels);
  for (const std::string& name : wanted) try {
      if (const auto found = known.find(name); found != known.end()) {
        sections.push_back(found->second);
        continue;
      }
      const Channel channel = find_channel(system, name);
      if (!channel.is_linear()) {
        findings.push_back({system.name() + "/sweep", "section", name, "",
                            "is no linear function of the motion; torques and forces of shafts, springs, "
                            "dampers and meshes are, angles, speeds and twists, too"});
        continue;
      }
      SectionRows section;
      section.name = channel.name();
      section.unit = channel.unit();
      section.stiffness = channel.z_row();
      section.damping = channel.v_row();
      sections.push_back(section);
    } catch (const ModelError& error) {
      findings.insert(findings.end(), error.findings().begin(), error.findings().end());
    }
  if (wanted.empty())
    findings.push_back({system.name() + "/sweep", "sections", "none", "",
                        "no element of the model carries a torque; name channels, such as NODE.angle_rad"});
  return sections;
}

}  // namespace drev
