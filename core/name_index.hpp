#pragma once
/// Positions of names in a list, by name: an open hash table of 8 to 16 bytes a name, which keeps no copy of
/// the names. Internal to SystemBuilder.
#include <functional>
#include <string>
#include <vector>

#include "core/ids.hpp"

namespace drev {

class NameIndex {
 public:
  /// name_of(i): the name at position i < count; must stay as it is.
  NameIndex(std::size_t count, std::function<const std::string&(int)> name_of)
      : name_of_(std::move(name_of)) {
    std::size_t size = 4;
    while (size < 2 * count) size *= 2;
    table_.assign(size, -1);
  }
  /// Enters position i; false where the same name is there already.
  bool insert(int i) {
    int& place = table_[slot(name_of_(i))];
    if (place >= 0) return false;
    place = i;
    return true;
  }
  /// Position of the first such name entered; -1: none.
  int find(const std::string& name) const { return table_[slot(name)]; }

 private:
  std::size_t slot(const std::string& name) const {
    std::size_t s = std::hash<std::string>{}(name) & (table_.size() - 1);
    while (table_[s] >= 0 && name_of_(table_[s]) != name) s = (s + 1) & (table_.size() - 1);
    return s;
  }

  std::function<const std::string&(int)> name_of_;
  std::vector<int> table_;
};

}  // namespace drev
