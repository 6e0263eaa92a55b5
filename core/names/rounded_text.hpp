#pragma once
/// Computed values in messages.
#include <drev/core/error.hpp>

#include <charconv>
#include <string>

namespace drev {

/// As to_text(), rounded to so many significant digits.
inline std::string rounded_text(double value, int digits) {
  char text[64];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::scientific, digits - 1);
  double rounded = value;  // stays where it is no number
  std::from_chars(text, end.ptr, rounded);
  return to_text(rounded);
}

}  // namespace drev
