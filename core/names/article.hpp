#pragma once
#include <string>
#include <string_view>

namespace drev {

/// A name of a thing with its article: "a gear mesh", "an inertia".
inline std::string with_article(std::string_view name) {
  const bool vowel = !name.empty() && std::string_view("aeiou").find(name.front()) != std::string_view::npos;
  return (vowel ? "an " : "a ") + std::string(name);
}

}  // namespace drev
