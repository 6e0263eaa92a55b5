#pragma once
/// Named parameters of a ready-made model, with unit, default and range: what `drev list` shows and `--set
/// name=value` changes.
#include <drev/core/error.hpp>

#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace drev {

inline constexpr double kNoLimit = std::numeric_limits<double>::max();

/// Description of one parameter.
struct Parameter {
  enum class Kind { number, integer, choice, order };
  std::string name;
  Kind kind = Kind::number;
  std::string default_text;
  std::string unit = {};                  ///< empty: none
  double low = 0.0, high = 0.0;           ///< range of numbers and integers, ends included; +-kNoLimit: none
  std::vector<std::string> choices = {};  ///< of a choice
  std::string meaning = {};
  /// Range as text: "6 to 10", "gears | held | free", ...
  std::string range() const;
};

/// Parameters that differ from their defaults: name and value.
using ParameterValues = std::vector<std::pair<std::string, std::string>>;

/// Values for the parameters of one model: the defaults, then what was set.
class Parameters {
 public:
  Parameters(std::string model, std::vector<Parameter> known);

  /// Reads "name" = "value". What is wrong (no such name, no number, out of range) is kept for check().
  void set(const std::string& name, const std::string& value);
  /// Throws ModelError with everything that was wrong.
  void check() const;
  /// Adds a finding of the model's own, e.g. a combination that cannot be.
  void refuse(const std::string& name, const std::string& why);

  double number(const std::string& name) const;
  int integer(const std::string& name) const;
  const std::string& text(const std::string& name) const;
  /// An order such as 1-5-3-6-2-4.
  std::vector<int> order(const std::string& name) const;

  const std::vector<Parameter>& known() const { return known_; }
  const std::vector<std::string>& values() const { return values_; }

 private:
  std::size_t find(const std::string& name) const;

  std::string model_;
  std::vector<Parameter> known_;
  std::vector<std::string> values_;
  std::vector<Finding> findings_;
};

/// Reads a whole decimal number; false if the text is anything else.
bool read_number(const std::string& text, double& value);

}  // namespace drev
