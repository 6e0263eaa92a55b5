#include "app/model_file/document.hpp"

#include <drev/app/model_file/units.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

namespace drev::app {

namespace {

constexpr int kMostFiles = 100, kDeepestInclude = 10;
constexpr std::size_t kMostParameters = 1000;

bool is_identifier(const std::string& name) {
  return !name.empty() && !std::isdigit(static_cast<unsigned char>(name[0])) &&
         std::all_of(name.begin(), name.end(),
                     [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; });
}

class DocumentReader {
 public:
  DocumentReader(Document& document) : doc_(document) {}

  void read(Value root, const std::string& path, int depth) {
    doc_.roots.push_back(std::move(root));
    Value& table = doc_.roots.back();
    const std::size_t first_included = doc_.blocks.size();
    stack_.push_back(path);
    ++files_;
    check_format(table);
    check_keys(table);
    if (const Entry* include = table.find("include")) read_includes(include->value, path, depth);
    // The file that includes another has the last word.
    read_text_key(table, "name", doc_.name);
    read_text_key(table, "summary", doc_.summary);
    read_text_key(table, "note", doc_.note);
    lay_section(table, "run", doc_.run);
    lay_section(table, "class", doc_.strength);
    for (const char* parts : {"nodes", "elements"}) override_included(table, parts, first_included);
    if (const Value* parameters = section(table, "parameters")) read_parameters(*parameters);
    if (const Value* lists = section(table, "lists")) read_lists(*lists);
    if (const Value* tables = section(table, "tables")) read_tables(*tables);
    const std::size_t own_blocks = doc_.blocks.size();
    if (const Value* nodes = section(table, "nodes"), *elements = section(table, "elements");
        nodes != nullptr || elements != nullptr)
      doc_.blocks.push_back({nodes, elements, nullptr});
    if (const Entry* repeat = table.find("repeat")) read_repeats(repeat->value);
    if (doc_.blocks.size() > own_blocks) with_parts_.insert(path);
    stack_.pop_back();
  }

 private:
  void refuse(const Position& at, const std::string& where, const std::string& sentence) {
    doc_.findings.push_back(fault_at(at, where, sentence));
  }

  void check_format(const Value& table) {
    const Entry* format = table.find("format");
    const std::string known = "this drev reads format " + std::to_string(kFormat);
    if (format == nullptr)
      refuse(table.at, "format",
             "is missing; write format = " + std::to_string(kFormat) + " in the first line (" + known + ")");
    else if (!format->value.is(Value::Kind::whole) && format->value.numeric())
      refuse(format->value.at, "format",
             "must be a whole number, written without a point: format = " + std::to_string(kFormat));
    else if (!format->value.is(Value::Kind::whole) || format->value.whole != kFormat)
      refuse(format->value.at, "format", "is " + kind_name(format->value) + "; " + known);
  }

  void check_keys(const Value& table) {
    const std::vector<std::string> known{"format", "include", "parameters", "lists",    "tables",
                                         "nodes",  "repeat",  "name",       "elements", "summary",
                                         "note",   "run",     "class"};
    for (const Entry& entry : table.entries)
      if (std::count(known.begin(), known.end(), entry.key) == 0) {
        refuse(entry.at, entry.key, "is unknown at the top of a model file" + did_you_mean(entry.key, known));
        holds_parts(nearest_name(entry.key, known));
      }
  }

  /// What is refused would hold, under this key, nodes and elements.
  void holds_parts(const std::string& key) {
    for (const char* part : {"nodes", "elements", "repeat", "include"})
      if (key == part) doc_.whole = false;
  }

  /// Lays a section of a file over what included files say in it.
  void lay_section(const Value& table, const char* name, const Value*& target) {
    const Value* given = section(table, name);
    if (given == nullptr) return;
    if (target == nullptr) {
      target = given;
      return;
    }
    Value merged = *target;
    lay_over(merged, *given);
    doc_.roots.push_back(std::move(merged));
    target = &doc_.roots.back();
  }

