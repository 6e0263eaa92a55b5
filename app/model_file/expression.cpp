#include "app/model_file/expression.hpp"

#include <drev/app/model_file/units.hpp>
#include <drev/core/error.hpp>
#include <drev/core/units.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <optional>

namespace drev::app {

namespace {

constexpr int kDeepestNesting = 50;
constexpr std::size_t kLongest = 1000;

bool letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool digit(char c) { return c >= '0' && c <= '9'; }
bool goes_on(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }  // a character of UTF-8

/// What a number that a formula's variables have entered is not: known before they are.
std::optional<double> constant(double x) { return x; }
double smaller(double a, double b) { return b < a ? b : a; }
double larger(double a, double b) { return b > a ? b : a; }

/// A number of a formula that is recorded: a constant, or a step of the tape.
struct Recorded {
  double value = 0.0;  ///< of a constant
  int step = -1;
  std::vector<Formula::Step>* tape = nullptr;  ///< null: a constant

  Recorded(double v = 0.0) : value(v) {}  // NOLINT: constants stand in formulas
  Recorded(std::vector<Formula::Step>& on, const Formula::Step& made)
      : step(static_cast<int>(on.size())), tape(&on) {
    on.push_back(made);
  }
  int on(std::vector<Formula::Step>& t) const {
    return tape != nullptr ? step : Recorded(t, {.op = Formula::Op::constant, .value = value}).step;
  }
  static Recorded binary(Formula::Op op, const Recorded& a, const Recorded& b, double of_constants) {
    std::vector<Formula::Step>* t = a.tape != nullptr ? a.tape : b.tape;
    if (t == nullptr) return of_constants;
    const int first = a.on(*t), second = b.on(*t);
    return {*t, {.op = op, .a = first, .b = second}};
  }
  static Recorded unary(Formula::Op op, const Recorded& a, double of_constant) {
    if (a.tape == nullptr) return of_constant;
    return {*a.tape, {.op = op, .a = a.step}};
  }
};
using Op = Formula::Op;
Recorded operator+(const Recorded& a, const Recorded& b) {
  return Recorded::binary(Op::add, a, b, a.value + b.value);
}
Recorded operator-(const Recorded& a, const Recorded& b) {
  return Recorded::binary(Op::subtract, a, b, a.value - b.value);
}
Recorded operator*(const Recorded& a, const Recorded& b) {
  return Recorded::binary(Op::multiply, a, b, a.value * b.value);
}
Recorded operator/(const Recorded& a, const Recorded& b) {
  return Recorded::binary(Op::divide, a, b, a.value / b.value);
}
Recorded operator-(const Recorded& a) { return Recorded::unary(Op::negate, a, -a.value); }
Recorded pow(const Recorded& a, double n) {
  if (a.tape == nullptr) return std::pow(a.value, n);
  return {*a.tape, {.op = Op::power, .a = a.step, .value = n}};
}
Recorded abs(const Recorded& a) { return Recorded::unary(Op::abs, a, std::abs(a.value)); }
Recorded exp(const Recorded& a) { return Recorded::unary(Op::exp, a, std::exp(a.value)); }
Recorded log(const Recorded& a) { return Recorded::unary(Op::log, a, std::log(a.value)); }
Recorded sin(const Recorded& a) { return Recorded::unary(Op::sin, a, std::sin(a.value)); }
Recorded cos(const Recorded& a) { return Recorded::unary(Op::cos, a, std::cos(a.value)); }
Recorded tan(const Recorded& a) { return Recorded::unary(Op::tan, a, std::tan(a.value)); }
Recorded tanh(const Recorded& a) { return Recorded::unary(Op::tanh, a, std::tanh(a.value)); }
Recorded atan(const Recorded& a) { return Recorded::unary(Op::atan, a, std::atan(a.value)); }
Recorded smaller(const Recorded& a, const Recorded& b) {
  return Recorded::binary(Op::smaller, a, b, std::min(a.value, b.value));
}
Recorded larger(const Recorded& a, const Recorded& b) {
  return Recorded::binary(Op::larger, a, b, std::max(a.value, b.value));
}
std::optional<double> constant(const Recorded& a) {
  return a.tape == nullptr ? std::optional(a.value) : std::nullopt;
}

/// The grammar, over doubles or over what records a formula.
template <class Number>
class Parser {
 public:
  using Value = QuantifiedOf<Number>;
  using Variables = std::map<std::string, Value>;
  Parser(const std::string& text, const Scope& scope, const Variables& variables = {})
      : text_(text), scope_(scope), variables_(variables) {}

