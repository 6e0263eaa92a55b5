#include "app/model_file/field_reader.hpp"

#include <algorithm>
#include <filesystem>

#include "app/model_file/column_reader.hpp"
#include "app/model_file/key_finder.hpp"
#include "app/model_file/part.hpp"

namespace drev::app {

namespace {

using Found = KeyFinder::Found;

class FieldReader final : public Fields {
 public:
  FieldReader(const Value& table, const std::string& where, NodeKind kind,
              const std::set<std::string>& others, const FieldKeys& keys, ReadContext& context)
      : Fields(kind),
        table_(table),
        where_(where),
        context_(context),
        before_(context.findings.size()),
        keys_(table, where, others, keys, context) {}

  bool reading() const override { return true; }

  void number(const Quantity& quantity, double& value, Need need) override {
    const std::string name = quantity.name(kind);
    const Found* found = keys_.find(name);
    // Without its unit the key is a word of the same name.
    if (found != nullptr && (quantity.dimension(kind) == Dimension::none || !found->unit.empty())) {
      const std::optional<double> read =
          read_number(found->entry->value, found->unit, place(*found), context_);
      if (read) value = *read * found->factor;
    } else if (need == Need::required) {
      keys_.missing(name, spellings(name, quantity.dimension(kind)));
    }
  }
  void whole(const std::string& name, int& value, Need need) override {
    if (const Found* found = keys_.find(name)) {
      const std::optional<int> read =
          read_whole(found->entry->value, -1000000000, 1000000000, place(*found), context_);
      if (read) value = *read;
    } else if (need == Need::required) {
      keys_.missing(name, name);
    }
  }
  void flag(const std::string& name, bool& value) override {
    const Found* found = keys_.find(name);
    if (found == nullptr) return;
    if (found->entry->value.is(Value::Kind::boolean))
      value = found->entry->value.flag;
    else
      blame(*found, "must be true or false, not " + kind_name(found->entry->value));
  }
  void text(const std::string& name, std::string& value) override {
    const Found* found = keys_.find(name);
    if (found == nullptr || !found->unit.empty()) return;
    if (const auto read = read_text(found->entry->value, place(*found), context_)) value = *read;
  }
  void file(const std::string& name, std::string& path, Need need) override {
    const Found* found = keys_.find(name);
    if (found == nullptr) {
      if (need == Need::required) keys_.missing(name, name);
      return;
    }
    const std::optional<std::string> read = read_text(found->entry->value, place(*found), context_);
    if (!read) return;
    std::filesystem::path given(*read);
    if (given.is_relative())
      given = std::filesystem::path(*found->entry->value.at.file).parent_path() / given;
    path = given.string();
    context_.files.insert(path);
  }
  void texts(const std::string& name, std::vector<std::string>& values) override {
    if (const Found* found = keys_.find(name))
      values = read_texts(found->entry->value, place(*found), context_);
  }
  void choice(const std::string& name, const std::vector<std::string>& words, int& index) override {
    const Found* found = keys_.find(name);
    if (found == nullptr) return;
    const Value& value = found->entry->value;
    const auto word = std::find(words.begin(), words.end(), value.text);
    if (value.is(Value::Kind::text) && word != words.end())
      index = static_cast<int>(word - words.begin());
    else
      blame(*found, "must be one of " + list_of(words) + ", not " + kind_name(value) +
                        did_you_mean(value.text, words));
  }
  void formula(const std::string& name, const std::vector<FormulaVariable>& variables,
               const std::string& unit, std::optional<Formula>& formula) override {
    const Found* found = keys_.find(name);
    if (found == nullptr) return keys_.missing(name, name);
    const Value& value = found->entry->value;
    if (value.numeric()) {
      formula = Formula({{.op = Formula::Op::constant, .value = value.number}});
    } else if (!value.is(Value::Kind::text)) {
      blame(*found, "must be an expression in quotes, not " + kind_name(value));
    } else {
      try {
        formula = compile(value.text, context_.scope, variables, unit);
      } catch (const ExpressionError& error) {
        blame(*found, error.sentence);
      }
    }
  }
  bool group(const std::string& name, const ListFields& list) override {
    const Found* found = keys_.find(name);
    if (found == nullptr) return false;
    if (!found->entry->value.is(Value::Kind::table)) {
      blame(*found, "must be a table, { ... }, not " + kind_name(found->entry->value));
      return false;
    }
    FieldPlaces inside;
    const bool right = read_fields(found->entry->value, place(*found), kind, {}, list, context_, &inside);
    keep_inside(name, inside);
    return right;
  }
  bool rows(const std::string& name, std::size_t /*count*/, const std::function<void(std::size_t)>& resize,
            const std::function<void(Fields&, std::size_t)>& list) override {
    const Found* found = keys_.find(name);
    if (found == nullptr) return false;
    const Value& value = found->entry->value;
    if (!value.is(Value::Kind::array)) {
      blame(*found, "must be an array of tables, [{ ... }, ...], not " + kind_name(value));
      return false;
    }
    resize(value.items.size());
    bool right = true;
    for (std::size_t i = 0; i < value.items.size(); ++i) {
      const std::string where = place(*found) + "[" + std::to_string(i + 1) + "]";
      if (value.items[i].is(Value::Kind::table)) {
        FieldPlaces inside;
        right = read_fields(
                    value.items[i], where, kind, {}, [&](Fields& f) { list(f, i); }, context_, &inside) &&
                right;
        const std::string row = name + "[" + std::to_string(i + 1) + "]";
        inside_[row] = {value.items[i].at};
        keep_inside(row, inside);
      } else {
        context_.findings.push_back(
            fault_at(value.items[i].at, where, "must be a table, { ... }, not " + kind_name(value.items[i])));
        right = false;
      }
    }
    return right;
  }
  bool columns(const std::string& name, const std::vector<Column>& columns) override {
    const Found* found = keys_.find(name);
    if (found == nullptr) return false;
    const Value* source = &found->entry->value;
    std::string where = place(*found);
    if (source->is(Value::Kind::text)) {
      const std::optional<std::string> table = read_text(*source, where, context_);
      if (!table) return true;
      const auto named = context_.tables.find(*table);
      if (named == context_.tables.end()) {
        std::vector<std::string> names;
        for (const auto& [known, table] : context_.tables) names.push_back(known);
        blame(*found, "names \"" + *table + "\", which is none of [tables]" + did_you_mean(*table, names));
        return true;
      }
      where = "tables." + *table;
      source = named->second;
    }
    if (!source->is(Value::Kind::table)) {
      blame(*found, "must be a table, { ... }, or the name of one of [tables], not " + kind_name(*source));
      return true;
    }
    if (!read_columns(*source, where, kind, columns, context_)) refused_ = true;
    return true;
  }
  void fault(const std::string& sentence) override {
    // What is missing may be what another finding has refused.
    if (follows_from_none()) context_.findings.push_back(fault_at(table_.at, where_, sentence));
  }
  void without_effect(const std::string& name, const std::string& why) override {
    const Found* found = keys_.find(name);
    if (found == nullptr || !follows_from_none()) return;
    blame(*found, "has no effect: " + why);
    ++without_effect_;
  }

