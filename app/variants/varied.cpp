#include "app/variants/varied.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "app/base/text_layout.hpp"
#include "app/cli/command_line.hpp"
#include "app/cli/option_values.hpp"

namespace drev::app {

namespace {

constexpr const char* kForm =
    "must be NAME=A,B,C, NAME=FIRST:STEP:LAST, or both mixed; NAME=orders(N), or with --sample "
    "NAME=uniform(LOW,HIGH) or NAME=normal(MEAN,DEVIATION)";
constexpr int kMostItems = 20;       // 19! fits 64 bits
constexpr double kMostValues = 1e7;  // largest number of values of one word, which are kept in memory

/// Reads values. Returns the fault; empty: there is none.
std::string read_values(const std::string& text, double most, std::vector<std::string>& values) {
  std::map<std::string, std::string> known;  // numbers by their value: 0.1 and 0.10 are one
  for (const std::string& part : split(text, ',')) {
    std::vector<std::string> found{part};
    if (part.find(':') != part.npos) {
      std::vector<double> numbers;
      const NumbersFault fault = read_steps(part, most, numbers);
      if (!fault.why.empty()) return fault.form ? kForm : fault.why;
      found.clear();
      for (const double number : numbers) {
        const std::string value = short_digits(number, 12);
        if (!found.empty() && found.back() == value) return "has a STEP too small for 12 digits";
        found.push_back(value);
      }
    }
    for (const std::string& value : found) {
      // One of the brackets alone: a distribution by another name, or among values.
      const bool bracket = (value.find('(') == value.npos) != (value.find(')') == value.npos);
      if (value.empty() || value.find('/') != value.npos || bracket) return kForm;
      double number = 0.0;
      const auto [same, added] =
          known.emplace(read_number(value, number) ? short_digits(number, 17) : value, value);
      if (!added)
        return "has " + value + " twice" + (same->second == value ? "" : ", first as " + same->second);
      values.push_back(value);
    }
    if (static_cast<double>(values.size()) > most) return "has more values than " + short_digits(most, 7);
  }
  return {};
}

/// Whether the text is a call of `name`: "uniform(1,2)" calls "uniform" with "1" and "2".
bool call_of(const std::string& text, const std::string& name, std::vector<std::string>& arguments) {
  if (!text.starts_with(name + "(") || !text.ends_with(')')) return false;
  arguments = split(text.substr(name.size() + 1, text.size() - name.size() - 2), ',');
  return true;
}

/// Reads the values or the distribution of a word. Returns the fault; empty: there is none.
std::string read_one(Varied& varied, double most) {
  using enum Varied::Kind;
  std::vector<std::string> words;
  if (call_of(varied.text, "orders", words)) {
    double items = 0.0;
    varied.kind = orders;
    if (words.size() != 1 || !read_number(words[0], items) || items != std::floor(items) || !(items >= 2) ||
        !(items <= kMostItems))
      return "must be orders(N) with a whole number N from 2 to " + std::to_string(kMostItems);
    varied.items = static_cast<int>(items);
    return {};
  }
  for (const auto& [name, kind] : {std::pair("uniform", uniform), std::pair("normal", normal)}) {
    if (!call_of(varied.text, name, words)) continue;
    varied.kind = kind;
    const bool numbers = words.size() == 2 && read_number(words[0], varied.first) &&
                         read_number(words[1], varied.second) && std::isfinite(varied.first) &&
                         std::isfinite(varied.second);
    if (kind == uniform && !(numbers && varied.first < varied.second))
      return "must be uniform(LOW,HIGH) with two finite numbers, the first below the second";
    if (kind == normal && !(numbers && varied.second > 0.0))
      return "must be normal(MEAN,DEVIATION) with two finite numbers, the second above 0";
    return {};
  }
  return read_values(varied.text, std::min(most, kMostValues), varied.values);
}

}  // namespace

std::uint64_t Varied::count() const {
  if (kind == Kind::values) return values.size();
  if (kind != Kind::orders) return 0;
  std::uint64_t all = 1;
  for (int i = 2; i < items; ++i) all *= static_cast<std::uint64_t>(i);
  return all;
}

std::string Varied::value(std::uint64_t i) const {
  return kind == Kind::orders ? order_text(i, items) : values[i];
}

std::string Varied::between(double u) const {
  const std::string text = short_digits(first + (second - first) * u, 12);
  double value = first;
  read_number(text, value);
  // Rounding may lead beyond a bound, which the parameter may not pass.
  return value < first ? to_text(first) : value > second ? to_text(second) : text;
}

std::string order_text(std::uint64_t i, int items) {
  std::vector<int> left;
  for (int k = 2; k <= items; ++k) left.push_back(k);
  std::uint64_t block = 1;  // number of orders that share the items so far
  for (int k = 2; k < items; ++k) block *= static_cast<std::uint64_t>(k);
  std::string text = "1";
  while (!left.empty()) {
    block /= left.size();
    const auto at = left.begin() + static_cast<std::ptrdiff_t>(i / block);
    i %= block;
    text += "-" + std::to_string(*at);
    left.erase(at);
  }
  return text;
}

ParameterValues listed_values(const std::vector<Varied>& varied) {
  ParameterValues all;
  for (const Varied& v : varied)
    for (const std::string& value : v.values) all.emplace_back(v.name, value);
  return all;
}

std::vector<Varied> read_varied(const std::vector<std::string>& words, double most,
                                std::vector<Finding>& findings) {
  std::vector<Varied> all;
  double combinations = 1.0;
  for (const std::string& word : words) {
    const auto refuse = [&](const std::string& why) {
      findings.push_back({kCommandLine, "--vary", word, "", why});
    };
    const std::size_t equals = std::min(word.find('='), word.size());
    Varied varied{.name = word.substr(0, equals), .text = word.substr(std::min(equals + 1, word.size()))};
    const std::string wrong = read_one(varied, most > 0.0 ? most : kMostValues);
    const double grown = most > 0.0 ? combinations * std::max(1.0, static_cast<double>(varied.count())) : 0.0;
    if (varied.name.empty() || !wrong.empty()) {
      refuse(wrong.empty() ? kForm : wrong);
    } else if (std::any_of(all.begin(), all.end(), [&](const Varied& v) { return v.name == varied.name; })) {
      refuse(varied.name + " is varied already");
    } else if (grown > most) {
      refuse("makes more than " + short_digits(most, 7) + " runs");
    } else {
      combinations = grown;
      all.push_back(std::move(varied));
    }
  }
  return all;
}

}  // namespace drev::app
