#include "app/model_file/document.hpp"

#include <drev/app/model_file/units.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>

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
    const Value& table = doc_.roots.back();
    const bool main = depth == 0;
    stack_.push_back(path);
    ++files_;
    check_format(table);
    check_keys(table, main);
    if (const Entry* include = table.find("include")) read_includes(include->value, path, depth);
    if (main) {
      read_text_key(table, "name", doc_.name);
      read_text_key(table, "summary", doc_.summary);
      read_text_key(table, "note", doc_.note);
      if (const Value* run = section(table, "run")) doc_.run = run;
    }
    if (const Value* parameters = section(table, "parameters")) read_parameters(*parameters);
    if (const Value* lists = section(table, "lists")) read_lists(*lists);
    if (const Value* tables = section(table, "tables")) read_tables(*tables);
    if (const Value* nodes = section(table, "nodes"), *elements = section(table, "elements");
        nodes != nullptr || elements != nullptr)
      doc_.blocks.push_back({nodes, elements, nullptr});
    if (const Entry* repeat = table.find("repeat")) read_repeats(repeat->value);
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

  void check_keys(const Value& table, bool main) {
    const std::vector<std::string> of_main{"name", "summary", "note", "run"};
    std::vector<std::string> known{"format", "include", "parameters", "lists",
                                   "tables", "nodes",   "elements",   "repeat"};
    if (main) known.insert(known.end(), of_main.begin(), of_main.end());
    for (const Entry& entry : table.entries) {
      if (std::count(known.begin(), known.end(), entry.key) > 0) continue;
      if (std::count(of_main.begin(), of_main.end(), entry.key) > 0)
        refuse(entry.at, entry.key, "can stand in the main file only, not in one that is included");
      else
        refuse(entry.at, entry.key, "is unknown at the top of a model file" + did_you_mean(entry.key, known));
    }
  }

  const Value* section(const Value& table, const char* name) {
    const Entry* entry = table.find(name);
    if (entry == nullptr) return nullptr;
    if (entry->value.is(Value::Kind::table)) return &entry->value;
    refuse(entry->at, name, "must be a table, [" + std::string(name) + "], not " + kind_name(entry->value));
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
      if (depth >= kDeepestInclude || files_ >= kMostFiles) {
        refuse(name->at, "include",
               "at most " + std::to_string(kMostFiles) + " files, " + std::to_string(kDeepestInclude) +
                   " deep, can be included");
        continue;
      }
      try {
        read(parse_toml(read_text(included, &name->at), included), included, depth + 1);
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
      const Value& value = entry.value;
      if (value.is(Value::Kind::table))
        read_parameter_table(value, where, parameter);
      else
        take_number(value, where, parameter);
      // The file that includes another has the last word.
      const auto same = std::find_if(doc_.parameters.begin(), doc_.parameters.end(),
                                     [&](const Parameter& s) { return s.name == entry.key; });
      if (same != doc_.parameters.end())
        *same = parameter;
      else
        doc_.parameters.push_back(parameter);
    }
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
    const std::vector<std::string> known{"default", "min", "max", "whole", "meaning"};
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
      refuse(table.at, where, "has a min above its max");
    else if (number < parameter.low || number > parameter.high)
      refuse(given->at, where + ".default", to_text(number) + " is not between min and max");
    if (parameter.kind == Parameter::Kind::integer && number != std::floor(number))
      refuse(given->at, where + ".default", to_text(number) + " is no whole number");
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
  std::vector<std::string> stack_;
  int files_ = 0;
};

}  // namespace

std::vector<std::string> Document::run_names() const {
  std::vector<std::string> names;
  if (run != nullptr)
    for (const Entry& entry : run->entries)
      if (entry.value.is(Value::Kind::table)) names.push_back(entry.key);
  return names;
}

Document read_document(const std::string& text, const std::string& path) {
  Document document;
  const std::string normal = std::filesystem::path(path).lexically_normal().string();
  Value root = parse_toml(text, normal);
  document.at = root.at;
  document.name = std::filesystem::path(path).stem().string();
  DocumentReader(document).read(std::move(root), normal, 0);
  return document;
}

}  // namespace drev::app
