#include "app/model_file/expression.hpp"

#include <drev/app/model_file/units.hpp>
#include <drev/core/error.hpp>
#include <drev/core/units.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace drev::app {

namespace {

constexpr int kDeepest = 50;
constexpr std::size_t kLongest = 1000;

bool letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool digit(char c) { return c >= '0' && c <= '9'; }

class Parser {
 public:
  Parser(const std::string& text, const Scope& scope) : text_(text), scope_(scope) {}

  Quantified all() {
    if (text_.size() > kLongest) fail("is longer than " + std::to_string(kLongest) + " characters");
    const Quantified value = sum();
    if (!at_end()) unexpected();
    if (!std::isfinite(value.value)) fail("gives no finite number");
    return value;
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw ExpressionError{"the expression \"" + text_.substr(0, 80) + "\" " + why};
  }
  [[noreturn]] void unexpected() {
    if (at_end()) fail("ends where a number or a name is expected");
    fail("has '" + text_.substr(i_, 1) + "' in column " + std::to_string(i_ + 1) + ", where it cannot stand");
  }
  bool at_end() {
    while (i_ < text_.size() && text_[i_] == ' ') ++i_;
    return i_ == text_.size();
  }
  char next() { return at_end() ? '\0' : text_[i_]; }
  bool take(char c) {
    if (next() != c) return false;
    ++i_;
    return true;
  }
  void need(char c) {
    if (!take(c)) fail(std::string("lacks a '") + c + "'" + (at_end() ? " at its end" : ""));
  }

  Quantified sum() {
    if (++depth_ > kDeepest) fail("is nested too deeply");
    Quantified left = product();
    for (char op = next(); op == '+' || op == '-'; op = next()) {
      ++i_;
      const Quantified right = product();
      if (left.unit_followed && right.unit_followed && !left.unit.empty() && !right.unit.empty() &&
          left.unit != right.unit)
        fail("adds " + left.unit + " and " + right.unit);
      if (left.unit.empty()) left.unit = right.unit;
      left.unit_followed = left.unit_followed && right.unit_followed;
      left.value = op == '+' ? left.value + right.value : left.value - right.value;
    }
    --depth_;
    return left;
  }
  Quantified product() {
    Quantified left = sign();
    for (char op = next(); op == '*' || op == '/'; op = next()) {
      ++i_;
      const Quantified right = sign();
      left.value = op == '*' ? left.value * right.value : left.value / right.value;
      if (!right.unit_followed) left.unit_followed = false;
      if (right.unit.empty()) continue;
      if (op == '/' && left.unit == right.unit)
        left.unit.clear();
      else if (op == '*' && left.unit.empty())
        left.unit = right.unit;
      else
        left.unit_followed = false;
    }
    return left;
  }
  Quantified sign() {
    bool minus = false;
    for (char c = next(); c == '-' || c == '+'; c = next()) {
      if (c == '-') minus = !minus;
      ++i_;
    }
    Quantified value = item();
    if (minus) value.value = -value.value;
    return value;
  }
  Quantified item() {
    const char c = next();
    if (take('(')) {
      const Quantified value = sum();
      need(')');
      return value;
    }
    if (digit(c) || c == '.') return {number()};
    if (letter(c)) return named();
    unexpected();
  }
  double number() {
    double value = 0.0;
    const auto result = std::from_chars(text_.data() + i_, text_.data() + text_.size(), value);
    if (result.ec != std::errc{}) unexpected();
    i_ = static_cast<std::size_t>(result.ptr - text_.data());
    return value;
  }
  std::string word() {
    at_end();
    const std::size_t begin = i_;
    while (i_ < text_.size() && (letter(text_[i_]) || digit(text_[i_]))) ++i_;
    return text_.substr(begin, i_ - begin);
  }
  Quantified named() {
    const std::string name = word();
    if (name == "position" && take('(')) {
      const std::vector<double>& list = find_list(word());
      need(',');
      const double wanted = sum().value;
      need(')');
      const auto found = std::find(list.begin(), list.end(), wanted);
      if (found == list.end()) fail("seeks " + to_text(wanted) + ", which the list does not hold");
      return {static_cast<double>(found - list.begin() + 1)};
    }
    if (take('[')) {
      const std::vector<double>& list = find_list(name);
      const double place = sum().value;
      need(']');
      if (!(place >= 1.0 && place <= static_cast<double>(list.size())) || place != std::floor(place))
        fail("takes number " + to_text(place) + " of " + name + ", which has " + std::to_string(list.size()) +
             ", counted from 1");
      return {list[static_cast<std::size_t>(place) - 1], unit_suffix(name)};
    }
    const auto found = scope_.numbers.find(name);
    if (found != scope_.numbers.end()) return {found->second, unit_suffix(name)};
    if (name == "pi") return {kPi};
    if (scope_.lists.contains(name)) fail("needs a place in the list " + name + ", such as " + name + "[1]");
    fail("names " + name + ", which is no parameter" + did_you_mean(name, scope_.names()));
  }
  const std::vector<double>& find_list(const std::string& name) {
    const auto found = scope_.lists.find(name);
    if (found != scope_.lists.end()) return found->second;
    std::vector<std::string> names;
    for (const auto& [known, values] : scope_.lists) names.push_back(known);
    fail("names " + (name.empty() ? "nothing" : name) + ", which is no list" + did_you_mean(name, names));
  }

  const std::string& text_;
  const Scope& scope_;
  std::size_t i_ = 0;
  int depth_ = 0;
};

}  // namespace

std::vector<std::string> Scope::names() const {
  std::vector<std::string> all;
  for (const auto& [name, value] : numbers) all.push_back(name);
  return all;
}

Quantified evaluate(const std::string& text, const Scope& scope) {
  const bool names = text.size() <= kLongest && text.find('{') != std::string::npos;
  const std::string filled = names ? expand(text, scope) : text;
  return Parser(filled, scope).all();
}

std::string expand(const std::string& text, const Scope& scope) {
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    if (text[i] != '{') {
      result += text[i++];
      continue;
    }
    const std::size_t end = text.find('}', i);
    if (end == std::string::npos) throw ExpressionError{"\"" + text + "\" lacks a '}'"};
    const double value = evaluate(text.substr(i + 1, end - i - 1), scope).value;
    if (value != std::floor(value) || std::abs(value) > 1e9)
      throw ExpressionError{"\"" + text + "\" needs a whole number in {}, not " + to_text(value)};
    result += std::to_string(static_cast<long>(value));
    i = end + 1;
  }
  return result;
}

}  // namespace drev::app
