#include "tests/stability/coverage/coverage_table.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <ostream>

namespace coverage {

namespace {

constexpr double kLastDigit = 4e-16;  // of a double's own last digit, relative

double median(std::vector<double> x) {
  if (x.empty()) return 0.0;
  const auto middle = x.begin() + static_cast<std::ptrdiff_t>(x.size() / 2);
  std::nth_element(x.begin(), middle, x.end());
  return *middle;
}

void print_rows(std::ostream& out, const std::map<std::string, Table::Row>& rows) {
  out << "| figure | tried | held | share | worst ratio | median ratio | undecided "
         "|\n|---|---|---|---|---|---|---|\n";
  for (const auto& [kind, row] : rows)
    out << "| " << kind << " | " << row.tried << " | " << row.held << " | " << std::fixed
        << std::setprecision(4) << row.share() << " | " << std::defaultfloat << std::setprecision(3)
        << row.worst << " | " << median(row.ratios) << " | " << row.undecided << " |\n";
}

}  // namespace

void Table::enter(Row& row, const Comparison& c, double ratio, bool undecided) {
  if (undecided) {
    ++row.undecided;
    return;
  }
  ++row.tried;
  row.held += ratio <= 1.0;
  row.ratios.push_back(ratio);
  if (ratio > row.worst) row.worst = ratio, row.worst_case = c;
}

void Table::add(const std::string& kind, const Comparison& c) {
  const double actual = std::abs(c.value - c.truth);
  const double stated = c.stated + kLastDigit * std::abs(c.truth);
  // What the reference does not know counts for drev up to the size of the statement; beyond, nothing is said.
  const bool undecided = c.truth_error > std::max(stated, 0.1 * actual);
  const double left = std::max(0.0, actual - c.truth_error);
  const double ratio = left == 0.0    ? 0.0
                       : stated > 0.0 ? left / stated
                                      : std::numeric_limits<double>::infinity();
  enter(errors_[kind], c, std::isnan(actual) ? std::numeric_limits<double>::infinity() : ratio, undecided);
  if (!undecided && !(ratio <= 1.0)) {
    missed_.push_back(c);
    missed_.back().where = kind + ": " + c.where;
  }
}

void Table::add_interval(const std::string& kind, const Comparison& c) {
  const double width = std::hypot(c.stated, c.truth_error);
  enter(intervals_[kind], c, width > 0.0 ? std::abs(c.value - c.truth) / width : 0.0, false);
}

void Table::add_claim(const std::string& kind, const std::string& where, bool holds) {
  add(kind, {.where = where, .value = holds ? 0.0 : 1.0});
}

void Table::append(Row& to, const Row& from) {
  to.tried += from.tried, to.held += from.held, to.undecided += from.undecided;
  to.ratios.insert(to.ratios.end(), from.ratios.begin(), from.ratios.end());
  if (from.worst > to.worst) to.worst = from.worst, to.worst_case = from.worst_case;
}

std::map<std::string, Table::Row> Table::grouped(const std::map<std::string, Row>& rows) {
  std::map<std::string, Row> groups;
  for (const auto& [kind, row] : rows) {
    const std::size_t open = kind.find(" ["), close = kind.find(']');
    append(groups[open == std::string::npos ? kind : kind.substr(0, open) + kind.substr(close + 1)], row);
  }
  return groups;
}

void Table::merge(const Table& other) {
  for (const auto* from : {&other.errors_, &other.intervals_}) {
    auto& to = from == &other.errors_ ? errors_ : intervals_;
    for (const auto& [kind, row] : *from) {
      append(to[kind], row);
    }
  }
  missed_.insert(missed_.end(), other.missed_.begin(), other.missed_.end());
  notes_.insert(notes_.end(), other.notes_.begin(), other.notes_.end());
}

Table::Row Table::all() const {
  Row sum;
  for (const auto& [kind, row] : errors_) append(sum, row);
  return sum;
}

void Table::print(std::ostream& out, bool list_missed, bool every_channel) const {
  print_rows(out, every_channel ? errors_ : grouped(errors_));
  const Row sum = all();
  out << "\nstated errors: " << sum.held << " of " << sum.tried << " hold (" << std::fixed
      << std::setprecision(2) << 100.0 * sum.share() << " %), " << sum.undecided << " undecided\n"
      << std::defaultfloat;
  if (!intervals_.empty()) {
    out << "\n95 % intervals:\n\n";
    print_rows(out, intervals_);
  }
  for (const std::string& note : notes_) out << note << "\n";
  if (!list_missed || missed_.empty()) return;
  out << "\nnot held (value +- stated; truth +- its error):\n";
  for (const Comparison& c : missed_)
    out << "  " << c.where << ": " << std::setprecision(15) << c.value << " +- " << std::setprecision(3)
        << c.stated << "; " << std::setprecision(15) << c.truth << " +- " << std::setprecision(3)
        << c.truth_error << "\n";
}

}  // namespace coverage
