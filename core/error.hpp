#pragma once
/// Errors of input. Everything wrong with a model is collected and thrown at once.
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace drev {

/// One thing that is wrong: where, which parameter, its value and unit, and what is admissible.
struct Finding {
  std::string place;      ///< model, element or node, e.g. "camshaft/mesh_1"
  std::string parameter;  ///< as the API or the parameter spells it; empty if none applies
  std::string value;      ///< as given, e.g. "-0.0001"
  std::string unit;       ///< SI unit, e.g. "m"; empty if it has none
  std::string range;      ///< what is admissible, e.g. "must be >= 0"
  /// In one line; control characters are shown as \xNN.
  std::string text() const;
};

}  // namespace drev

extern template class std::vector<drev::Finding>;  // compiled once, in error.cpp

namespace drev {

/// Bad input: carries every finding. what() lists them, one a line.
class ModelError : public std::runtime_error {
 public:
  explicit ModelError(std::vector<Finding> findings);
  const std::vector<Finding>& findings() const { return findings_; }

 private:
  std::vector<Finding> findings_;
};

/// A computation that could not do its job (no convergence, singular matrix, state no longer
/// finite). what() says at which time and place, and what to try.
class SolverError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Collects what is wrong with the parameters of one place.
class ParameterCheck {
 public:
  ParameterCheck(std::string place, std::vector<Finding>& findings)
      : place_(std::move(place)), findings_(findings) {}

  void finite(std::string_view parameter, double value, std::string_view unit);
  void positive(std::string_view parameter, double value, std::string_view unit);
  void non_negative(std::string_view parameter, double value, std::string_view unit);
  /// low <= value <= high.
  void within(std::string_view parameter, double value, double low, double high, std::string_view unit);
  /// Strictly increasing and finite.
  void increasing(std::string_view parameter, const std::vector<double>& values, std::string_view unit);
  void all_finite(std::string_view parameter, const std::vector<double>& values, std::string_view unit);
  void fail(std::string_view parameter, std::string value, std::string_view unit, std::string range);
  const std::string& place() const { return place_; }

 private:
  std::string place_;
  std::vector<Finding>& findings_;
};

/// Shortest decimal text that reads back to the same double.
std::string to_text(double value);

/// The candidate closest in spelling (edit distance), or empty if none is near.
std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates);
/// Bytes of the control character (C0, DEL or C1, in UTF-8) that begins at text[at]; 0: none does.
std::size_t control_bytes(std::string_view text, std::size_t at);
bool has_control_characters(std::string_view text);
/// "; did you mean 'x'?" or empty.
std::string did_you_mean(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace drev
