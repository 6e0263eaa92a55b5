#include "app/model_file/read_values.hpp"

#include <drev/models/parameters.hpp>

#include <cmath>

namespace drev::app {

std::optional<double> read_number(const Value& value, const std::string& unit, const std::string& where,
                                  ReadContext& context) {
  const auto refuse = [&](const std::string& sentence) {
    context.findings.push_back(fault_at(value.at, where, sentence));
    return std::nullopt;
  };
  if (value.numeric()) {
    if (!std::isfinite(value.number)) return refuse("must be finite, not " + to_text(value.number));
    return value.number;
  }
  if (!value.is(Value::Kind::text))
    return refuse("must be a number, or an expression in quotes, not " + kind_name(value));
  try {
    const Quantified result = evaluate(value.text, context.scope);
    if (!result.fits(unit))
      return refuse("the expression \"" + value.text + "\" is in " + result.unit + ", the key " +
                    (unit.empty() ? "has no unit" : "in " + unit) + result.how_to_fit(unit));
    return result.value;
  } catch (const ExpressionError& error) {
    return refuse(error.sentence);
  }
}

std::optional<int> read_whole(const Value& value, int low, int high, const std::string& where,
                              ReadContext& context) {
  const std::optional<double> number = read_number(value, "", where, context);
  if (!number) return std::nullopt;
  if (*number == std::floor(*number) && *number >= low && *number <= high) return static_cast<int>(*number);
  context.findings.push_back(fault_at(value.at, where,
                                      "must be a whole number from " + std::to_string(low) + " to " +
                                          std::to_string(high) + ", not " + to_text(*number)));
  return std::nullopt;
}

std::optional<std::string> read_text(const Value& value, const std::string& where, ReadContext& context) {
  std::string sentence = "must be a text in quotes, not " + kind_name(value);
  if (value.is(Value::Kind::text)) {
    try {
      return expand(value.text, context.scope);
    } catch (const ExpressionError& error) {
      sentence = error.sentence;
    }
  }
  context.findings.push_back(fault_at(value.at, where, sentence));
  return std::nullopt;
}

std::vector<std::string> read_texts(const Value& value, const std::string& where, ReadContext& context) {
  std::vector<std::string> all;
  if (value.is(Value::Kind::array)) {
    for (const Value& item : value.items)
      if (const auto text = read_text(item, where, context)) all.push_back(*text);
  } else if (const auto text = read_text(value, where, context)) {
    all.push_back(*text);
  }
  return all;
}

}  // namespace drev::app
