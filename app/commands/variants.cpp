#include "app/commands/variants.hpp"

#include <drev/models/parameters.hpp>

#include <algorithm>
#include <cmath>

#include "app/base/text_layout.hpp"
#include "app/cli/command_line.hpp"
#include "app/cli/option_values.hpp"

namespace drev::app {

namespace {

constexpr double kMostVariants = 10000;

constexpr const char* kForm = "must be NAME=A,B,C, NAME=FIRST:STEP:LAST, or both mixed";

/// What is wrong with the values; empty: nothing.
std::string read_values(const std::string& text, std::vector<std::string>& values) {
  for (const std::string& part : split(text, ',')) {
    std::vector<std::string> found{part};
    if (part.find(':') != part.npos) {
      std::vector<double> numbers;
      const std::string wrong = read_steps(part, kMostVariants, numbers);
      if (!wrong.empty()) return wrong.starts_with("must be") ? kForm : wrong;
      found.clear();
      for (const double number : numbers) {
        const std::string value = short_digits(number, 12);
        if (!found.empty() && found.back() == value) return "has a STEP too small for 12 digits";
        found.push_back(value);
      }
    }
    for (const std::string& value : found) {
      if (value.empty() || value.find('/') != value.npos) return kForm;
      if (std::count(values.begin(), values.end(), value) > 0) return "has " + value + " twice";
      values.push_back(value);
    }
    if (static_cast<double>(values.size()) > kMostVariants)
      return "has more values than " + short_digits(kMostVariants, 5);
  }
  return {};
}

}  // namespace

std::string Variant::name() const {
  std::vector<std::string> parts;
  for (const auto& [name, value] : parameters) parts.push_back(name + "=" + value);
  return join(parts, ",");
}

std::vector<Variant> read_variants(const std::vector<std::string>& words, std::vector<Finding>& findings) {
  std::vector<Variant> variants(1);
  for (const std::string& word : words) {
    const auto refuse = [&](const std::string& why) {
      findings.push_back({kCommandLine, "--vary", word, "", why});
    };
    const std::size_t equals = std::min(word.find('='), word.size());
    const std::string name = word.substr(0, equals);
    std::vector<std::string> values;
    const std::string wrong = read_values(word.substr(std::min(equals + 1, word.size())), values);
    const auto& parameters = variants.front().parameters;
    if (name.empty() || !wrong.empty()) {
      refuse(wrong.empty() ? kForm : wrong);
    } else if (std::any_of(parameters.begin(), parameters.end(),
                           [&](const auto& s) { return s.first == name; })) {
      refuse(name + " is varied already");
    } else if (static_cast<double>(variants.size() * values.size()) > kMostVariants) {
      refuse("makes more than " + short_digits(kMostVariants, 5) + " runs");
    } else {
      std::vector<Variant> all;
      for (const Variant& variant : variants)
        for (const std::string& value : values) {
          all.push_back(variant);
          all.back().parameters.emplace_back(name, value);
        }
      variants = std::move(all);
    }
  }
  return variants;
}

}  // namespace drev::app
