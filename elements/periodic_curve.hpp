#pragma once
/// PeriodicCurve: a periodic curve through points, linear or a cubic spline between them.
///
///   linear   as PeriodicTable
///   cubic    v_i + b_i s + c_i s^2 + d_i s^3,  s = u - u_i      u_i <= u < u_{i+1}
///
/// The spline has value, slope and curvature continuous everywhere, across the end of the period too; between
/// points of a smooth curve, h apart, it is off by 5/384 h^4 max|f''''| at most. It may overshoot beside steep
/// steps. Source: C. de Boor, A Practical Guide to Splines, Springer, 1978, chapter IV (periodic end conditions).
#include <drev/core/law/knotted_load.hpp>
#include <drev/elements/periodic_table.hpp>

#include <memory>
#include <string>
#include <vector>

namespace drev {

enum class Interpolation { linear, cubic };

class PeriodicCurve {
 public:
  PeriodicCurve() = default;  ///< empty: check() reports it
  PeriodicCurve(PeriodicTable points, Interpolation interpolation);

  CurvePoint at(double argument) const;
  /// The cubic (or straight line) about an argument, from knot to knot; within rounding of a knot the one ahead of
  /// it: above it where direction > 0, else below.
  CubicPiece piece(double argument, double direction) const;
  double mean() const;  ///< over one period
  const PeriodicTable& points() const { return points_; }
  Interpolation interpolation() const { return interpolation_; }
  /// As PeriodicTable::check(); a spline needs at least 3 points.
  void check(ParameterCheck& check, const std::string& parameter, const std::string& argument_unit,
             const std::string& value_unit) const;

 private:
  struct Cubic {
    double b, c, d;
  };
  PeriodicTable points_;
  Interpolation interpolation_ = Interpolation::linear;
  std::shared_ptr<const std::vector<Cubic>> segments_;  // of the spline; shared by its copies
};

/// Curves over one argument at several values of a parameter (load or speed): linear between the values of the
/// parameter, constant beyond the first and the last.
class CurveFamily {
 public:
  struct Point {
    double value = 0.0, slope = 0.0;  ///< slope: by the argument
    double parameter_slope = 0.0;     ///< by the parameter; 0 beyond the first and last value
  };
  CurveFamily() = default;
  /// parameters ascending, one for each curve; a single curve needs none.
  CurveFamily(std::vector<PeriodicCurve> curves, std::vector<double> parameters)
      : curves_(std::move(curves)), parameters_(std::move(parameters)) {}

  Point at(double argument, double parameter) const;
  const std::vector<PeriodicCurve>& curves() const { return curves_; }
  const std::vector<double>& parameters() const { return parameters_; }

 private:
  std::vector<PeriodicCurve> curves_;
  std::vector<double> parameters_;
};

}  // namespace drev