  Value all() {
    if (text_.size() > kLongest) fail("is longer than " + std::to_string(kLongest) + " characters");
    const Value value = sum();
    if (!at_end()) unexpected();
    if (const auto known = constant(value.value); known && !std::isfinite(*known))
      fail("gives no finite number");
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
    std::size_t shown = std::min<std::size_t>(text_.size(), 80);
    while (shown < text_.size() && goes_on(text_[shown])) --shown;
    throw ExpressionError{"the expression \"" + text_.substr(0, shown) + "\" " + why};
  }
  /// " in column 3", counted in characters.
  std::string column(std::size_t i) const {
    const auto begin = text_.begin(), end = begin + static_cast<std::ptrdiff_t>(i);
    return " in column " + std::to_string(std::count_if(begin, end, std::not_fn(goes_on)) + 1);
  }
  [[noreturn]] void unexpected() {
    if (at_end()) fail("ends where a number or a name is expected");
    std::size_t end = i_ + 1;
    while (end < text_.size() && goes_on(text_[end])) ++end;
    fail("has '" + text_.substr(i_, end - i_) + "'" + column(i_) + ", where it cannot stand");
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

  Value sum() {
    if (++depth_ > kDeepestNesting) fail("is nested too deeply");
    Value left = product();
    for (char op = next(); op == '+' || op == '-'; op = next()) {
      ++i_;
      const std::string wrong = add(left, product(), op == '+' ? 1.0 : -1.0, left);
      if (!wrong.empty()) fail(wrong);
    }
    --depth_;
    return left;
  }
  Value product() {
    Value left = sign();
    for (char op = next(); op == '*' || op == '/'; op = next()) {
      ++i_;
      left = op == '*' ? multiply(left, sign()) : divide(left, sign());
    }
    return left;
  }
  Value sign() {
    if (++depth_ > kDeepestNesting) fail("is nested too deeply");
    bool minus = false;
    for (char c = next(); c == '-' || c == '+'; c = next()) {
      if (c == '-') minus = !minus;
      ++i_;
    }
    Value value = item();
    if (take('^')) {
      const Value exponent = sign();
      if (!exponent.plain()) fail("has an exponent in " + exponent.unit);
      value = power(value, known(exponent, "has an exponent"));
    }
    if (minus) value.value = -value.value;
    --depth_;
    return value;
  }

  /// A side of a comparison: a text or a number.
  struct Side {
    bool is_text = false;
    std::string text = {};
    Value number = {};
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
    if (++depth_ > kDeepestNesting) fail("is nested too deeply");
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
    Value difference;
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

  Value item() {
    const char c = next();
    if (take('(')) {
      const Value value = sum();
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
    if (result.ec == std::errc::result_out_of_range)
      fail("has the number " + std::string(text_.data() + i_, result.ptr) + column(i_) +
           ", which is outside of what a number can be, 1e-307 to 1e308");
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
  Value named() {
    const std::string name = word();
    if (name == "position" && take('(')) {
      const std::vector<double>& list = find_list(word());
      need(',');
      const double wanted = known(sum(), "seeks a number");
      need(')');
      const auto found = std::find(list.begin(), list.end(), wanted);
      if (found == list.end()) fail("seeks " + to_text(wanted) + ", which the list does not hold");
      return {Number(static_cast<double>(found - list.begin() + 1))};
    }
    if (take('(')) return function(name);
    if (take('[')) {
      const std::vector<double>& list = find_list(name);
      const double place = known(sum(), "takes a place");
      need(']');
      if (!(place >= 1.0 && place <= static_cast<double>(list.size())) || place != std::floor(place))
        fail("takes number " + to_text(place) + " of " + name + ", which has " + std::to_string(list.size()) +
             ", counted from 1");
      return Value::of(Number(list[static_cast<std::size_t>(place) - 1]), unit_suffix(name));
    }
    if (const auto found = variables_.find(name); found != variables_.end()) return found->second;
    const auto found = scope_.numbers.find(name);
    if (found != scope_.numbers.end()) return Value::of(Number(found->second), unit_suffix(name));
    if (name == "pi") return {Number(kPi)};
    if (scope_.texts.contains(name)) fail("takes " + name + " for a number, which is a text");
    if (scope_.lists.contains(name)) fail("needs a place in the list " + name + ", such as " + name + "[1]");
    std::vector<std::string> names = scope_.names();
    for (const auto& [variable, value] : variables_) names.push_back(variable);
    fail("names " + name + (variables_.empty() ? "" : "," + column(i_ - name.size())) + ", which is no " +
         (variables_.empty() ? "" : "variable and no ") + "parameter" + did_you_mean(name, names));
  }
  Value function(const std::string& name) {
    static const std::vector<std::string> known{"sqrt", "abs",  "exp", "log", "sin", "cos",   "tan",
                                                "tanh", "atan", "min", "max", "si",  "plain", "position"};
    if (std::find(known.begin(), known.end(), name) == known.end())
      fail("calls " + name + "(), which is no function" + did_you_mean(name, known));
    Value a = sum();
    if (name == "min" || name == "max") {
      while (take(',')) {
        const Value b = sum();
        Value difference;
        const std::string wrong = add(a, b, -1.0, difference);
        if (!wrong.empty()) fail("compares " + wrong.substr(5));
        a = {name == "max" ? larger(a.value, b.value) : smaller(a.value, b.value), a.plain() ? b : a};
      }
      need(')');
      return a;
    }
    need(')');
    using std::abs, std::sin, std::cos, std::tan, std::exp, std::log, std::tanh, std::atan;
    if (name == "abs") a.value = abs(a.value);
    if (name == "abs") return a;
    if (name == "si") return in_si(a);
    if (name == "plain") return {a.value};
    if (name == "sqrt") {
      if (const auto of = constant(a.value); of && *of < 0.0) fail("takes the root of " + to_text(*of));
      return power(a, 0.5);
    }
    const bool angle = a.plain() || a.fits("");
    const bool turning = name == "sin" || name == "cos" || name == "tan";
    if (turning && (a.unit == "deg" || a.unit == "mrad" || a.unit == "rad"))
      a.value = a.value * a.parts.factor;
    else if (!angle)
      fail("takes " + name + " of " + a.unit);
    return {name == "sin"    ? sin(a.value)
            : name == "cos"  ? cos(a.value)
            : name == "tan"  ? tan(a.value)
            : name == "tanh" ? tanh(a.value)
            : name == "atan" ? atan(a.value)
            : name == "exp"  ? exp(a.value)
                             : log(a.value)};
  }
  /// What must be known before the variables are.
  double known(const Value& value, const std::string& what) const {
    const std::optional<double> number = constant(value.value);
    if (!number) fail(what + " that follows a variable");
    return *number;
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
  const Variables variables_;
  std::size_t i_ = 0;
  int depth_ = 0;
};

/// The steps that step `last` is made of, it the last of them.
std::vector<Formula::Step> needed(const std::vector<Formula::Step>& tape, int last) {
  std::vector<int> place(tape.size(), -1);
  std::vector<char> wanted(tape.size(), 0);
  wanted[static_cast<std::size_t>(last)] = 1;
  for (int i = last; i >= 0; --i) {
    const Formula::Step& s = tape[static_cast<std::size_t>(i)];
    if (wanted[static_cast<std::size_t>(i)] == 0 || s.op == Op::variable) continue;
    for (const int of : {s.a, s.b})
      if (of >= 0) wanted[static_cast<std::size_t>(of)] = 1;
  }
  std::vector<Formula::Step> kept;
  for (int i = 0; i <= last; ++i) {
    if (wanted[static_cast<std::size_t>(i)] == 0) continue;
    Formula::Step s = tape[static_cast<std::size_t>(i)];
    if (s.op != Op::variable && s.a >= 0) s.a = place[static_cast<std::size_t>(s.a)];
    if (s.b >= 0) s.b = place[static_cast<std::size_t>(s.b)];
    place[static_cast<std::size_t>(i)] = static_cast<int>(kept.size());
    kept.push_back(s);
  }
  return kept;
}

}  // namespace

std::vector<std::string> Scope::names() const {
  std::vector<std::string> all;
  for (const auto& [name, value] : numbers) all.push_back(name);
  return all;
}

Quantified evaluate(const std::string& text, const Scope& scope) {
  const bool names = text.size() <= kLongest && text.find('{') != std::string::npos;
  const std::string filled = names ? expand(text, scope) : text;
  return Parser<double>(filled, scope).all();
}

Formula compile(const std::string& text, const Scope& scope, const std::vector<FormulaVariable>& variables,
                const std::string& unit) {
  const bool names = text.size() <= kLongest && text.find('{') != std::string::npos;
  const std::string filled = names ? expand(text, scope) : text;
  // Variables without their units first: "-0.02 * speed_rad_per_s^2"; with them, "torque_Nm * speed_rpm/rated_rpm".
  for (const bool plain : {true, false}) {
    std::vector<Formula::Step> tape;
    Parser<Recorded>::Variables known;
    for (const FormulaVariable& v : variables) {
      Recorded number(tape, {.op = Op::variable, .a = v.number});
      if (v.factor != 1.0) number = number * v.factor;
      known[v.name] = {number, known_unit(plain ? "" : unit_suffix(v.name))};
    }
    std::string wrong;
    try {
      const QuantifiedOf<Recorded> result = Parser<Recorded>(filled, scope, known).all();
      if (result.fits(unit)) {
        return Formula(needed(tape, result.value.on(tape)));
      }
      wrong = "the expression \"" + text.substr(0, 80) + "\" is in " + result.unit + ", the key in " + unit +
              result.how_to_fit(unit);
    } catch (const ExpressionError& error) {
      wrong = error.sentence;
    }
    if (!plain) throw ExpressionError{wrong};
  }
  return {};
}

bool holds(const std::string& condition, const Scope& scope) {
  return Parser<double>(condition, scope).condition();
}

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
