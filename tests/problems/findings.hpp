#pragma once
/// What build() finds wrong with a model, for tests of messages.
#include <drev/core/error.hpp>
#include <drev/core/model.hpp>
#include <drev/core/system.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace drev::problems {

/// Texts of all findings; empty if the model builds.
inline std::vector<std::string> findings_of(const Model& model) {
  std::vector<std::string> texts;
  try {
    (void)model.build();
  } catch (const ModelError& error) {
    for (const Finding& finding : error.findings()) texts.push_back(finding.text());
  }
  return texts;
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// How many of the texts hold every part.
inline long count_with(const std::vector<std::string>& texts, const std::vector<std::string>& parts) {
  return std::count_if(texts.begin(), texts.end(), [&](const std::string& text) {
    return std::all_of(parts.begin(), parts.end(),
                       [&](const std::string& part) { return contains(text, part); });
  });
}

/// The model has one fault alone, and its text holds every part.
inline bool only_fault(const Model& model, const std::vector<std::string>& parts) {
  const std::vector<std::string> texts = findings_of(model);
  return texts.size() == 1 && count_with(texts, parts) == 1;
}

}  // namespace drev::problems
