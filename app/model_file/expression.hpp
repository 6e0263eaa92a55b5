#pragma once
/// Expressions in a model file: a text where a number is expected.
///
///   sum     = product { (+|-) product }
///   product = sign { (*|/) sign }
///   sign    = [-|+] sign | power
///   power   = item [^ sign]
///   item    = number | pi | NAME | LIST[sum] | position(LIST, sum) | FUNCTION(sum {, sum}) | ( sum )
///
///   condition  = both { or both }
///   both       = comparison { and comparison }
///   comparison = side (== | != | < | <= | > | >=) side | not comparison | ( condition )
///   side       = sum | 'text' | the name of a parameter that is a text
///
/// NAME is a parameter or a counter of a repeat; LIST one of [lists], counted from 1; position() is the place of a
/// number in a list; {sum} in a name is replaced by its value first. FUNCTION: sqrt, abs, exp, log (natural), sin, cos,
/// tan (of deg where the unit says so, else of rad), min, max, si (the value in SI), plain (without its unit). Numbers
/// are as written, in the unit that a parameter's name ends in; that unit goes with the value (quantified.hpp).
#include <drev/app/model_file/fields.hpp>
#include <drev/elements/formula.hpp>

#include <map>
#include <string>
#include <vector>

#include "app/model_file/quantified.hpp"

namespace drev::app {

/// What names stand for.
struct Scope {
  std::map<std::string, double> numbers;  ///< parameters and counters
  std::map<std::string, std::vector<double>> lists;
  std::map<std::string, std::string> texts = {};  ///< parameters that are texts
  std::vector<std::string> names() const;
};

/// Throws ExpressionError.
Quantified evaluate(const std::string& text, const Scope& scope);

/// The same text with variables, compiled; the result is in `unit` or a plain number. Variables are plain numbers where
/// that makes a whole, else they have the unit that their name ends in. Throws ExpressionError.
Formula compile(const std::string& text, const Scope& scope, const std::vector<FormulaVariable>& variables,
                const std::string& unit);

/// Whether a condition holds: "drive == 'gears' and cylinders > 4". Throws ExpressionError.
bool holds(const std::string& condition, const Scope& scope);

/// Replaces each {EXPRESSION} of a name by its value, a whole number, or the text of a parameter: "fuel_{i}". Throws ExpressionError.
std::string expand(const std::string& text, const Scope& scope);

/// What is wrong with an expression, as a sentence without its place.
struct ExpressionError {
  std::string sentence;
};

}  // namespace drev::app
