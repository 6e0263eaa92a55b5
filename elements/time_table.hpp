#pragma once
/// TimeTable: a curve over time, linear between its points, constant before and after them.
///
/// The same time given twice makes a jump: the first value holds before it, the second from it on
/// (the curve is right-continuous). Every knot is a breakpoint: integration stops there and starts
/// again.
#include <drev/core/error.hpp>
#include <drev/elements/curve.hpp>

#include <string>
#include <vector>

namespace drev {

class TimeTable {
 public:
  TimeTable() = default;  ///< empty: check() reports it
  /// times ascending [s], each at most twice.
  TimeTable(std::vector<double> times, std::vector<double> values)
      : times_(std::move(times)), values_(std::move(values)) {}

  CurvePoint at(double t) const;
  const std::vector<double>& times() const { return times_; }
  const std::vector<double>& values() const { return values_; }
  std::vector<double> breakpoints() const;  ///< the knots, each once [s]; none of a constant
  void check(ParameterCheck& check, const std::string& parameter, const std::string& value_unit) const;

 private:
  std::vector<double> times_, values_;
};

}  // namespace drev
