#pragma once
/// A table of numbers in a CSV file (RFC 4180, with or without a byte-order mark): a header of column names, then
/// rows. Lines that are empty or begin with '#' are passed over. A name that begins with = + - @ may have a ' before
/// it, which is not part of it.
#include <algorithm>
#include <string>
#include <vector>

#include "app/model_file/tree.hpp"

namespace drev::app {

struct CsvCell {
  std::string text{};
  int line = 1, column = 1;  ///< where it begins
};

/// A CSV text row by row (RFC 4180): cells in double quotes may hold commas, line ends and doubled quotes; those
/// without lose the blanks about them. Where the first row has semicolons and no comma, semicolons separate the cells.
/// A byte-order mark is passed over.
class CsvRows {
 public:
  explicit CsvRows(const std::string& text)
      : text_(text), at_(text.starts_with("\xef\xbb\xbf") ? 3 : 0), start_(at_) {
    while (at_ < text_.size() && (text_[at_] == '#' || ends_line())) skip_line();
    const std::string first = text_.substr(at_, text_.find('\n', at_) - at_);
    if (first.find(';') != first.npos && first.find(',') == first.npos) separator_ = ';';
  }

  /// The next row that is neither empty nor a comment; false: there is none. fault: nothing, or what is wrong with
  /// the last cell, which ends the text.
  bool next(std::vector<CsvCell>& cells, std::string& fault) {
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

  CsvCell cell(std::string& fault) {
    skip_blanks();
    CsvCell cell{.line = line_, .column = static_cast<int>(at_ - start_) + 1};
    if (at_ < text_.size() && text_[at_] == '"') {
      quoted(cell, fault);
      return cell;
    }
    while (!ends_line() && text_[at_] != separator_) cell.text += text_[at_++];
    while (cell.text.ends_with(' ') || cell.text.ends_with('\t')) cell.text.pop_back();
    return cell;
  }
  void quoted(CsvCell& cell, std::string& fault) {
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

struct CsvTable {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;
};

/// Throws ModelError with every fault, by line and column of the CSV file; one that cannot be read is blamed
/// on the place that names it.
CsvTable read_csv(const std::string& path, const Position& named_at);

}  // namespace drev::app
