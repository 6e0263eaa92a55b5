#pragma once
/// Values of options as numbers. A value that cannot be read, or is out of its range, goes to findings with
/// the range that would be right; the ranges are those that the solvers check.
#include <drev/core/error.hpp>
#include <drev/core/range.hpp>

#include <optional>
#include <string>
#include <vector>

namespace drev::app {

/// A time [s]. limit: what the high end is, such as "(the run's duration)"; an infinite high end is named by
/// it alone.
double read_time(const char* option, const std::string& text, Range range, const std::string& limit,
                 std::vector<Finding>& findings);
/// A number without unit.
double read_plain(const char* option, const std::string& text, Range range, std::vector<Finding>& findings);
/// A part of one, as 0.01 or 1%. also: what else the option may be, such as "off, or ".
double read_part(const char* option, const std::string& text, Range range, const std::string& also,
                 std::vector<Finding>& findings);
/// Of --jobs.
inline constexpr int kMostThreads = 1024;
/// A whole number from 1 to `most`, which may be unknown. what: behind the range in the message, such as
/// ", the model's elastic modes".
int read_count(const char* option, const std::string& text, std::optional<int> most, const std::string& what,
               std::vector<Finding>& findings);

/// What is wrong with numbers.
struct NumbersFault {
  std::string why = {};  ///< end of a message; empty: nothing
  bool form = false;     ///< the text is no numbers, or not so many
};
/// FIRST:STEP:LAST as numbers, FIRST and all that follow by STEP up to LAST. most: so many numbers at the most.
NumbersFault read_steps(const std::string& text, double most, std::vector<double>& values);
/// Rising numbers > 0, as FIRST:STEP:LAST or A,B,C. unit: as messages name it.
std::vector<double> read_rising(const char* option, const std::string& text, const std::string& unit,
                                std::vector<Finding>& findings);

}  // namespace drev::app
