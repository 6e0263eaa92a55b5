#pragma once
/// Checksum of a text: tells whether it is the one that was written.
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

namespace drev::app {

/// FNV-1a, 64 bit (Fowler, Noll, Vo; RFC 9923); `start`: another checksum goes on from it.
inline std::uint64_t checksum(std::string_view text, std::uint64_t start = 0xcbf29ce484222325U) {
  for (const char c : text) start = (start ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return start;
}

/// Sixteen hexadecimal digits.
inline std::string checksum_text(std::uint64_t value) {
  char text[20];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
  return text;
}

}  // namespace drev::app