  /// Nodes and elements of this file that included files have, too, change those: keys are laid over theirs; with a
  /// type of its own an element takes the place of the other.
  void override_included(Value& table, const char* parts, std::size_t first_included) {
    Entry* own = entry_of(table, parts);
    if (own == nullptr || !own->value.is(Value::Kind::table)) return;
    std::erase_if(own->value.entries, [&](const Entry& entry) {
      for (std::size_t b = first_included; b < doc_.blocks.size(); ++b) {
        const Block& block = doc_.blocks[b];
        const Value* other = std::string(parts) == "nodes" ? block.nodes : block.elements;
        if (other == nullptr) continue;
        for (Value& root : doc_.roots)
          if (Entry* same = find_entry(root, other, entry.key)) {
            if (entry.value.find("type") != nullptr || !entry.value.is(Value::Kind::table))
              same->value = entry.value;
            else
              lay_over(same->value, entry.value);
            same->at = entry.at;
            return true;
          }
      }
      return false;
    });
  }

  static Entry* entry_of(Value& table, const std::string& key) {
    for (Entry& entry : table.entries)
      if (entry.key == key) return &entry;
    return nullptr;
  }
  /// The entry of a key in the table `wanted`, if that is a part of the root; null: none.
  static Entry* find_entry(Value& root, const Value* wanted, const std::string& key) {
    if (&root == wanted) return entry_of(root, key);
    for (Entry& entry : root.entries)
      if (entry.value.is(Value::Kind::table) && &entry.value == wanted) return entry_of(entry.value, key);
    for (Entry& entry : root.entries)
      if (entry.key == "repeat")
        for (Value& item : entry.value.items)
          for (Entry& inner : item.entries)
            if (&inner.value == wanted) return entry_of(inner.value, key);
    return nullptr;
  }

  /// A key without its unit, for those of one table that say the same.
  static std::string stem_of(const std::string& key) {
    const std::string suffix = unit_suffix(key);
    const std::string stem = suffix.empty() ? key : key.substr(0, key.size() - suffix.size() - 1);
    return stem == "node" ? "nodes" : stem;
  }

  static void lay_over(Value& base, const Value& over) {
    for (const Entry& entry : over.entries) {
      Entry* same = entry_of(base, entry.key);
      if (same != nullptr && same->value.is(Value::Kind::table) && entry.value.is(Value::Kind::table)) {
        lay_over(same->value, entry.value);
        continue;
      }
      std::erase_if(base.entries, [&](const Entry& old) { return stem_of(old.key) == stem_of(entry.key); });
      base.entries.push_back(entry);
    }
  }

  const Value* section(const Value& table, const char* name) {
    const Entry* entry = table.find(name);
    if (entry == nullptr) return nullptr;
    if (entry->value.is(Value::Kind::table)) return &entry->value;
    refuse(entry->at, name, "must be a table, [" + std::string(name) + "], not " + kind_name(entry->value));
    holds_parts(name);
    return nullptr;
  }

  void read_text_key(const Value& table, const char* name, std::string& target) {
    const Entry* entry = table.find(name);
    if (entry == nullptr) return;
    if (entry->value.is(Value::Kind::text))
      target = entry->value.text;
    else
      refuse(entry->value.at, name, "must be a text in quotes, not " + kind_name(entry->value));
  }

  void read_includes(const Value& value, const std::string& path, int depth) {
    const std::size_t before = doc_.findings.size();
    read_included(value, path, depth);
    if (doc_.findings.size() > before) holds_parts("include");
  }

  void read_included(const Value& value, const std::string& path, int depth) {
    std::vector<const Value*> names;
    if (value.is(Value::Kind::array))
      for (const Value& item : value.items) names.push_back(&item);
    else
      names.push_back(&value);
    for (const Value* name : names) {
      if (!name->is(Value::Kind::text)) {
        refuse(name->at, "include", "must be the name of a file in quotes, not " + kind_name(*name));
        continue;
      }
      std::filesystem::path file(name->text);
      if (file.is_relative()) file = std::filesystem::path(path).parent_path() / file;
      const std::string included = file.lexically_normal().string();
      if (std::count(stack_.begin(), stack_.end(), included) > 0) {
        refuse(name->at, "include", included + " includes itself");
        continue;
      }
      if (with_parts_.contains(included)) {
        refuse(name->at, "include",
               included + " is included twice: its nodes and elements are there already");
        continue;
      }
      if (depth >= kDeepestInclude || files_ >= kMostFiles) {
        refuse(name->at, "include",
               "at most " + std::to_string(kMostFiles) + " files, " + std::to_string(kDeepestInclude) +
                   " deep, can be included");
        continue;
      }
      try {
        read(parse_toml(read_text(included, &name->at), included, &doc_.findings), included, depth + 1);
      } catch (const ModelError& error) {
        doc_.findings.insert(doc_.findings.end(), error.findings().begin(), error.findings().end());
      }
    }
  }

