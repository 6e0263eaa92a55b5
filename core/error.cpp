#include <drev/core/error.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

template class std::vector<drev::Finding>;

namespace drev {

namespace {

std::string join(const std::vector<Finding>& findings) {
  std::string all;
  for (const Finding& finding : findings) {
    if (!all.empty()) all += '\n';
    all += finding.text();
  }
  return all;
}

/// Letters put in, left out, replaced, or two neighbours swapped.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before, last(b.size() + 1), row(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t{0});
  before = last;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before.swap(last);
    last.swap(row);
  }
  return last[b.size()];
}

/// Names may come from anywhere: what would steer a terminal is shown as \xNN.
std::string printable(const std::string& text) {
  std::string shown;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t bytes = control_bytes(text, i);
    for (std::size_t k = 0; k < bytes; ++k) {
      constexpr char kDigits[] = "0123456789abcdef";
      const auto c = static_cast<unsigned char>(text[i + k]);
      shown += {'\\', 'x', kDigits[c / 16], kDigits[c % 16]};
    }
    if (bytes == 0) shown += text[i];
    i += std::max<std::size_t>(bytes, 1);
  }
  return shown;
}

}  // namespace

std::size_t control_bytes(std::string_view text, std::size_t at) {
  const auto c = static_cast<unsigned char>(text[at]);
  if (c < 0x20 || c == 0x7f) return 1;
  // U+0080 to U+009F, in UTF-8.
  if (c != 0xc2 || at + 1 == text.size()) return 0;
  const auto next = static_cast<unsigned char>(text[at + 1]);
  return next >= 0x80 && next < 0xa0 ? 2 : 0;
}

bool has_control_characters(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i)
    if (control_bytes(text, i) > 0) return true;
  return false;
}

std::string Finding::text() const {
  std::string line = place;
  if (!parameter.empty()) line += ": " + parameter;
  if (!value.empty()) {
    line += " = " + value;
    if (!unit.empty()) line += " " + unit;
  }
  if (!range.empty()) line += (parameter.empty() && value.empty() ? ": " : ", ") + range;
  return printable(line);
}

ModelError::ModelError(std::vector<Finding> findings)
    : std::runtime_error(join(findings)), findings_(std::move(findings)) {}

void ParameterCheck::fail(std::string_view parameter, std::string value, std::string_view unit,
                          std::string range) {
  findings_.push_back(
      {place_, std::string(parameter), std::move(value), std::string(unit), std::move(range)});
}

void ParameterCheck::finite(std::string_view parameter, double value, std::string_view unit) {
  if (!std::isfinite(value)) fail(parameter, to_text(value), unit, "must be finite");
}

void ParameterCheck::positive(std::string_view parameter, double value, std::string_view unit) {
  if (!(value > 0.0) || !std::isfinite(value))
    fail(parameter, to_text(value), unit, "must be > 0 and finite");
}

void ParameterCheck::non_negative(std::string_view parameter, double value, std::string_view unit) {
  if (!(value >= 0.0) || !std::isfinite(value))
    fail(parameter, to_text(value), unit, "must be >= 0 and finite");
}

void ParameterCheck::within(std::string_view parameter, double value, double low, double high,
                            std::string_view unit) {
  if (!(value >= low && value <= high))
    fail(parameter, to_text(value), unit, "must be between " + to_text(low) + " and " + to_text(high));
}

void ParameterCheck::increasing(std::string_view parameter, const std::vector<double>& values,
                                std::string_view unit) {
  all_finite(parameter, values, unit);
  for (std::size_t i = 1; i < values.size(); ++i)
    if (!(values[i] > values[i - 1])) {
      fail(std::string(parameter) + "[" + std::to_string(i) + "]", to_text(values[i]), unit,
           "must be greater than the value before it, " + to_text(values[i - 1]));
      return;
    }
}

void ParameterCheck::all_finite(std::string_view parameter, const std::vector<double>& values,
                                std::string_view unit) {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i])) {
      fail(std::string(parameter) + "[" + std::to_string(i) + "]", to_text(values[i]), unit,
           "must be finite");
      return;
    }
}

std::string to_text(double value) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0 ? "infinity" : "-infinity";
  char buffer[64];
  const double size = std::abs(value);
  const bool plain = size == 0.0 || (size >= 1e-5 && size < 1e16);
  const auto result = plain ? std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed)
                            : std::to_chars(buffer, buffer + sizeof buffer, value);
  return {buffer, result.ptr};
}

std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates) {
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(2, name.size() / 2) + 1;
  for (const std::string& candidate : candidates) {
    // The comparison takes the time of one length times the other: none of a name of megabytes.
    constexpr std::size_t kLongest = 500;
    if (std::max(name.size(), candidate.size()) > kLongest) continue;
    const std::size_t distance = edit_distance(name, candidate);
    // As many edits as letters: nothing in common.
    if (distance < best_distance && distance < std::max(name.size(), candidate.size())) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

std::string did_you_mean(std::string_view name, const std::vector<std::string>& candidates) {
  const std::string nearest = nearest_name(name, candidates);
  return nearest.empty() ? std::string() : "; did you mean '" + nearest + "'?";
}

}  // namespace drev
