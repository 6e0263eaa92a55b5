#pragma once
/// Names of channels with '*' in them, which stands for any characters.
#include <drev/core/system.hpp>

#include <string>
#include <vector>

namespace drev {

bool is_pattern(const std::string& name);
/// Whether a name fits; '*' in the pattern stands for any characters.
bool fits_pattern(const std::string& pattern, const std::string& name);

/// The name of a channel, and what asked for it: the name itself, or a pattern that it fits.
struct AskedChannel {
  std::string name, asked;
};

/// In place of each pattern the channels that fit it, in the order of all_channels(); beside patterns every channel is
/// named once. Energies are meant where the pattern ends as their names do, in _W or _J, and where no other channel fits it: "*"
/// is motions and forces. A pattern that nothing fits stays.
std::vector<AskedChannel> asked_channels(const System& system, const std::vector<std::string>& names);

}  // namespace drev