  void read_parameters(const Value& table) {
    if (table.entries.size() > kMostParameters)
      return refuse(table.at, "parameters",
                    "a file may have " + std::to_string(kMostParameters) + " at most");
    for (const Entry& entry : table.entries) {
      const std::string where = "parameters." + entry.key;
      if (!is_identifier(entry.key) || entry.key == "pi" || entry.key == "position") {
        refuse(entry.at, where,
               "a parameter's name has letters, digits and _ only, and is not pi or position");
        continue;
      }
      Parameter parameter{.name = entry.key,
                          .default_text = "0",
                          .unit = unit_suffix(entry.key),
                          .low = -kNoLimit,
                          .high = kNoLimit};
      // The file that includes another has the last word, key by key; a plain number or text is the default.
      const auto included = parameters_.find(entry.key);
      Value value = entry.value;
      if (included != parameters_.end()) {
        value = included->second;
        value.at = entry.value.at;
        lay_over(value, as_table(entry.value));
      }
      parameters_[entry.key] = as_table(value);
      if (value.is(Value::Kind::table))
        read_parameter_table(value, where, parameter);
      else
        take_number(value, where, parameter);
      const auto same = std::find_if(doc_.parameters.begin(), doc_.parameters.end(),
                                     [&](const Parameter& s) { return s.name == entry.key; });
      if (same != doc_.parameters.end())
        *same = parameter;
      else
        doc_.parameters.push_back(parameter);
    }
  }

  static Value as_table(const Value& value) {
    if (value.is(Value::Kind::table)) return value;
    Value table;
    table.kind = Value::Kind::table;
    table.at = value.at;
    table.entries.push_back({"default", value.at, value});
    return table;
  }

  bool take_number(const Value& value, const std::string& where, Parameter& parameter) {
    if (value.numeric() && std::isfinite(value.number)) {
      parameter.default_text = to_text(value.number);
      return true;
    }
    refuse(value.at, where, "must be a finite number, not " + kind_name(value));
    return false;
  }

  void read_parameter_table(const Value& table, const std::string& where, Parameter& parameter) {
    const std::vector<std::string> known{"default", "min", "max", "whole", "choices", "meaning"};
    if (table.find("choices") != nullptr) return read_choice(table, where, parameter);
    const Value* given = nullptr;
    for (const Entry& entry : table.entries) {
      Parameter bound;
      const Value& value = entry.value;
      const std::string place = where + "." + entry.key;
      if (entry.key == "default") {
        if (take_number(value, place, parameter)) given = &value;
      } else if (entry.key == "min") {
        if (take_number(value, place, bound)) parameter.low = value.number;
      } else if (entry.key == "max") {
        if (take_number(value, place, bound)) parameter.high = value.number;
      } else if (entry.key == "whole") {
        if (!value.is(Value::Kind::boolean)) refuse(value.at, place, "must be true or false");
        if (value.flag) parameter.kind = Parameter::Kind::integer;
      } else if (entry.key == "meaning") {
        if (!value.is(Value::Kind::text)) refuse(value.at, place, "must be a text in quotes");
        parameter.meaning = value.text;
      } else {
        refuse(entry.at, place, "is unknown here" + did_you_mean(entry.key, known));
      }
    }
    if (table.find("default") == nullptr) refuse(table.at, where, "lacks default");
    if (given == nullptr) return;
    const double number = given->number;
    if (parameter.low > parameter.high)
      refuse(table.at, where,
             "has a min above its max, " + to_text(parameter.low) + " above " + to_text(parameter.high));
    else if (number < parameter.low || number > parameter.high)
      refuse(given->at, where + ".default",
             to_text(number) + " is not between min and max: it must be " + parameter.range());
    if (parameter.kind == Parameter::Kind::integer && number != std::floor(number))
      refuse(given->at, where + ".default", to_text(number) + " is no whole number");
  }

