#pragma once
/// Computed values in messages.
#include <drev/core/error.hpp>

#include <cstdio>
#include <cstdlib>
#include <string>

namespace drev {

/// As to_text(), rounded to so many significant digits.
inline std::string rounded_text(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return to_text(std::strtod(text, nullptr));
}

}  // namespace drev
