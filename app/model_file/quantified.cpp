#include "app/model_file/quantified.hpp"

#include <cmath>

namespace drev::app {

namespace {

constexpr double kRounding = 1e-9;  // relative, of factors of units

bool same(const UnitParts& a, const UnitParts& b) {
  return a.kg == b.kg && a.m == b.m && a.s == b.s && std::abs(a.factor - b.factor) <= kRounding * b.factor;
}

/// a times b to the power `sign`, which is 1 or -1.
Quantified combine(const Quantified& a, const Quantified& b, double sign) {
  Quantified c{sign > 0.0 ? a.value * b.value : a.value / b.value};
  if (b.plain()) {
    c.unit = a.unit, c.combined = a.combined, c.parts = a.parts;
    return c;
  }
  if (a.plain() && sign > 0.0) {
    c.unit = b.unit, c.combined = b.combined, c.parts = b.parts;
    return c;
  }
  c.parts = {a.parts.kg + sign * b.parts.kg, a.parts.m + sign * b.parts.m, a.parts.s + sign * b.parts.s,
             sign > 0.0 ? a.parts.factor * b.parts.factor : a.parts.factor / b.parts.factor};
  if (same(c.parts, UnitParts{})) return Quantified{c.value};
  c.unit = (a.plain() ? "1" : a.unit) + (sign > 0.0 ? "*" : "/") + (b.combined ? "(" + b.unit + ")" : b.unit);
  c.combined = true;
  return c;
}

}  // namespace

Quantified Quantified::of(double value, const std::string& suffix) {
  return {value, suffix, false, suffix.empty() ? UnitParts{} : unit_parts(suffix)};
}

bool Quantified::fits(const std::string& suffix) const {
  if (plain() || unit == suffix) return true;
  return combined && same(parts, suffix.empty() ? UnitParts{} : unit_parts(suffix));
}

std::string add(const Quantified& a, const Quantified& b, double sign, Quantified& sum) {
  const bool like =
      a.plain() || b.plain() || a.unit == b.unit || ((a.combined || b.combined) && same(a.parts, b.parts));
  if (!like) return "adds " + a.unit + " and " + b.unit;
  Quantified result = a.plain() ? b : a;
  result.value = a.value + sign * b.value;
  sum = result;
  return {};
}

Quantified multiply(const Quantified& a, const Quantified& b) { return combine(a, b, 1.0); }
Quantified divide(const Quantified& a, const Quantified& b) { return combine(a, b, -1.0); }

Quantified power(const Quantified& a, double exponent) {
  Quantified result{std::pow(a.value, exponent)};
  if (a.plain() || exponent == 0.0) return result;
  result.unit = "(" + a.unit + ")^" + std::to_string(exponent).substr(0, 4);
  result.combined = true;
  result.parts = {exponent * a.parts.kg, exponent * a.parts.m, exponent * a.parts.s,
                  std::pow(a.parts.factor, exponent)};
  if (exponent == 1.0) result.unit = a.unit, result.combined = a.combined;
  return result;
}

Quantified in_si(const Quantified& a) {
  if (a.plain()) return a;
  Quantified result = a;
  result.value *= a.parts.factor;
  result.parts.factor = 1.0;
  result.unit = "SI(" + a.unit + ")";
  result.combined = true;
  return result;
}

}  // namespace drev::app