  /// A parameter that is one of several texts.
  void read_choice(const Value& table, const std::string& where, Parameter& parameter) {
    parameter.kind = Parameter::Kind::choice;
    parameter.unit.clear();
    for (const Entry& entry : table.entries) {
      const Value& value = entry.value;
      const std::string place = where + "." + entry.key;
      if (entry.key == "choices") {
        if (!value.is(Value::Kind::array))
          refuse(value.at, place, "must be an array of texts, not " + kind_name(value));
        else if (value.items.empty())
          refuse(value.at, place, "must hold one text at least");
        for (const Value& item : value.items)
          if (item.is(Value::Kind::text))
            parameter.choices.push_back(item.text);
          else
            refuse(item.at, place, "must hold texts in quotes, not " + kind_name(item));
      } else if (entry.key == "meaning" && value.is(Value::Kind::text)) {
        parameter.meaning = value.text;
      } else if (entry.key != "default") {
        refuse(entry.at, place,
               "is unknown beside choices" + did_you_mean(entry.key, {"default", "meaning"}));
      }
    }
    const Entry* given = table.find("default");
    const bool right = given != nullptr && given->value.is(Value::Kind::text) &&
                       std::count(parameter.choices.begin(), parameter.choices.end(), given->value.text) > 0;
    if (parameter.choices.empty()) return;  // which is said
    if (!right)
      return refuse(given != nullptr ? given->value.at : table.at, where + ".default",
                    "must be one of " + parameter.range());
    parameter.default_text = given->value.text;
  }

  void read_lists(const Value& table) {
    for (const Entry& entry : table.entries) {
      const std::string where = "lists." + entry.key;
      if (!is_identifier(entry.key)) refuse(entry.at, where, "a list's name has letters, digits and _ only");
      if (!entry.value.is(Value::Kind::array)) {
        refuse(entry.value.at, where, "must be an array of numbers, [ ... ], not " + kind_name(entry.value));
        continue;
      }
      std::vector<double> numbers;
      for (const Value& item : entry.value.items) {
        if (!item.numeric() || !std::isfinite(item.number))
          refuse(item.at, where, "must hold finite numbers, not " + kind_name(item));
        numbers.push_back(item.number);
      }
      doc_.lists[entry.key] = std::move(numbers);
    }
  }

  void read_tables(const Value& table) {
    for (const Entry& entry : table.entries) {
      if (entry.value.is(Value::Kind::table))
        doc_.tables[entry.key] = &entry.value;
      else
        refuse(entry.value.at, "tables." + entry.key, "must be a table, not " + kind_name(entry.value));
    }
  }

  void read_repeats(const Value& value) {
    const std::size_t before = doc_.findings.size();
    read_each_repeat(value);
    if (doc_.findings.size() > before) holds_parts("repeat");
  }

  void read_each_repeat(const Value& value) {
    if (!value.is(Value::Kind::array)) {
      refuse(value.at, "repeat", "must be written [[repeat]], with two brackets");
      return;
    }
    const std::vector<std::string> known{"count", "first", "counter", "nodes", "elements"};
    for (const Value& item : value.items) {
      if (!item.is(Value::Kind::table)) {
        refuse(item.at, "repeat", "must be a table, [[repeat]], not " + kind_name(item));
        continue;
      }
      for (const Entry& entry : item.entries)
        if (std::count(known.begin(), known.end(), entry.key) == 0)
          refuse(entry.at, "repeat." + entry.key, "is unknown here" + did_you_mean(entry.key, known));
      if (item.find("count") == nullptr) refuse(item.at, "repeat", "lacks count");
      doc_.blocks.push_back({section(item, "nodes"), section(item, "elements"), &item});
    }
  }

  Document& doc_;
  std::map<std::string, Value> parameters_;  // as tables
  std::vector<std::string> stack_;
  std::set<std::string> with_parts_;  // files read that have nodes or elements
  int files_ = 0;
};

}  // namespace

std::vector<std::string> Document::run_names() const {
  std::vector<std::string> names;
  if (run != nullptr)
    for (const Entry& entry : run->entries)
      if (entry.value.is(Value::Kind::table) && entry.key != "parameters") names.push_back(entry.key);
  return names;
}

Document read_document(const std::string& text, const std::string& path) {
  Document document;
  const std::string normal = std::filesystem::path(path).lexically_normal().string();
  Value root = parse_toml(text, normal, &document.findings);
  document.at = root.at;
  document.name = std::filesystem::path(path).stem().string();
  DocumentReader(document).read(std::move(root), normal, 0);
  return document;
}

}  // namespace drev::app
