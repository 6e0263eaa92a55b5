#include "app/model_file/quantified.hpp"

namespace drev::app {

namespace {

constexpr double kRounding = 1e-9;  // relative, of factors of units

bool same(const UnitParts& a, const UnitParts& b) {
  return a.kg == b.kg && a.m == b.m && a.s == b.s && std::abs(a.factor - b.factor) <= kRounding * b.factor;
}

}  // namespace

KnownUnit known_unit(const std::string& suffix) {
  return {suffix, false, suffix.empty() ? UnitParts{} : unit_parts(suffix)};
}

bool KnownUnit::fits(const std::string& suffix) const {
  if (plain() || unit == suffix) return true;
  return combined && same(parts, suffix.empty() ? UnitParts{} : unit_parts(suffix));
}

std::string KnownUnit::how_to_fit(const std::string& suffix) const {
  if (!combined) return "";
  return std::string("; ") + (in_si(*this).fits(suffix) ? "si(...) gives it in SI, " : "") +
         "plain(...) gives the number without a unit";
}

bool KnownUnit::like(const KnownUnit& other) const {
  return plain() || other.plain() || unit == other.unit ||
         ((combined || other.combined) && same(parts, other.parts));
}

KnownUnit combine(const KnownUnit& a, const KnownUnit& b, double sign) {
  if (b.plain()) return a;
  if (a.plain() && sign > 0.0) return b;
  KnownUnit c;
  c.parts = {a.parts.kg + sign * b.parts.kg, a.parts.m + sign * b.parts.m, a.parts.s + sign * b.parts.s,
             sign > 0.0 ? a.parts.factor * b.parts.factor : a.parts.factor / b.parts.factor};
  if (same(c.parts, UnitParts{})) return {};
  c.unit = (a.plain() ? "1" : a.unit) + (sign > 0.0 ? "*" : "/") + (b.combined ? "(" + b.unit + ")" : b.unit);
  c.combined = true;
  return c;
}

KnownUnit power(const KnownUnit& a, double exponent) {
  if (a.plain() || exponent == 0.0) return {};
  if (exponent == 1.0) return a;
  return {"(" + a.unit + ")^" + std::to_string(exponent).substr(0, 4),
          true,
          {exponent * a.parts.kg, exponent * a.parts.m, exponent * a.parts.s,
           std::pow(a.parts.factor, exponent)}};
}

KnownUnit in_si(const KnownUnit& a) {
  if (a.plain()) return a;
  KnownUnit result = a;
  result.parts.factor = 1.0;
  result.unit = "SI(" + a.unit + ")";
  result.combined = true;
  return result;
}

}  // namespace drev::app
