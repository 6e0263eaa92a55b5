#pragma once
/// A number with what is known of its unit, and what arithmetic does with it.
///
/// A plain number takes any unit. A single unit is known by its name: sums and keys need the same one. A product or
/// quotient of several is known by its powers of kg, m and s and by its size in SI: it fits what has the same. The number
/// is a double, or what stands for one in a formula that is compiled (expression.cpp).
#include <drev/app/model_file/units.hpp>

#include <cmath>
#include <string>

namespace drev::app {

/// A unit, as far as it is known.
struct KnownUnit {
  std::string unit = {};  ///< suffix, "mm"; of several, how they were combined, "N*mm"; empty: a plain number
  bool combined = false;  ///< of several
  UnitParts parts = {};

  bool plain() const { return unit.empty(); }
  /// Whether it may stand where this unit is needed.
  bool fits(const std::string& suffix) const;
  /// What makes it fit, for a message: "; si(...) gives it in SI, ..."; empty for a single unit.
  std::string how_to_fit(const std::string& suffix) const;
  /// Whether both may be added.
  bool like(const KnownUnit& other) const;
};
/// Of a product (sign 1) or quotient (-1).
KnownUnit combine(const KnownUnit& a, const KnownUnit& b, double sign);
KnownUnit power(const KnownUnit& a, double exponent);
KnownUnit in_si(const KnownUnit& a);
/// Of a suffix; plain where it is empty.
KnownUnit known_unit(const std::string& suffix);

template <class Number>
struct QuantifiedOf : KnownUnit {
  Number value = 0.0;

  QuantifiedOf() = default;
  QuantifiedOf(Number v, KnownUnit u = {})
      : KnownUnit(std::move(u)), value(std::move(v)) {}  // NOLINT: plain numbers
  /// A value in the unit of a suffix; a plain number where it is empty.
  static QuantifiedOf of(Number value, const std::string& suffix) { return {value, known_unit(suffix)}; }
};
using Quantified = QuantifiedOf<double>;

/// Empty, and then a + b of the values: +1, -1; else what is wrong: "adds mm and s".
template <class Number>
std::string add(const QuantifiedOf<Number>& a, const QuantifiedOf<Number>& b, double sign,
                QuantifiedOf<Number>& sum) {
  if (!a.like(b)) return "adds " + a.unit + " and " + b.unit;
  const KnownUnit& unit = a.plain() ? b : a;
  sum = {sign > 0.0 ? a.value + b.value : a.value - b.value, unit};
  return {};
}
template <class Number>
QuantifiedOf<Number> multiply(const QuantifiedOf<Number>& a, const QuantifiedOf<Number>& b) {
  return {a.value * b.value, combine(a, b, 1.0)};
}
template <class Number>
QuantifiedOf<Number> divide(const QuantifiedOf<Number>& a, const QuantifiedOf<Number>& b) {
  return {a.value / b.value, combine(a, b, -1.0)};
}
/// a^exponent.
template <class Number>
QuantifiedOf<Number> power(const QuantifiedOf<Number>& a, double exponent) {
  using std::pow;
  return {pow(a.value, exponent), power(static_cast<const KnownUnit&>(a), exponent)};
}
/// In SI: 5 of mm is 0.005 of m.
template <class Number>
QuantifiedOf<Number> in_si(const QuantifiedOf<Number>& a) {
  return {a.plain() ? a.value : a.value * a.parts.factor, in_si(static_cast<const KnownUnit&>(a))};
}

}  // namespace drev::app
