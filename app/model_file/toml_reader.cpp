// The only source that knows toml++.
//
// toml++ 3.3 asserts, and where NDEBUG is defined lets the compiler assume, that a key of an inline table
// begins as keys do; a file need not do so. Without the assumption the parser finds the error that it is.
#undef NDEBUG
#define TOML_ASSERT(expr) static_assert(true)

#include <algorithm>
#include <toml++/toml.h>

#include "app/model_file/tree.hpp"

namespace drev::app {

namespace {

using File = std::shared_ptr<const std::string>;

Position place(const toml::source_region& region, const File& file) {
  return {file, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

bool before(const Position& a, const Position& b) {
  return a.line != b.line ? a.line < b.line : a.column < b.column;
}

Value convert(const toml::node& node, const File& file) {
  Value value{.at = place(node.source(), file)};
  if (const toml::table* table = node.as_table()) {
    value.kind = Value::Kind::table;
    for (const auto& [key, child] : *table)
      value.entries.push_back({std::string(key.str()), place(key.source(), file), convert(child, file)});
    // toml++ sorts by name.
    std::stable_sort(value.entries.begin(), value.entries.end(),
                     [](const Entry& a, const Entry& b) { return before(a.at, b.at); });
  } else if (const toml::array* array = node.as_array()) {
    value.kind = Value::Kind::array;
    for (const toml::node& child : *array) value.items.push_back(convert(child, file));
  } else if (const auto* text = node.as_string()) {
    value.kind = Value::Kind::text;
    value.text = text->get();
  } else if (const auto* whole = node.as_integer()) {
    value.kind = Value::Kind::whole;
    value.whole = whole->get();
    value.number = static_cast<double>(whole->get());
  } else if (const auto* number = node.as_floating_point()) {
    value.kind = Value::Kind::number;
    value.number = number->get();
  } else if (const auto* flag = node.as_boolean()) {
    value.kind = Value::Kind::boolean;
    value.flag = flag->get();
  } else {
    value.kind = Value::Kind::other;
  }
  return value;
}

/// The parser and the tables that it makes recurse into dotted keys without limit, so that a long one would
/// end the process: counts the dots of each key before it is parsed.
class DepthScan {
 public:
  explicit DepthScan(const std::string& text) : text_(text) {}

  /// Where a key is nested too deeply; nothing if none is.
  bool find(int& line, int& column) {
    int dots = 0;
    while (i_ < text_.size()) {
      const char c = text_[i_];
      if (c == '#') {
        while (i_ < text_.size() && text_[i_] != '\n') step();
        continue;
      }
      if (c == '"' || c == '\'') {
        skip_text(c);
        continue;
      }
      if (c == '.' && ++dots > kDeepest) {
        line = line_;
        column = static_cast<int>(i_ - start_) + 1;
        return true;
      }
      if (c == '\n' || c == '=' || c == ',' || c == '{' || c == '[') dots = 0;
      step();
    }
    return false;
  }

 private:
  void step() {
    if (text_[i_] == '\n') ++line_, start_ = i_ + 1;
    ++i_;
  }
  /// From its opening quote to beyond its closing one; a text of one line ends with its line at the latest.
  void skip_text(char quote) {
    const bool long_one = text_.compare(i_, 3, std::string(3, quote)) == 0;
    for (int k = long_one ? 3 : 1; k > 0; --k) step();
    while (i_ < text_.size()) {
      if (text_[i_] == '\n' && !long_one) return;
      if (text_[i_] == '\\' && quote == '"' && i_ + 1 < text_.size()) {
        step();
      } else if (text_[i_] == quote && (!long_one || text_.compare(i_, 3, std::string(3, quote)) == 0)) {
        for (int k = long_one ? 3 : 1; k > 0; --k) step();
        return;
      }
      step();
    }
  }

  const std::string& text_;
  std::size_t i_ = 0, start_ = 0;
  int line_ = 1;
};

constexpr std::size_t kMostBadTexts = 20;

/// Names are printed, on terminals too: what steers one is refused. A text may have line ends and tabs.
void check_characters(const Value& value, const std::string& where, std::vector<Finding>& findings) {
  const auto check = [&](const Position& at, const std::string& text, bool lines) {
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (control_bytes(text, i) == 0 || (lines && (text[i] == '\n' || text[i] == '\t'))) continue;
      if (findings.size() < kMostBadTexts)
        findings.push_back(fault_at(at, where, "has a control character, which is not allowed: " + text));
      return;
    }
  };
  if (value.is(Value::Kind::text)) check(value.at, value.text, true);
  for (const Value& item : value.items) check_characters(item, where, findings);
  for (const Entry& entry : value.entries) {
    check(entry.at, entry.key, false);
    check_characters(entry.value, (where.empty() ? "" : where + ".") + entry.key, findings);
  }
}

}  // namespace

Value parse_toml(const std::string& text, const std::string& name, std::vector<Finding>* controls) {
  const auto file = std::make_shared<const std::string>(name);
  if (text.size() > kLargestFile)
    throw ModelError(
        {fault_at({file}, "", "the file is larger than " + std::to_string(kLargestFile >> 20) + " MiB")});
  Position deep{file};
  if (DepthScan(text).find(deep.line, deep.column))
    throw ModelError(
        {fault_at(deep, "", "keys may be nested " + std::to_string(kDeepest) + " deep at most")});
  try {
    const toml::table table = toml::parse(std::string_view(text), std::string_view(name));
    Value root = convert(table, file);
    std::vector<Finding> findings;
    check_characters(root, "", findings);
    if (controls != nullptr)
      controls->insert(controls->end(), findings.begin(), findings.end());
    else if (!findings.empty())
      throw ModelError(std::move(findings));
    return root;
  } catch (const toml::parse_error& error) {
    throw ModelError(
        {fault_at(place(error.source(), file), "", "is no TOML: " + std::string(error.description()))});
  }
}

}  // namespace drev::app
