#pragma once
/// Writes fields as TOML: keys in SI, numbers with the digits that read back to the same double. What equals
/// its default is left out.
#include <drev/app/model_file/fields.hpp>

#include <map>
#include <utility>

namespace drev::app {

/// A double as TOML; a text in quotes; a key, in quotes where it needs them.
std::string toml_number(double value);
std::string toml_text(const std::string& text);
std::string toml_key(const std::string& key);
std::string toml_texts(const std::vector<std::string>& texts);

/// Long tables of columns, each written once however many elements have it.
class TableStore {
 public:
  /// The name of the table that has this body; `wish` is taken for a new one.
  std::string name_of(const std::string& body, const std::string& wish);
  /// [tables] as TOML; empty if there are none.
  std::string text() const;

 private:
  std::vector<std::pair<std::string, std::string>> tables_;  // name, body
  std::map<std::string, std::string> names_;                 // by body
};

class FieldWriter final : public Fields {
 public:
  /// `defaults`: keys with the values that need not be written. `owner` names tables that are stored.
  FieldWriter(NodeKind kind, const FieldKeys& defaults, TableStore& store, std::string owner)
      : Fields(kind), defaults_(defaults), store_(store), owner_(std::move(owner)) {}

  bool reading() const override { return false; }
  void number(const Quantity& quantity, double& value, Need need) override;
  void whole(const std::string& name, int& value, Need need) override;
  void flag(const std::string& name, bool& value) override;
  void text(const std::string& name, std::string& value) override;
  void file(const std::string& name, std::string& path, Need need) override;
  void texts(const std::string& name, std::vector<std::string>& values) override;
  void choice(const std::string& name, const std::vector<std::string>& words, int& index) override;
  void formula(const std::string& name, const std::vector<FormulaVariable>& variables,
               const std::string& unit, std::optional<Formula>& formula) override;
  bool columns(const std::string& name, const std::vector<Column>& columns) override;
  bool group(const std::string& name, const std::function<void(Fields&)>& list) override;
  bool rows(const std::string& name, std::size_t count, const std::function<void(std::size_t)>& resize,
            const std::function<void(Fields&, std::size_t)>& list) override;
  void fault(const std::string&) override {}
  void refused(const ModelError&) override {}

  void add(const std::string& key, const std::string& value) { parts_.emplace_back(key, value); }
  /// "{ key = value, ... }".
  std::string inline_table() const;

 private:
  bool is_default(const std::string& name, const std::string& text) const;

  const FieldKeys& defaults_;
  TableStore& store_;
  std::string owner_;
  std::vector<std::pair<std::string, std::string>> parts_;
};

}  // namespace drev::app
