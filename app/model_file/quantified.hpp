#pragma once
/// A number with what is known of its unit, and what arithmetic does with it.
///
/// A plain number takes any unit. A single unit is known by its name: sums and keys need the same one. A product or
/// quotient of several is known by its powers of kg, m and s and by its size in SI: it fits what has the same.
#include <drev/app/model_file/units.hpp>

#include <string>

namespace drev::app {

struct Quantified {
  double value = 0.0;
  std::string unit = {};  ///< suffix, "mm"; of several, how they were combined, "N*mm"; empty: a plain number
  bool combined = false;  ///< of several
  UnitParts parts = {};

  /// A value in the unit of a suffix; a plain number where it is empty.
  static Quantified of(double value, const std::string& suffix);
  bool plain() const { return unit.empty(); }
  /// Whether it may stand where this unit is needed.
  bool fits(const std::string& suffix) const;
};

/// Empty, and then a + b of the values: +1, -1; else what is wrong: "adds mm and s".
std::string add(const Quantified& a, const Quantified& b, double sign, Quantified& sum);
Quantified multiply(const Quantified& a, const Quantified& b);
Quantified divide(const Quantified& a, const Quantified& b);
/// a^exponent.
Quantified power(const Quantified& a, double exponent);
/// In SI: 5 of mm is 0.005 of m.
Quantified in_si(const Quantified& a);

}  // namespace drev::app
