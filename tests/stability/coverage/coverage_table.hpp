#pragma once
/// Counts, for each kind of figure, how many stated errors hold.
#include <iosfwd>
#include <map>
#include <string>
#include <vector>

namespace coverage {

/// A figure of drev with the error that it states, beside the reference with its own.
struct Comparison {
  std::string where;  ///< model, channel: for the list of what does not hold
  double value = 0.0, stated = 0.0;
  double truth = 0.0, truth_error = 0.0;
};

class Table {
 public:
  struct Row {
    long tried = 0, held = 0, undecided = 0;  ///< undecided: the reference does not know well enough
    std::vector<double> ratios = {};          ///< actual over stated error
    double worst = 0.0;
    Comparison worst_case = {};
    double share() const { return tried > 0 ? static_cast<double>(held) / static_cast<double>(tried) : 1.0; }
  };
  /// 95 % intervals are counted apart from errors.
  void add(const std::string& kind, const Comparison& c);
  void add_interval(const std::string& kind, const Comparison& c);
  /// Something that must hold without a number: "reached" said of what is.
  void add_claim(const std::string& kind, const std::string& where, bool holds);
  void add_note(const std::string& text) { notes_.push_back(text); }
  void merge(const Table& other);

  const std::map<std::string, Row>& errors() const { return errors_; }
  const std::map<std::string, Row>& intervals() const { return intervals_; }
  const std::vector<Comparison>& missed() const { return missed_; }
  /// Over all kinds of errors.
  Row all() const;
  /// A row a kind; of kinds "... [channel] ..." one for all channels, or (every_channel) one each.
  void print(std::ostream& out, bool list_missed, bool every_channel = false) const;

 private:
  static void append(Row& to, const Row& from);
  static std::map<std::string, Row> grouped(const std::map<std::string, Row>& rows);
  static void enter(Row& row, const Comparison& c, double ratio, bool undecided);
  std::map<std::string, Row> errors_, intervals_;
  std::vector<Comparison> missed_;
  std::vector<std::string> notes_;
};

}  // namespace coverage
