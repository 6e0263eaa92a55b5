#include <drev/elements/formula.hpp>

#include <array>
#include <charconv>
#include <stdexcept>

#include "core/law/ranged.hpp"

namespace drev {

namespace {

bool binary(Formula::Op op) {
  switch (op) {
    case Formula::Op::add:
    case Formula::Op::subtract:
    case Formula::Op::multiply:
    case Formula::Op::divide:
    case Formula::Op::smaller:
    case Formula::Op::larger:
      return true;
    default:
      return false;
  }
}

/// With the digits that read back to the same double.
std::string digits(double value) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

struct Function {
  const char* name;
  Dual (*at)(const Dual&);
  Ranged (*over)(const Ranged&);
};
Dual value_of(const Function& f, const Dual& a) { return f.at(a); }
Ranged value_of(const Function& f, const Ranged& a) { return f.over(a); }

/// Of one number: from Op::sqrt on.
const Function& function_of(Formula::Op op) {
  static const Function kAll[] = {
      {"sqrt", drev::sqrt, drev::sqrt},
      {"abs", drev::abs, drev::abs},
      {"exp", drev::exp, drev::exp},
      {"log", drev::log, drev::log},
      {"sin", drev::sin, drev::sin},
      {"cos", drev::cos, drev::cos},
      {"tan", [](const Dual& a) { return drev::sin(a) / drev::cos(a); }, drev::tan},
      {"tanh", drev::tanh, drev::tanh},
      {"atan", drev::atan, drev::atan}};
  return kAll[static_cast<std::size_t>(op) - static_cast<std::size_t>(Formula::Op::sqrt)];
}

const Dual& smaller(const Dual& a, const Dual& b) { return b < a ? b : a; }

constexpr std::size_t kOnStack = 64;  // steps of a formula that needs no heap

}  // namespace

Formula::Formula(std::vector<Step> steps) : steps_(std::move(steps)) {
  const auto earlier = [](int step, std::size_t i) { return step >= 0 && step < static_cast<int>(i); };
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const Step& s = steps_[i];
    const bool right = s.op == Op::constant   ? true
                       : s.op == Op::variable ? s.a >= 0
                                              : earlier(s.a, i) && (!binary(s.op) || earlier(s.b, i));
    if (!right) throw std::invalid_argument("a formula's step refers to none before it");
  }
}

template <class T>
T Formula::evaluate(std::span<const T> variables) const {
  if (steps_.empty()) return {};
  std::array<T, kOnStack> few;
  std::vector<T> many(steps_.size() > kOnStack ? steps_.size() : 0);
  T* r = many.empty() ? few.data() : many.data();
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const Step& s = steps_[i];
    const auto a = [&]() -> const T& { return r[static_cast<std::size_t>(s.a)]; };
    const auto b = [&]() -> const T& { return r[static_cast<std::size_t>(s.b)]; };
    switch (s.op) {
      case Op::constant:
        r[i] = s.value;
        break;
      case Op::variable:
        r[i] =
            static_cast<std::size_t>(s.a) < variables.size() ? variables[static_cast<std::size_t>(s.a)] : T();
        break;
      case Op::add:
        r[i] = a() + b();
        break;
      case Op::subtract:
        r[i] = a() - b();
        break;
      case Op::multiply:
        r[i] = a() * b();
        break;
      case Op::divide:
        r[i] = a() / b();
        break;
      case Op::smaller:
        r[i] = smaller(a(), b());
        break;
      case Op::larger:
        r[i] = -smaller(-a(), -b());
        break;
      case Op::negate:
        r[i] = -a();
        break;
      case Op::power:
        r[i] = pow(a(), s.value);
        break;
      default:
        r[i] = value_of(function_of(s.op), a());
    }
  }
  return r[steps_.size() - 1];
}

Dual Formula::at(std::span<const Dual> variables) const { return evaluate(variables); }

Ranged Formula::over(std::span<const Ranged> variables) const { return evaluate(variables); }

std::string Formula::text(std::span<const std::string> names) const {
  if (steps_.empty()) return "0";
  /// How tightly a part holds together: only what is read back in another order otherwise stands in parentheses.
  enum Tightness { sum, product, sign, power, item };
  struct Part {
    std::string text;
    Tightness tightness = item;
  };
  std::vector<Part> parts(steps_.size());
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const Step& s = steps_[i];
    const auto part = [&](int step, Tightness least) {
      const Part& p = parts[static_cast<std::size_t>(step)];
      return p.tightness >= least ? p.text : "(" + p.text + ")";
    };
    const auto call = [&](const char* name) {
      return Part{std::string(name) + "(" + part(s.a, sum) + (binary(s.op) ? ", " + part(s.b, sum) : "") +
                  ")"};
    };
    switch (s.op) {
      case Op::constant:
        parts[i] = {digits(s.value), s.value < 0.0 ? sign : item};
        break;
      case Op::variable:
        parts[i] = {static_cast<std::size_t>(s.a) < names.size() ? names[static_cast<std::size_t>(s.a)]
                                                                 : "0"};
        break;
      case Op::add:
        parts[i] = {part(s.a, sum) + " + " + part(s.b, product), sum};
        break;
      case Op::subtract:
        parts[i] = {part(s.a, sum) + " - " + part(s.b, product), sum};
        break;
      case Op::multiply:
        parts[i] = {part(s.a, product) + " * " + part(s.b, sign), product};
        break;
      case Op::divide:
        parts[i] = {part(s.a, product) + " / " + part(s.b, sign), product};
        break;
      case Op::smaller:
        parts[i] = call("min");
        break;
      case Op::larger:
        parts[i] = call("max");
        break;
      case Op::negate:
        parts[i] = {"-" + part(s.a, power), sign};
        break;
      case Op::power:
        parts[i] = {part(s.a, item) + "^" + digits(s.value), power};
        break;
      default:
        parts[i] = call(function_of(s.op).name);
    }
  }
  return parts.back().text;
}

}  // namespace drev
