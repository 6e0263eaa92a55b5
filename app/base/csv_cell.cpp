#include "app/base/csv_cell.hpp"

#include <drev/models/parameters.hpp>

#include <cstdio>

namespace drev::app {

std::string csv_cell(const std::string& text) {
  double value = 0.0;
  const std::size_t first = text.find_first_not_of('\'');
  const bool formula = first != text.npos && std::string("=+-@\t\r").find(text[first]) != std::string::npos &&
                       !drev::read_number(text, value);
  const std::string cell = (formula ? "'" : "") + text;
  if (cell.find_first_of(",\"\r\n") == std::string::npos) return cell;
  std::string quoted = "\"";
  for (const char c : cell) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

void append_digits(std::string& line, double value) {
  char text[32];
  const int length = std::snprintf(text, sizeof text, "%.17g", value);
  line.append(text, static_cast<std::size_t>(length));
}

}  // namespace drev::app
