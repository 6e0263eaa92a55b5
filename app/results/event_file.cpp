#include "app/results/event_file.hpp"

#include <drev/core/channel.hpp>

#include <filesystem>

#include "app/base/csv_cell.hpp"

namespace drev::app {

EventFile::EventFile(const std::string& path)
    : RowFile(folder_of(path), std::filesystem::path(path).stem().string(),
              "time_s,element,flank,contact,rate,rate_unit") {}

void EventFile::follow(const System& system) {
  laws_.clear();
  for (const ScalarTerm& term : system.scalars()) {
    const auto element = static_cast<std::size_t>(index(term.element));
    laws_.push_back({csv_cell(system.element_instances()[element].name), "rad/s"});
  }
  for (const Channel& channel : all_channels(system))
    if (channel.force_of() >= 0 && channel.unit() == "N")
      laws_[static_cast<std::size_t>(channel.force_of())].rate_unit = "m/s";
}

void EventFile::add(const ContactEvent& event) {
  const Law& law = laws_[event.law];
  std::string line;
  append_digits(line, event.t);
  line += "," + law.element + (event.front ? ",front," : ",back,") + (event.made ? "made," : "lost,");
  append_digits(line, event.rate);
  RowFile::add(line + "," + law.rate_unit + "\n");
}

}  // namespace drev::app