  void refused(const ModelError& error) override {
    if (!follows_from_none()) return;
    const Part part{table_.at, places()};
    for (const Finding& finding : error.findings())
      context_.findings.push_back(placed(finding, part, where_));
  }

  FieldPlaces places() const {
    FieldPlaces all = inside_;
    for (const auto& [name, found] : keys_.all()) all[name] = {found.entry->at, given(found)};
    return all;
  }

 private:
  void keep_inside(const std::string& name, const FieldPlaces& inside) {
    for (const auto& [field, at] : inside) inside_[name + "." + field] = at;
  }
  static std::string given(const Found& found) {
    const Value& value = found.entry->value;
    if (value.numeric() && found.factor != 1.0) return found.entry->key + " = " + to_text(value.number);
    if (value.is(Value::Kind::text) && !found.unit.empty())
      return found.entry->key + " = \"" + value.text + "\"";
    return {};
  }
  /// Whether nothing else of this table has been refused, from which another fault may follow.
  bool follows_from_none() const {
    return !refused_ && context_.findings.size() == before_ + without_effect_;
  }
  std::string place(const Found& found) const { return where_ + "." + found.entry->key; }
  void blame(const Found& found, const std::string& sentence) {
    context_.findings.push_back(fault_at(found.entry->value.at, place(found), sentence));
  }

  const Value& table_;
  const std::string& where_;
  ReadContext& context_;
  std::size_t before_;              ///< findings when this reader began
  std::size_t without_effect_ = 0;  ///< of its own findings
  KeyFinder keys_;
  FieldPlaces inside_;    ///< of fields of tables inside this one: "geometry.gear_1.teeth"
  bool refused_ = false;  ///< by a finding of an earlier table
};

}  // namespace

bool read_fields(const Value& table, const std::string& where, NodeKind kind,
                 const std::set<std::string>& others, const ListFields& list, ReadContext& context,
                 FieldPlaces* places) {
  const std::size_t before = context.findings.size();
  const FieldKeys keys(kind, list);
  FieldReader reader(table, where, kind, others, keys, context);
  list(reader);
  if (places != nullptr) *places = reader.places();
  return context.findings.size() == before;
}

}  // namespace drev::app
