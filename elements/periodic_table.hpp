#pragma once
/// PeriodicTable: a measured periodic curve, linear between its points and from last to first.
///
///   value(u) = v_i + s_i (u - u_i)      u_i <= u < u_{i+1},   u = argument modulo the period
///
/// The slope is that of the segment to the right of u. Points need not be evenly spaced and need
/// not start at zero; the first one is not repeated at the end. Evenly spaced tables are looked up
/// in constant time, others by bisection.
#include <drev/core/error.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/curve.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace drev {

struct LoadTable;

/// The straight stretch of a table about an argument; it holds from low to high.
struct TableStretch {
  double value = 0.0, slope = 0.0;  ///< at the argument
  double low = 0.0, high = 0.0;     ///< infinite where the slope never changes
};

class PeriodicTable {
 public:
  PeriodicTable() = default;  ///< empty: check() reports it
  /// arguments strictly ascending, all within one period.
  PeriodicTable(std::vector<double> arguments, std::vector<double> values, double period = kTwoPi);

  CurvePoint at(double argument) const;
  /// Knots where the slope does not change are passed over. Within rounding of a knot the stretch ahead
  /// of it: above it where direction > 0, else below.
  TableStretch stretch(double argument, double direction) const;
  /// The next argument at which the slope changes, upwards where direction > 0; within rounding of one, the
  /// next but that; none where it never does.
  std::optional<double> next_knot(double argument, double direction) const;
  /// The same curve as a load's table, entered `phase` ahead. It refers to this table's points.
  LoadTable as_load(double phase = 0.0) const;
  double mean() const;  ///< over one period
  double period() const { return period_; }
  const std::vector<double>& arguments() const { return points_->arguments; }
  const std::vector<double>& values() const { return points_->values; }
  const std::vector<double>& slopes() const { return points_->slopes; }  ///< to the right of each point
  /// Point k lies within a quarter of period/n of where it would lie in a table of even spacing.
  bool evenly_spaced() const { return inverse_spacing_ > 0.0; }
  void check(ParameterCheck& check, const std::string& parameter, const std::string& argument_unit,
             const std::string& value_unit) const;

 private:
  struct Points {
    std::vector<double> arguments, values, slopes;
  };
  std::shared_ptr<const Points> points_ = std::make_shared<const Points>();  // shared by its copies
  double period_ = kTwoPi, inverse_period_ = 1.0 / kTwoPi;
  double inverse_spacing_ = 0.0;  // > 0 for an evenly spaced table
};

}  // namespace drev
