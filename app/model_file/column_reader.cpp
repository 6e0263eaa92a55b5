#include "app/model_file/column_reader.hpp"

#include <algorithm>
#include <filesystem>

#include "app/model_file/key_finder.hpp"

namespace drev::app {

namespace {

constexpr std::size_t kMostFaultsOfArray = 20;  // of one array

class ColumnReader {
 public:
  ColumnReader(const Value& source, const std::string& where, NodeKind kind,
               const std::vector<Column>& columns, ReadContext& context)
      : source_(source), where_(where), kind_(kind), columns_(columns), context_(context) {}

  bool read() {
    before_ = context_.findings.size();
    if (source_.find("csv") != nullptr)
      from_csv();
    else
      from_arrays();
    if (unreadable_ || context_.findings.size() != before_) return false;
    for (const Column& column : columns_) column.values->resize(columns_.front().values->size(), 0.0);
    return true;
  }

 private:
  void from_arrays() {
    FieldKeys keys(kind_);
    for (const Column& column : columns_) keys.add(column.quantity);
    KeyFinder inner(source_, where_, {}, keys, context_);
    for (const Column& column : columns_) {
      const std::string name = column.quantity.name(kind_);
      const KeyFinder::Found* found = inner.find(name);
      if (found == nullptr) {
        if (column.need == Need::required)
          inner.missing(name, spellings(name, column.quantity.dimension(kind_)));
        continue;
      }
      const Value& array = found->entry->value;
      if (!array.is(Value::Kind::array)) {
        context_.findings.push_back(
            fault_at(array.at, where_ + "." + found->entry->key,
                     "must be an array of numbers, [ ... ], not " + kind_name(array)));
        continue;
      }
      column.values->assign(array.items.size(), 0.0);  // what is no number counts in the length, too
      const std::size_t before = context_.findings.size();
      for (std::size_t i = 0; i < array.items.size(); ++i) {
        if (context_.findings.size() - before >= kMostFaultsOfArray) break;
        const std::string place = where_ + "." + found->entry->key;
        if (const auto read = read_number(array.items[i], found->unit, place, context_))
          (*column.values)[i] = *read * found->factor;
      }
    }
    same_length();
  }

  void from_csv() {
    std::vector<std::string> known{"csv"};
    for (const Column& column : columns_) known.push_back(column.quantity.name(kind_));
    for (const Entry& entry : source_.entries)
      if (std::count(known.begin(), known.end(), entry.key) == 0)
        context_.findings.push_back(
            fault_at(entry.at, where_ + "." + entry.key,
                     "is unknown beside csv; there are " + list_of(known) + did_you_mean(entry.key, known)));
    const Value& file = source_.find("csv")->value;
    const std::optional<std::string> name = read_text(file, where_ + ".csv", context_);
    if (!name) return;
    const CsvTable* table = csv_at(file.at, *name);
    if (table == nullptr) return;
    for (const Column& column : columns_) take_column(column, *table, file, *name);
    same_length();
  }

  void take_column(const Column& column, const CsvTable& table, const Value& file, const std::string& name) {
    const std::string quantity = column.quantity.name(kind_);
    const Dimension dimension = column.quantity.dimension(kind_);
    const Entry* asked = source_.find(quantity);
    std::optional<std::string> wanted;
    if (asked != nullptr && !(wanted = read_text(asked->value, where_ + "." + quantity, context_))) return;
    const auto take = [&](const std::string& header, double factor) {
      const auto found = std::find(table.names.begin(), table.names.end(), header);
      if (found == table.names.end()) return false;
      *column.values = table.columns[static_cast<std::size_t>(found - table.names.begin())];
      for (double& value : *column.values) value *= factor;
      return true;
    };
    if (dimension == Dimension::none && take(wanted.value_or(quantity), 1.0)) return;
    std::vector<std::string> fitting;
    for (const Unit& unit : units_of(dimension)) {
      if (wanted && unit_suffix(*wanted) != unit.suffix) continue;
      const std::string header = wanted.value_or(quantity + "_" + unit.suffix);
      if (take(header, unit.factor)) fitting.push_back(header);
    }
    if (fitting.size() > 1)
      context_.findings.push_back(fault_at(file.at, where_,
                                           name + " has several columns that fit, " + list_of(fitting) +
                                               "; say which is meant: " + quantity + " = \"" +
                                               fitting.front() + "\""));
    if (!fitting.empty()) return;
    if (!wanted && column.need == Need::optional) return;
    const std::string right = spellings(quantity, dimension);
    const bool there = wanted && std::count(table.names.begin(), table.names.end(), *wanted) > 0;
    context_.findings.push_back(
        fault_at(asked ? asked->value.at : file.at, where_,
                 there ? "the column " + *wanted + " must end in a unit, as in " + right
                       : name + " has no column " + wanted.value_or(right) + "; it has " +
                             list_of(table.names) + did_you_mean(wanted.value_or(quantity), table.names)));
  }

  /// Relative to the file that names it; null if it cannot be read.
  const CsvTable* csv_at(const Position& at, const std::string& name) {
    std::filesystem::path path(name);
    if (path.is_relative()) path = std::filesystem::path(*at.file).parent_path() / path;
    const auto [place, fresh] = context_.csv.try_emplace(path.string());
    if (fresh) {
      try {
        place->second = read_csv(path.string(), at);
      } catch (const ModelError& error) {
        context_.findings.insert(context_.findings.end(), error.findings().begin(), error.findings().end());
      }
    }
    unreadable_ = !place->second;
    return unreadable_ ? nullptr : &*place->second;
  }

  void same_length() {
    const Column& first = columns_.front();
    if (first.values->empty() && context_.findings.size() != before_) return;  // it is what has a fault
    if (std::all_of(columns_.begin(), columns_.end(), [](const Column& c) { return c.values->empty(); }))
      context_.findings.push_back(
          fault_at(source_.at, where_, "holds no numbers; leave it out, or give some"));
    for (const Column& column : columns_)
      if (!column.values->empty() && column.values->size() != first.values->size())
        context_.findings.push_back(fault_at(
            source_.at, where_,
            column.quantity.name(kind_) + " has " + std::to_string(column.values->size()) + " numbers, " +
                first.quantity.name(kind_) + " has " + std::to_string(first.values->size())));
  }

  const Value& source_;
  const std::string& where_;
  NodeKind kind_;
  const std::vector<Column>& columns_;
  ReadContext& context_;
  std::size_t before_ = 0;  // number of findings before it
  bool unreadable_ = false;
};

}  // namespace

bool read_columns(const Value& source, const std::string& where, NodeKind kind,
                  const std::vector<Column>& columns, ReadContext& context) {
  return ColumnReader(source, where, kind, columns, context).read();
}

}  // namespace drev::app
