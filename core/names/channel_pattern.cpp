#include "core/names/channel_pattern.hpp"

#include <drev/core/channel.hpp>

#include <algorithm>
#include <unordered_set>

namespace drev {

bool is_pattern(const std::string& name) { return name.find('*') != std::string::npos; }

bool fits_pattern(const std::string& pattern, const std::string& name) {
  std::size_t p = 0, n = 0, star = std::string::npos, mark = 0;
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*')
      star = p++, mark = n;
    else if (p < pattern.size() && pattern[p] == name[n])
      ++p, ++n;
    else if (star != std::string::npos)
      p = star + 1, n = ++mark;
    else
      return false;
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

std::vector<AskedChannel> asked_channels(const System& system, const std::vector<std::string>& names) {
  const bool patterns = std::any_of(names.begin(), names.end(), is_pattern);
  std::vector<AskedChannel> all;
  std::unordered_set<std::string> named;
  const auto add = [&](const std::string& name, const std::string& asked) {
    if (!patterns || named.insert(name).second) all.push_back({name, asked});
  };
  for (const std::string& asked : names) {
    if (!is_pattern(asked)) {
      add(asked, asked);
      continue;
    }
    bool fits = false;
    const auto add_fitting = [&](const std::vector<Channel>& channels) {
      for (const Channel& channel : channels)
        if (fits_pattern(asked, channel.name())) fits = true, add(channel.name(), asked);
    };
    if (!asked.ends_with("_W") && !asked.ends_with("_J")) add_fitting(all_channels(system));
    if (!fits) add_fitting(energy_channels(system));
    if (!fits) add(asked, asked);
  }
  return all;
}

}  // namespace drev
