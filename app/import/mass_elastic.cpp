#include <drev/app/model_file/units.hpp>
#include <drev/core/error.hpp>
#include <drev/models/parameters.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>

#include "app/base/text_layout.hpp"
#include "app/import/imported.hpp"
#include "app/model_file/csv_table.hpp"
#include "app/model_file/writing/field_writer.hpp"

namespace drev::app {

namespace {

struct MassElasticColumn {
  const char* name;
  Dimension dimension;
  double low;
};
/// What a row says of the shaft to the next one.
constexpr const char* kOfShaft[] = {"stiffness", "damping", "ratio", "diameter", "bore"};
constexpr MassElasticColumn kColumns[] = {{"inertia", Dimension::inertia, 0.0},
                                          {"stiffness", Dimension::torsional_stiffness, 0.0},
                                          {"damping", Dimension::torsional_damping, 0.0},
                                          {"ground_damping", Dimension::torsional_damping, 0.0},
                                          {"ratio", Dimension::none, -HUGE_VAL},
                                          {"diameter", Dimension::length, 0.0},
                                          {"bore", Dimension::length, 0.0}};

/// "; did you mean ...?" for a column by another spelling, or by its symbol in the literature; empty: it is like none.
std::string column_hint(const std::string& cell) {
  constexpr std::pair<const char*, const char*> kSymbols[] = {
      {"j", "inertia"}, {"k", "stiffness"}, {"c", "damping"}, {"d", "diameter"}};
  std::string lower = cell;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  const std::string name = lower.substr(0, lower.find_first_of(" [(/_"));
  std::vector<std::string> names{"node", "name"};
  for (const MassElasticColumn& column : kColumns) names.emplace_back(column.name);
  std::string nearest = name.size() > 3 ? nearest_name(name, names) : "";
  for (const auto& [symbol, meaning] : kSymbols)
    if (name == symbol) nearest = meaning;
  for (const MassElasticColumn& column : kColumns)
    if (lower.starts_with(column.name)) nearest = column.name;
  for (const MassElasticColumn& column : kColumns)
    if (column.name == nearest) return "; did you mean " + spellings(column.name, column.dimension) + "?";
  return nearest.empty() ? "" : "; did you mean " + nearest + "?";
}

class MassElasticReader {
 public:
  MassElasticReader(const std::string& text, std::string file)
      : text_(text), file_(std::move(file)), model_(stem()) {}

  ImportedModel read() {
    CsvRows rows(text_);
    int number = 0;
    std::vector<CsvCell> row;
    for (std::string why; why.empty() && rows.next(row, why);) {
      number = row.front().line;
      if (!why.empty()) {
        fault(row.back().line, why);
        break;
      }
      std::vector<std::string> cells;
      for (const CsvCell& cell : row) cells.push_back(cell.text);
      if (cells.front().starts_with('#') || cells == std::vector<std::string>{""}) continue;
      headers_.empty() ? read_head(cells, number) : read_row(cells, number);
    }
    if (headers_.empty()) fault(0, "has no line with the names of its columns");
    if (findings_.empty() && rows_.size() < 2) fault(number, "has fewer than two masses");
    if (findings_.empty()) build();
    // A column that is not taken may be what the train lacks.
    for (const auto& [line, sentence] : unknown_)
      findings_.empty() ? model_.not_taken(sentence) : fault(line, sentence);
    if (!findings_.empty()) throw ModelError(std::move(findings_));
    return std::move(model_);
  }

 private:
  struct Row {
    int line = 0;
    std::string node;
    std::map<std::string, double> values;  ///< in SI
    std::optional<double> get(const std::string& name) const {
      const auto found = values.find(name);
      return found == values.end() ? std::nullopt : std::optional(found->second);
    }
    /// A table may fill the columns that do not apply with zeros.
    bool has(const std::string& name) const { return get(name).value_or(0.0) != 0.0; }
  };
  struct Header {
    std::string name;  ///< empty: not taken
    double factor = 1.0, low = 0.0;
    std::string column = {};  ///< as the file spells it, with its unit
  };

  std::string stem() const {
    const std::size_t slash = file_.rfind('/');
    const std::string name = slash == file_.npos ? file_ : file_.substr(slash + 1);
    return name.substr(0, name.rfind('.'));
  }
  void fault(int line, const std::string& what, const std::string& column = "",
             const std::string& value = "") {
    findings_.push_back({file_ + (line > 0 ? ":" + std::to_string(line) : ""), column, value, "", what});
  }

