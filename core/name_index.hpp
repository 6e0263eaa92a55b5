#pragma once
/// Positions of names in a list, by name: an open hash table of 16 to 32 bytes a name, which keeps no copy of
/// the names. Internal to core.
#include <drev/core/ids.hpp>

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace drev {

class NameIndex {
 public:
  /// Enters all positions, in order. name_of(i): the name at position i < count; must stay as it is.
  /// entered(i, first), if given, hears of each whether its name was not there yet.
  NameIndex(int count, std::function<const std::string&(int)> name_of,
            const std::function<void(int, bool)>& entered = {})
      : name_of_(std::move(name_of)) {
    std::size_t size = 4;
    while (size < 2 * idx(count)) size *= 2;
    table_.resize(size);
    // The table lies outside the caches: its places are called for some names ahead.
    constexpr int kAhead = 16;
    std::array<std::uint32_t, kAhead> hashes{};
    for (int i = -kAhead; i < count; ++i) {
      std::uint32_t& hash = hashes[idx(i + kAhead) % kAhead];
      if (i >= 0) {
        const bool first = insert(i, hash);
        if (entered) entered(i, first);
      }
      if (i + kAhead >= count) continue;
      hash = hash_of(name_of_(i + kAhead));
      __builtin_prefetch(&table_[hash & (size - 1)]);
    }
  }
  /// Position of the first such name; -1: none.
  int find(const std::string& name) const { return table_[slot(name, hash_of(name))].position; }

 private:
  struct Slot {
    int position = -1;
    std::uint32_t hash = 0;
  };
  static std::uint32_t hash_of(const std::string& name) {
    return static_cast<std::uint32_t>(std::hash<std::string>{}(name));
  }
  bool insert(int i, std::uint32_t hash) {
    Slot& place = table_[slot(name_of_(i), hash)];
    if (place.position >= 0) return false;
    place = {i, hash};
    return true;
  }
  std::size_t slot(const std::string& name, std::uint32_t hash) const {
    std::size_t s = hash & (table_.size() - 1);
    while (table_[s].position >= 0 && (table_[s].hash != hash || name_of_(table_[s].position) != name))
      s = (s + 1) & (table_.size() - 1);
    return s;
  }

  std::function<const std::string&(int)> name_of_;
  std::vector<Slot> table_;
};

}  // namespace drev
