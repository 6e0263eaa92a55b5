#include "app/base/text_layout.hpp"

#include <drev/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>

namespace drev::app {

std::string digits(double value, int significant) {
  if (!std::isfinite(value)) return to_text(value);
  if (value == 0.0) return "0";
  char text[64];
  // The exponent after rounding: 9.99 with two digits is 10.
  std::snprintf(text, sizeof text, "%.*e", significant - 1, value);
  const double rounded = std::strtod(text, nullptr);
  const int exponent = static_cast<int>(std::floor(std::log10(std::abs(rounded))));
  if (exponent < -4 || exponent > 8) return text;
  std::snprintf(text, sizeof text, "%.*f", std::max(0, significant - 1 - exponent), value);
  return text;
}

std::string short_digits(double value, int significant) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*g", significant, value);
  return text;
}

std::string earned_digits(double value, double error) {
  if (!std::isfinite(error)) return digits(value, 3);
  if (!(error > 0.0) || value == 0.0) return short_digits(value, 12);
  const double places = std::ceil(std::log10(std::abs(value) / error)) + 1.0;
  return digits(value, static_cast<int>(std::clamp(places, 2.0, 15.0)));
}

std::string pad_right(const std::string& text, std::size_t width) {
  return text + std::string(width > text.size() ? width - text.size() : 0, ' ');
}

std::string pad_left(const std::string& text, std::size_t width) {
  return std::string(width > text.size() ? width - text.size() : 0, ' ') + text;
}

std::string wrap(const std::string& text, std::size_t indent) {
  constexpr std::size_t kWidth = 100;
  std::istringstream words(text);
  std::string result, word;
  std::size_t column = indent;
  while (words >> word) {
    if (column > indent && column + 1 + word.size() > kWidth) {
      result += "\n" + std::string(indent, ' ');
      column = indent;
    } else if (column > indent) {
      result += ' ';
      ++column;
    }
    result += word;
    column += word.size();
  }
  return result + "\n";
}

std::string labelled(const std::string& label, const std::string& text) {
  return pad_right(label, kLabel) + (label.size() < kLabel ? "" : "  ") + wrap(text, kLabel);
}

std::string columns_text(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> width;
  for (const auto& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (width.size() <= c) width.push_back(0);
      width[c] = std::max(width[c], row[c].size());
    }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c)
      line += c == 0 ? pad_right(row[c], width[c]) : "  " + pad_left(row[c], width[c]);
    text += line + "\n";
  }
  return text;
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

std::string join(const std::vector<std::string>& items, const std::string& separator) {
  std::string text;
  for (const std::string& item : items) text += (text.empty() ? "" : separator) + item;
  return text;
}

}  // namespace drev::app
