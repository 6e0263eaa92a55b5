#pragma once
/// Expressions in a model file: a text where a number is expected.
///
///   sum     = product { (+|-) product }
///   product = sign { (*|/) sign }
///   sign    = [-|+] sign | item
///   item    = number | pi | NAME | LIST[sum] | position(LIST, sum) | ( sum )
///
/// NAME is a parameter or a counter of a repeat; LIST one of [lists], counted from 1; position() is the place
/// of a number in a list; {sum} in a name is replaced by its value first. Numbers are as written, in the unit
/// that a parameter's name ends in; that unit goes with the value as far as it can be followed: sums need
/// like units, a plain number takes any, the quotient of like units has none, and a product of two units is
/// not followed further.
#include <map>
#include <string>
#include <vector>

namespace drev::app {

/// A number and what is known of its unit.
struct Quantified {
  double value = 0.0;
  std::string unit = {};      ///< suffix, e.g. "mm"; empty: none
  bool unit_followed = true;  ///< false: a product of units, not checked
};

/// What names stand for.
struct Scope {
  std::map<std::string, double> numbers;  ///< parameters and counters
  std::map<std::string, std::vector<double>> lists;
  std::vector<std::string> names() const;
};

/// Throws ExpressionError.
Quantified evaluate(const std::string& text, const Scope& scope);

/// Replaces each {EXPRESSION} of a name by its value, a whole number: "fuel_{i}". Throws ExpressionError.
std::string expand(const std::string& text, const Scope& scope);

/// What is wrong with an expression, as a sentence without its place.
struct ExpressionError {
  std::string sentence;
};

}  // namespace drev::app
