#pragma once
/// A model file as a tree of values, each with the place where it stands. Tables keep the order of the file.
#include <drev/app/model_file/position.hpp>
#include <drev/core/error.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace drev::app {

struct Entry;

struct Value {
  enum class Kind { boolean, whole, number, text, array, table, other };
  Kind kind = Kind::table;
  Position at = {};
  bool flag = false;
  std::int64_t whole = 0;
  double number = 0.0;
  std::string text = {};
  std::vector<Value> items = {};    ///< of an array
  std::vector<Entry> entries = {};  ///< of a table

  bool is(Kind k) const { return kind == k; }
  bool numeric() const { return is(Kind::whole) || is(Kind::number); }
  /// Null if a table has no such key.
  const Entry* find(const std::string& key) const;
};

struct Entry {
  std::string key;
  Position at;  ///< of the key
  Value value;
};

/// "a table", "a text", ...
std::string kind_name(const Value& value);

/// What is wrong at a place of a file. `where` says what stands there, e.g. "elements.shaft".
Finding fault_at(const Position& at, const std::string& where, const std::string& sentence);

/// Reads TOML. Throws ModelError with one finding (the language's faults come one at a time), or with those of
/// control characters in names and texts, which go to `controls` instead where that is given; also for a text above
/// kLargestFile bytes, and for tables nested deeper than kDeepest.
Value parse_toml(const std::string& text, const std::string& name, std::vector<Finding>* controls = nullptr);

inline constexpr std::size_t kLargestFile = std::size_t{1} << 24;
inline constexpr int kDeepest = 32;

/// A file as text. Throws ModelError, which blames `at` (or the file itself, where at is null).
std::string read_text(const std::string& path, const Position* at);

}  // namespace drev::app
