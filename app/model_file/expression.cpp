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
  bool condition() {
    if (text_.size() > kLongest) fail("is longer than " + std::to_string(kLongest) + " characters");
    const bool result = either();
    if (!at_end()) unexpected();
    return result;
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
      const std::string wrong = add(left, product(), op == '+' ? 1.0 : -1.0, left);
      if (!wrong.empty()) fail(wrong);
    }
    --depth_;
    return left;
  }
  Quantified product() {
    Quantified left = sign();
    for (char op = next(); op == '*' || op == '/'; op = next()) {
      ++i_;
      left = op == '*' ? multiply(left, sign()) : divide(left, sign());
    }
    return left;
  }
  Quantified sign() {
    if (++depth_ > kDeepest) fail("is nested too deeply");
    bool minus = false;
    for (char c = next(); c == '-' || c == '+'; c = next()) {
      if (c == '-') minus = !minus;
      ++i_;
    }
    Quantified value = item();
    if (take('^')) {
      const Quantified exponent = sign();
      if (!exponent.plain()) fail("has an exponent in " + exponent.unit);
      value = power(value, exponent.value);
    }
    if (minus) value.value = -value.value;
    --depth_;
    return value;
  }

  /// A side of a comparison: a text or a number.
  struct Side {
    bool is_text = false;
    std::string text = {};
    Quantified number = {};
  };
  Side side() {
    if (take('\'')) {
      const std::size_t end = text_.find('\'', i_);
      if (end == std::string::npos) fail("lacks a ' at its end");
      Side found{true, text_.substr(i_, end - i_)};
      i_ = end + 1;
      return found;
    }
    at_end();
    const std::size_t begin = i_;
    if (letter(next())) {
      const auto found = scope_.texts.find(word());
      if (found != scope_.texts.end()) return {true, found->second};
      i_ = begin;
    }
    return {false, {}, sum()};
  }
  std::string comparison_sign() {
    for (const char* sign : {"==", "!=", "<=", ">=", "<", ">"})
      if (!at_end() && text_.compare(i_, std::string(sign).size(), sign) == 0) {
        i_ += std::string(sign).size();
        return sign;
      }
    fail("is no condition: it lacks ==, !=, <, <=, > or >=");
  }
  bool take_word(const std::string& wanted) {
    at_end();
    const std::size_t begin = i_;
    if (word() == wanted) return true;
    i_ = begin;
    return false;
  }
  bool comparison() {
    if (++depth_ > kDeepest) fail("is nested too deeply");
    bool result = false;
    const std::size_t begin = i_;
    if (take_word("not")) {
      result = !comparison();
    } else if (take('(') && is_condition(begin)) {
      result = either();
      need(')');
    } else {
      i_ = begin;
      result = compared();
    }
    --depth_;
    return result;
  }
  /// Whether the parenthesis that opens at `begin` holds a condition, and no sum.
  bool is_condition(std::size_t begin) {
    at_end();
    int open = 0;
    for (std::size_t i = text_.find('(', begin); i < text_.size(); ++i) {
      if (text_[i] == '(') ++open;
      if (text_[i] == ')' && --open == 0) return false;
      if (text_[i] == '=' || text_[i] == '<' || text_[i] == '>') return true;
    }
    return false;
  }
  bool compared() {
    const Side a = side();
    const std::string sign = comparison_sign();
    const Side b = side();
    if (a.is_text != b.is_text) fail("compares a text with a number");
    if (a.is_text && sign != "==" && sign != "!=")
      fail("compares texts by " + sign + "; there are == and !=");
    if (a.is_text) return (a.text == b.text) == (sign == "==");
    Quantified difference;
    const std::string wrong = add(a.number, b.number, -1.0, difference);
    if (!wrong.empty()) fail("compares " + wrong.substr(5));
    const double d = difference.value;
    return sign == "=="   ? d == 0.0
           : sign == "!=" ? d != 0.0
           : sign == "<"  ? d < 0.0
           : sign == "<=" ? d <= 0.0
           : sign == ">"  ? d > 0.0
                          : d >= 0.0;
  }
  bool both() {
    bool result = comparison();
    while (take_word("and")) result = comparison() && result;
    return result;
  }
  bool either() {
    bool result = both();
    while (take_word("or")) result = both() || result;
    return result;
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
    if (take('(')) return function(name);
    if (take('[')) {
      const std::vector<double>& list = find_list(name);
      const double place = sum().value;
      need(']');
      if (!(place >= 1.0 && place <= static_cast<double>(list.size())) || place != std::floor(place))
        fail("takes number " + to_text(place) + " of " + name + ", which has " + std::to_string(list.size()) +
             ", counted from 1");
      return Quantified::of(list[static_cast<std::size_t>(place) - 1], unit_suffix(name));
    }
    const auto found = scope_.numbers.find(name);
    if (found != scope_.numbers.end()) return Quantified::of(found->second, unit_suffix(name));
    if (name == "pi") return {kPi};
    if (scope_.texts.contains(name)) fail("takes " + name + " for a number, which is a text");
    if (scope_.lists.contains(name)) fail("needs a place in the list " + name + ", such as " + name + "[1]");
    fail("names " + name + ", which is no parameter" + did_you_mean(name, scope_.names()));
  }
  Quantified function(const std::string& name) {
    static const std::vector<std::string> known{"sqrt", "abs", "exp", "log", "sin",   "cos",
                                                "tan",  "min", "max", "si",  "plain", "position"};
    if (std::find(known.begin(), known.end(), name) == known.end())
      fail("calls " + name + "(), which is no function" + did_you_mean(name, known));
    Quantified a = sum();
    if (name == "min" || name == "max") {
      while (take(',')) {
        const Quantified b = sum();
        Quantified difference;
        const std::string wrong = add(a, b, -1.0, difference);
        if (!wrong.empty()) fail("compares " + wrong.substr(5));
        if ((difference.value < 0.0) == (name == "max")) a.value = b.value;
        if (a.plain()) a.unit = b.unit, a.combined = b.combined, a.parts = b.parts;
      }
      need(')');
      return a;
    }
    need(')');
    if (name == "abs") a.value = std::abs(a.value);
    if (name == "abs") return a;
    if (name == "si") return in_si(a);
    if (name == "plain") return {a.value};
    if (name == "sqrt") {
      if (a.value < 0.0) fail("takes the root of " + to_text(a.value));
      return power(a, 0.5);
    }
    const bool angle = a.plain() || a.fits("");
    const bool turning = name == "sin" || name == "cos" || name == "tan";
    if (turning && (a.unit == "deg" || a.unit == "mrad" || a.unit == "rad"))
      a.value *= a.parts.factor;
    else if (!angle)
      fail("takes " + name + " of " + a.unit);
    return {name == "sin"   ? std::sin(a.value)
            : name == "cos" ? std::cos(a.value)
            : name == "tan" ? std::tan(a.value)
            : name == "exp" ? std::exp(a.value)
                            : std::log(a.value)};
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

bool holds(const std::string& condition, const Scope& scope) { return Parser(condition, scope).condition(); }

std::string expand(const std::string& text, const Scope& scope) {
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    if (text[i] != '{') {
      result += text[i++];
      continue;
    }
    // The brace that closes this one: "gas_{fires_{i}}".
    std::size_t end = i + 1;
    for (int open = 1; end < text.size(); ++end) {
      if (text[end] == '{') ++open;
      if (text[end] == '}' && --open == 0) break;
    }
    if (end >= text.size()) throw ExpressionError{"\"" + text + "\" lacks a '}'"};
    if (const auto named = scope.texts.find(text.substr(i + 1, end - i - 1)); named != scope.texts.end()) {
      result += named->second;
      i = end + 1;
      continue;
    }
    const double value = evaluate(text.substr(i + 1, end - i - 1), scope).value;
    if (value != std::floor(value) || std::abs(value) > 1e9)
      throw ExpressionError{"\"" + text + "\" needs a whole number in {}, not " + to_text(value)};
    result += std::to_string(static_cast<long>(value));
    i = end + 1;
  }
  return result;
}

}  // namespace drev::app