  void read_head(const std::vector<std::string>& cells, int line) {
    std::vector<std::string> known{"node"};
    for (const MassElasticColumn& column : kColumns)
      known.push_back(spellings(column.name, column.dimension));
    for (const std::string& cell : cells) {
      Header header;
      if (cell == "node" || cell == "name") header = {"node", 1.0, 0.0, cell};
      for (const MassElasticColumn& column : kColumns) {
        if (column.dimension == Dimension::none && cell == column.name)
          header = {column.name, 1.0, column.low, cell};
        for (const Unit& unit : units_of(column.dimension))
          if (cell == std::string(column.name) + "_" + unit.suffix)
            header = {column.name, unit.factor, column.low, cell};
      }
      for (const Header& other : headers_)
        if (!header.name.empty() && other.name == header.name)
          fault(line,
                "the columns " + other.column + " and " + cell + " state the same; one of them must go");
      if (header.name.empty()) {
        bool refused = false;
        const auto refuse = [&](const std::string& what) {
          fault(line, what);
          refused = true;
        };
        for (const MassElasticColumn& column : kColumns) {
          if (cell == column.name)
            refuse("the column " + cell + " has no unit; write " + spellings(column.name, column.dimension));
          else if (column.dimension != Dimension::none && cell.starts_with(std::string(column.name) + "_"))
            refuse("the column " + cell + " has a unit that it cannot have; write " +
                   spellings(column.name, column.dimension));
        }
        const std::string hint = column_hint(cell);
        const std::string sentence =
            "the column \"" + cell + "\"" + (hint.empty() ? "; there are " + join(known, "; ") : hint);
        if (!refused) unknown_.emplace_back(line, sentence);
      }
      headers_.push_back(header);
    }
    for (const char* needed : {"inertia"})
      if (std::none_of(headers_.begin(), headers_.end(), [&](const Header& h) { return h.name == needed; }))
        fault(line, "lacks the column " + spellings("inertia", Dimension::inertia));
  }

  void read_row(const std::vector<std::string>& cells, int line) {
    if (cells.size() > headers_.size()) return fault(line, "has more cells than the line of names");
    Row row{line, "mass_" + std::to_string(rows_.size() + 1), {}};
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const Header& header = headers_[c];
      if (cells[c].empty() || header.name.empty()) continue;
      if (header.name == "node") {
        row.node = cells[c];
        continue;
      }
      double value = 0.0;
      if (!read_number(cells[c], value) || !std::isfinite(value) || value < header.low)
        fault(line, std::string("must be a number") + (header.low == 0.0 ? " >= 0" : "") + ", with a point",
              header.column, cells[c]);
      row.values[header.name] = value * header.factor;
    }
    for (const Row& other : rows_)
      if (other.node == row.node)
        fault(line, "the node " + row.node + " is there already, in line " + std::to_string(other.line));
    rows_.push_back(std::move(row));
  }

  void build() {
    for (const Row& row : rows_) model_.add_node(row.node);
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const Row& row = rows_[r];
      const std::string at = "node = " + toml_text(row.node);
      if (const auto inertia = row.get("inertia"); inertia && *inertia > 0.0)
        model_.add_element("J_" + row.node,
                           "type = \"inertia\", " + at + ", inertia_kg_m2 = " + toml_number(*inertia));
      if (const auto damping = row.get("ground_damping"); damping && *damping > 0.0)
        model_.add_element("c_" + row.node,
                           "type = \"dashpot\", " + at + ", damping_Nms_per_rad = " + toml_number(*damping));
      if (r + 1 < rows_.size())
        join_next(row, rows_[r + 1]);
      else if (std::any_of(std::begin(kOfShaft), std::end(kOfShaft),
                           [&](const char* c) { return row.has(c); }))
        model_.not_taken("the shaft behind the last mass, " + row.node);
    }
  }

  void join_next(const Row& row, const Row& next) {
    const std::string nodes = "nodes = " + toml_texts({row.node, next.node}),
                      name = row.node + "_" + next.node;
    const auto stiffness = row.get("stiffness"), ratio = row.get("ratio"), damping = row.get("damping");
    for (const char* other : {"stiffness", "damping"})
      if (row.has("ratio") && row.has(other))
        return fault(row.line, std::string("has a ") + other + " and a ratio; a gear is a line of its own");
    if (row.has("ratio"))
      model_.add_element(name, "type = \"ideal_gear\", " + nodes + ", ratio = " + toml_number(*ratio));
    else if (stiffness && *stiffness > 0.0)
      model_.add_element(name, "type = \"shaft_spring\", " + nodes +
                                   ", stiffness_Nm_per_rad = " + toml_number(*stiffness) +
                                   (damping ? ", damping_Nms_per_rad = " + toml_number(*damping) : ""));
    else if (damping && *damping > 0.0)
      model_.add_element(name,
                         "type = \"dashpot\", " + nodes + ", damping_Nms_per_rad = " + toml_number(*damping));
    else
      return fault(
          row.line,
          "has neither a stiffness, a damping nor a ratio other than 0 to the next mass, " + next.node);
    const auto diameter = row.get("diameter");
    if (row.has("ratio") && row.has("diameter"))
      model_.not_taken("the diameter of the gear " + name);
    else if (!row.has("diameter") && row.has("bore"))
      model_.not_taken("the bore of " + name + ", which has no diameter");
    else if (row.has("diameter"))
      model_.add_section(name, "diameter_m = " + toml_number(*diameter) +
                                   (row.get("bore") ? ", bore_m = " + toml_number(*row.get("bore")) : ""));
  }

  const std::string& text_;
  std::string file_;
  ImportedModel model_;
  std::vector<Header> headers_;
  std::vector<std::pair<int, std::string>> unknown_;  ///< columns: their line, and a sentence each
  std::vector<Row> rows_;
  std::vector<Finding> findings_;
};

}  // namespace

ImportedModel import_mass_elastic(const std::string& text, const std::string& file) {
  return MassElasticReader(text, file).read();
}

}  // namespace drev::app
