#pragma once
/// The keys of a table, found among those that it may have: "stiffness_MNm_per_rad" is "stiffness" with the
/// factor 1e6. What is none of them is a finding, with what was probably meant.
#include <drev/app/model_file/fields.hpp>

#include <map>
#include <set>

#include "app/model_file/read_values.hpp"

namespace drev::app {

class KeyFinder {
 public:
  struct Found {
    const Entry* entry;
    std::string unit;  ///< suffix of the key
    double factor = 1.0;
  };

  /// Keys in `others` are the caller's own. `where` is what sentences call the table.
  KeyFinder(const Value& table, const std::string& where, const std::set<std::string>& others,
            const FieldKeys& keys, ReadContext& context);

  /// Null if the table has no such key.
  const Found* find(const std::string& name) const;
  /// A finding, unless a key that was refused may have been meant to be this one.
  void missing(const std::string& name, const std::string& spelled);
  const std::map<std::string, Found>& all() const { return found_; }

 private:
  void recognise(const Entry& entry, const std::set<std::string>& others, const FieldKeys& keys);
  void take(const std::string& name, Found found);

  const Value& table_;
  std::string where_;
  ReadContext& context_;
  std::map<std::string, Found> found_;
  std::set<std::string> refused_;  ///< names that a refused key may have meant
};

/// "a, b, c".
std::string list_of(const std::vector<std::string>& words);

}  // namespace drev::app
