#include "app/cli/option_values.hpp"

#include <drev/models/parameters.hpp>

#include <cmath>
#include <limits>

#include "app/base/text_layout.hpp"
#include "app/cli/command_line.hpp"

namespace drev::app {

namespace {

std::string low_to_high(Range range) { return to_text(range.low) + " to " + to_text(range.high); }

std::string low_to_high_percent(Range range) {
  return short_digits(100.0 * range.low, 3) + "% to " + short_digits(100.0 * range.high, 3) + "%";
}

/// A number, or the quotient of two: 2/3.
bool read_quotient(const std::string& text, double& value) {
  const std::vector<std::string> parts = split(text, '/');
  double over = 1.0;
  if (parts.size() > 2 || !read_number(parts[0], value) ||
      (parts.size() == 2 && !read_number(parts[1], over)))
    return false;
  value /= over;
  return true;
}

}  // namespace

double read_time(const char* option, const std::string& text, Range range, const std::string& limit,
                 std::vector<Finding>& findings) {
  const std::string must_be = "must be between " + to_text(range.low) + " s and " +
                              (std::isfinite(range.high) ? to_text(range.high) + " s" : std::string("the")) +
                              (limit.empty() ? "" : " " + limit);
  double value = 0.0;
  if (!read_number(text, value))
    findings.push_back(
        {kCommandLine, option, text, "", "is not a plain number of seconds, such as 0.001; " + must_be});
  else if (!range.holds(value))
    findings.push_back({kCommandLine, option, text, "s", must_be});
  return value;
}

double read_plain(const char* option, const std::string& text, Range range, std::vector<Finding>& findings) {
  double value = 0.0;
  if (!read_number(text, value) || !range.holds(value))
    findings.push_back({kCommandLine, option, text, "", "must be a number from " + low_to_high(range)});
  return value;
}

double read_part(const char* option, const std::string& text, Range range, const std::string& also,
                 std::vector<Finding>& findings) {
  const bool percent = text.ends_with('%');
  double value = 0.0;
  const bool number = read_number(percent ? text.substr(0, text.size() - 1) : text, value);
  if (percent) value /= 100.0;
  if (!number || !range.holds(value))
    findings.push_back(
        {kCommandLine, option, text, "",
         "must be " + also + "from " + low_to_high_percent(range) + ", or " + low_to_high(range)});
  return value;
}

int read_count(const char* option, const std::string& text, std::optional<int> most, const std::string& what,
               std::vector<Finding>& findings) {
  double value = 0.0;
  if (read_number(text, value) && value == std::floor(value) && value >= 1 &&
      value <= most.value_or(std::numeric_limits<int>::max()))
    return static_cast<int>(value);
  findings.push_back({kCommandLine, option, text, "",
                      "must be a whole number from 1" + (most ? " to " + std::to_string(*most) + what : "")});
  return 1;
}

NumbersFault read_steps(const std::string& text, double most, std::vector<double>& values) {
  const std::vector<std::string> parts = split(text, ':');
  double first = 0.0, step = 0.0, last = 0.0;
  if (parts.size() != 3 || !read_number(parts[0], first) || !read_number(parts[1], step) ||
      !read_number(parts[2], last) || !std::isfinite(first) || !std::isfinite(step) || !std::isfinite(last))
    return {"must be FIRST:STEP:LAST", true};
  const double steps = std::floor((last - first) / step + 1e-9);
  if (!(steps >= 0.0) || step == 0.0) return {"has a STEP that does not lead from FIRST to LAST"};
  if (steps >= most) return {"has more values than " + short_digits(most, 7)};
  for (double i = 0.0; i <= steps; ++i) {
    const double value = first + i * step;
    values.push_back(std::abs(value) < 1e-12 * std::abs(first) ? 0.0 : value);
  }
  return {};
}

std::vector<double> read_rising(const char* option, const std::string& text, const std::string& unit,
                                std::vector<Finding>& findings) {
  constexpr double kMost = 1e6;
  std::vector<double> values;
  NumbersFault fault;
  if (text.find(':') != text.npos) {
    fault = read_steps(text, kMost, values);
  } else {
    for (const std::string& part : split(text, ',')) {
      values.push_back(0.0);
      if (!read_quotient(part, values.back())) fault = {"must be FIRST:STEP:LAST or A,B,C", true};
    }
  }
  for (std::size_t i = 0; i < values.size() && fault.why.empty(); ++i)
    if (!std::isfinite(values[i]) || !(values[i] > (i > 0 ? values[i - 1] : 0.0)))
      fault.why = "must be > 0 and rise from each to the next";
  if (fault.form)
    findings.push_back({kCommandLine, option, text, "",
                        fault.why + ", numbers" + (unit.empty() ? "" : " of " + unit) + " without unit"});
  else if (!fault.why.empty())
    findings.push_back({kCommandLine, option, text, unit, fault.why});
  return values;
}

}  // namespace drev::app
