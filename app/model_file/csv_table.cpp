#include "app/model_file/csv_table.hpp"

#include <drev/models/parameters.hpp>

#include <algorithm>
#include <cmath>

namespace drev::app {

namespace {

constexpr std::size_t kMostBadRows = 20;

struct Cell {
  std::string text{};
  int line = 1, column = 1;  ///< where it begins
};

/// A CSV text row by row (RFC 4180): cells in double quotes may hold commas, line ends and doubled quotes; those
/// without lose the blanks about them. Where the first row has semicolons and no comma, semicolons separate the cells.
/// A byte-order mark is passed over.
class Rows {
 public:
  explicit Rows(const std::string& text)
      : text_(text), at_(text.starts_with("\xef\xbb\xbf") ? 3 : 0), start_(at_) {
    while (at_ < text_.size() && (text_[at_] == '#' || ends_line())) skip_line();
    const std::string first = text_.substr(at_, text_.find('\n', at_) - at_);
    if (first.find(';') != first.npos && first.find(',') == first.npos) separator_ = ';';
  }

  /// The next row that is neither empty nor a comment; false: there is none. fault: nothing, or what is wrong with
  /// the last cell, which ends the text.
  bool next(std::vector<Cell>& cells, std::string& fault) {
    while (at_ < text_.size() && (text_[at_] == '#' || ends_line())) skip_line();
    cells.clear();
    if (at_ >= text_.size()) return false;
    do {
      cells.push_back(cell(fault));
    } while (fault.empty() && at_ < text_.size() && text_[at_] == separator_ && ++at_ > 0);
    if (fault.empty()) skip_line();
    return true;
  }

 private:
  bool ends_line() const {
    return at_ >= text_.size() || text_[at_] == '\n' || text_.compare(at_, 2, "\r\n") == 0 ||
           (text_[at_] == '\r' && at_ + 1 == text_.size());
  }
  void new_line() { ++line_, start_ = at_; }
  void skip_line() {
    at_ = std::min(text_.find('\n', at_), text_.size());
    if (at_ < text_.size()) ++at_, new_line();
  }
  void skip_blanks() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
  }

  Cell cell(std::string& fault) {
    skip_blanks();
    Cell cell{.line = line_, .column = static_cast<int>(at_ - start_) + 1};
    if (at_ < text_.size() && text_[at_] == '"') {
      quoted(cell, fault);
      return cell;
    }
    while (!ends_line() && text_[at_] != separator_) cell.text += text_[at_++];
    while (cell.text.ends_with(' ') || cell.text.ends_with('\t')) cell.text.pop_back();
    return cell;
  }
  void quoted(Cell& cell, std::string& fault) {
    for (++at_; at_ < text_.size(); ++at_) {
      if (text_[at_] == '"') {
        if (text_.compare(at_, 2, "\"\"") != 0) break;
        ++at_;
      }
      cell.text += text_[at_];
      if (text_[at_] == '\n') ++line_, start_ = at_ + 1;
    }
    if (at_ >= text_.size()) {
      fault = "the quotes that begin here do not end";
      return;
    }
    ++at_;
    skip_blanks();
    if (!ends_line() && text_[at_] != separator_)
      fault = "more than blanks follows the quotes that begin here";
  }

  const std::string& text_;
  std::size_t at_, start_;  // here, and where this line begins
  int line_ = 1;
  char separator_ = ',';
};

/// A name that drev would have written with ' before it, so that no spreadsheet takes it for a formula.
std::string column_name(const std::string& cell) {
  const std::size_t first = cell.find_first_not_of('\'');
  const bool marked =
      first != cell.npos && first > 0 && std::string("=+-@").find(cell[first]) != std::string::npos;
  return marked ? cell.substr(1) : cell;
}

}  // namespace

// No message quotes the file: it may be any that this user can read, and a model may come from anyone.
CsvTable read_csv(const std::string& path, const Position& named_at) {
  const std::string text = read_text(path, &named_at);
  const auto file = std::make_shared<const std::string>(path);
  CsvTable table;
  std::vector<Finding> findings;
  const auto refuse = [&](const Cell& at, const char* where, const std::string& sentence) {
    findings.push_back(fault_at({file, at.line, at.column}, where, sentence));
  };
  Rows rows(text);
  std::vector<Cell> cells;
  std::string fault;
  std::size_t count = 0;
  while (findings.size() < kMostBadRows && fault.empty() && rows.next(cells, fault)) {
    const bool header = table.names.empty();
    if (!fault.empty()) {
      refuse(cells.back(), header ? "header" : "row", fault);
    } else if (header) {
      for (const Cell& cell : cells) {
        const std::string name = column_name(cell.text);
        const auto same = std::find(table.names.begin(), table.names.end(), name);
        if (name.empty())
          refuse(cell, "header", "a column has no name");
        else if (same != table.names.end())
          refuse(cell, "header",
                 "has the name of column " + std::to_string(same - table.names.begin() + 1) + " once more");
        table.names.push_back(name);
      }
      table.columns.resize(table.names.size());
    } else if (cells.size() != table.names.size()) {
      refuse(
          cells.front(), "row",
          "has " + std::to_string(cells.size()) + " cells, the header " + std::to_string(table.names.size()));
    } else {
      ++count;
      for (std::size_t c = 0; c < cells.size(); ++c) {
        double value = 0.0;
        if (!drev::read_number(cells[c].text, value) || !std::isfinite(value))
          refuse(cells[c], "row", "the cell of column " + std::to_string(c + 1) + " is no finite number");
        table.columns[c].push_back(value);
      }
    }
  }
  if (findings.empty() && table.names.empty()) refuse({}, "header", "the file is empty");
  if (findings.empty() && count == 0) refuse({}, "row", "the file has a header and no rows");
  if (!findings.empty()) throw ModelError(std::move(findings));
  return table;
}

}  // namespace drev::app
