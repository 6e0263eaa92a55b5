#include "app/results/event_file.hpp"

#include <drev/core/channel.hpp>

#include <algorithm>
#include <filesystem>

#include "app/base/csv_cell.hpp"

namespace drev::app {

EventFile::EventFile(const std::string& path)
    : RowFile(folder_of(path), std::filesystem::path(path).stem().string(),
              "time_s,element,flank,contact,rate,rate_unit") {}

namespace {

std::string friction_word(const Friction& friction, FrictionState state) {
  if (friction.one_way()) return state == FrictionState::stuck ? "locked" : "released";
  if (friction.gear_loss() && state != FrictionState::stuck)
    return state == FrictionState::forward ? "turning forward" : "turning backward";
  return to_text(state);
}

}  // namespace

void EventFile::follow(const System& system) {
  laws_.clear();
  frictions_.clear();
  friction_laws_.clear();
  for (const FrictionTerm& term : system.frictions()) {
    const bool turns = std::all_of(term.nodes.begin(), term.nodes.end(), [&](const Entry& e) {
      return system.node_kind(e.index) == NodeKind::rotational;
    });
    frictions_.push_back(
        {csv_cell(system.element_instances()[static_cast<std::size_t>(index(term.element))].name),
         turns ? "rad/s" : "m/s"});
    friction_laws_.push_back(term.friction);
  }
  for (const ScalarTerm& term : system.scalars()) {
    const auto element = static_cast<std::size_t>(index(term.element));
    laws_.push_back({csv_cell(system.element_instances()[element].name), "rad/s"});
  }
  for (const Channel& channel : all_channels(system))
    if (channel.force_of() >= 0 && channel.unit() == "N")
      laws_[static_cast<std::size_t>(channel.force_of())].rate_unit = "m/s";
}

void EventFile::add(const ContactEvent& event) {
  std::string line;
  append_digits(line, event.t);
  if (event.friction >= 0) {
    const auto i = static_cast<std::size_t>(event.friction);
    line += "," + frictions_[i].element + ",," + friction_word(*friction_laws_[i], event.becomes) + ",";
    append_digits(line, event.rate);
    RowFile::add(line + "," + frictions_[i].rate_unit + "\n");
    return;
  }
  const Law& law = laws_[event.law];
  line += "," + law.element + (event.front ? ",front," : ",back,") + (event.made ? "made," : "lost,");
  append_digits(line, event.rate);
  RowFile::add(line + "," + law.rate_unit + "\n");
}

}  // namespace drev::app
