#include "app/model_file/writing/field_writer.hpp"

#include <drev/core/error.hpp>
#include <drev/elements/formula.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

namespace drev::app {

namespace {

constexpr std::size_t kLongestInline = 12;  // numbers of a table that stays where it is used

bool bare(const std::string& key) {
  return !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

}  // namespace

std::string toml_number(double value) {
  const std::string text = to_text(value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

std::string toml_text(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      char code[8];
      std::snprintf(code, sizeof code, "\\u%04x", static_cast<unsigned>(c));
      quoted += code;
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

std::string toml_key(const std::string& key) { return bare(key) ? key : toml_text(key); }

std::string toml_texts(const std::vector<std::string>& texts) {
  std::string all = "[";
  for (const std::string& text : texts) all += (all.size() == 1 ? "" : ", ") + toml_text(text);
  return all + "]";
}

std::string TableStore::name_of(const std::string& body, const std::string& wish) {
  const auto [place, fresh] = names_.emplace(body, wish);
  if (fresh) tables_.emplace_back(wish, body);
  return place->second;
}

std::string TableStore::text() const {
  std::string all;
  for (const auto& [name, body] : tables_) all += toml_key(name) + " = " + body + "\n";
  return all.empty() ? all : "[tables]\n" + all + "\n";
}

bool FieldWriter::is_default(const std::string& name, const std::string& text) const {
  const FieldKeys::Key* key = defaults_.find(name);
  return key != nullptr && key->default_text == text;
}

void FieldWriter::number(const Quantity& quantity, double& value, Need need) {
  const std::string name = quantity.name(kind);
  const FieldKeys::Key* key = defaults_.find(name);
  if (std::isnan(value)) return;
  if (need == Need::optional && key != nullptr && key->default_number == value &&
      std::signbit(key->default_number) == std::signbit(value))
    return;
  add(si_key(name, quantity.dimension(kind)), toml_number(value));
}

void FieldWriter::whole(const std::string& name, int& value, Need /*need*/) {
  if (!is_default(name, std::to_string(value))) add(name, std::to_string(value));
}
void FieldWriter::flag(const std::string& name, bool& value) {
  const std::string text = value ? "true" : "false";
  if (!is_default(name, text)) add(name, text);
}
void FieldWriter::text(const std::string& name, std::string& value) {
  if (!is_default(name, value)) add(name, toml_text(value));
}
/// By its whole path: the file that is written may stand anywhere.
void FieldWriter::file(const std::string& name, std::string& path, Need /*need*/) {
  add(name, toml_text(std::filesystem::absolute(path).lexically_normal().string()));
}

void FieldWriter::texts(const std::string& name, std::vector<std::string>& values) {
  if (!values.empty()) add(name, toml_texts(values));
}
void FieldWriter::choice(const std::string& name, const std::vector<std::string>& words, int& index) {
  const std::string& word = words[static_cast<std::size_t>(index)];
  if (!is_default(name, word)) add(name, toml_text(word));
}

void FieldWriter::formula(const std::string& name, const std::vector<FormulaVariable>& variables,
                          const std::string& /*unit*/, std::optional<Formula>& formula) {
  if (!formula) return;
  std::vector<std::string> names;
  for (const FormulaVariable& v : variables) {
    names.resize(std::max(names.size(), static_cast<std::size_t>(v.number) + 1));
    if (v.factor == 1.0) names[static_cast<std::size_t>(v.number)] = v.name;
  }
  add(name, toml_text(formula->text(names)));
}

bool FieldWriter::columns(const std::string& name, const std::vector<Column>& columns) {
  // Without a row it is not given.
  if (std::all_of(columns.begin(), columns.end(), [](const Column& c) { return c.values->empty(); }))
    return true;
  std::string body;
  std::size_t count = 0;
  for (const Column& column : columns) {
    const std::vector<double>& values = *column.values;
    const bool zero =
        std::all_of(values.begin(), values.end(), [](double v) { return v == 0.0 && !std::signbit(v); });
    if (column.need == Need::optional && zero) continue;
    body += (body.empty() ? "{ " : ", ") +
            si_key(column.quantity.name(kind), column.quantity.dimension(kind)) + " = [";
    for (std::size_t i = 0; i < values.size(); ++i) body += (i == 0 ? "" : ", ") + toml_number(values[i]);
    body += "]";
    count += values.size();
  }
  body += " }";
  add(name, count > kLongestInline ? toml_text(store_.name_of(body, owner_ + "_" + name)) : body);
  return true;
}

bool FieldWriter::group(const std::string& name, const std::function<void(Fields&)>& list) {
  const FieldKeys none(kind);  // inside a group everything is written
  FieldWriter inner(kind, none, store_, owner_);
  list(inner);
  add(name, inner.inline_table());
  return true;
}

bool FieldWriter::rows(const std::string& name, std::size_t count,
                       const std::function<void(std::size_t)>& /*resize*/,
                       const std::function<void(Fields&, std::size_t)>& list) {
  std::string body = "[";
  for (std::size_t i = 0; i < count; ++i) {
    const FieldKeys none(kind);
    FieldWriter inner(kind, none, store_, owner_ + "_" + std::to_string(i + 1));
    list(inner, i);
    body += (i == 0 ? "" : ", ") + inner.inline_table();
  }
  add(name, body + "]");
  return true;
}

std::string FieldWriter::inline_table() const {
  std::string all;
  for (const auto& [key, value] : parts_) all += (all.empty() ? "{ " : ", ") + key + " = " + value;
  return all.empty() ? "{}" : all + " }";
}

}  // namespace drev::app
