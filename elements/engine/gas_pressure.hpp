#pragma once
/// GasPressure: the pressure in a cylinder over the crank angle, as measured or calculated curves.
///
///   p(a) = curve(a)                                  one curve
///   p(a) = curves at two speeds (or loads), linear between them, constant beyond the first and last
///   p(a) = curve(a) peak(speed)/reference            one curve, scaled by the peak pressure over speed
///
/// a: angle of the table; firing top dead centre at `firing_tdc`. Linear or cubic (periodic_curve.hpp) between the
/// points. Misfire: no injection, compression stays: the pressure behind the firing dead centre is the one as far
/// before it, p(firing_tdc + d) = p(firing_tdc - d), 0 < d < half a period.
///
/// Gate by speed (curve.hpp) over the size of the speed: g p of the curve + (1 - g) p of the compression alone, so
/// that an engine that is cranked fires from a speed on, and one whose governor cuts the fuel stops firing above another.
#include <drev/core/law/law_piece.hpp>
#include <drev/elements/curve.hpp>
#include <drev/elements/not_given.hpp>
#include <drev/elements/periodic_curve.hpp>

#include <vector>

namespace drev {

class GasPressure {
 public:
  struct Params {
    /// Points of the curves, in blocks of one speed (or load) each, ascending [rad], [Pa]. A last point of a block
    /// one period after its first closes the curve, with a jump where its value differs.
    std::vector<double> angle = {}, pressure = {};
    std::vector<double> speed = {};  ///< of each point [rad/s]; empty: one curve for all
    std::vector<double> load = {};   ///< of each point [-], instead of speeds; empty: one curve for all
    double at_load = 1.0;            ///< load that the curves are taken at
    std::vector<double> peak_speed = {}, peak_pressure = {};  ///< [rad/s], [Pa]; constant beyond the ends
    double reference_pressure = kNotGiven;  ///< of the peaks [Pa], > 0; not given: the largest of the curve
    double firing_tdc = 0.0;                ///< angle of the table at the firing top dead centre [rad]
    Interpolation interpolation = Interpolation::linear;
    SpeedGate firing = {};  ///< where it fires; elsewhere its cylinders only compress
  };
  struct Point {
    double pressure = 0.0, angle_slope = 0.0, speed_slope = 0.0;  ///< Pa, Pa/rad, Pa s/rad
  };

  GasPressure() = default;
  /// period: 4 pi of four strokes, 2 pi of two [rad].
  GasPressure(Params params, double period);

  /// angle: from the firing top dead centre [rad]; speed of the crank, its size counts [rad/s].
  Point at(double angle, double speed, bool misfires) const;
  /// The pressure at a speed is sum_k factors(speed)[k] curve(k, angle): one factor a curve; with a gate the curves of
  /// compression alone follow, with factors of their own.
  std::vector<double> factors(double speed) const;
  double curve(int k, double angle, bool misfires) const;
  /// The pressure about an angle as a cubic, from knot to knot of all its curves, whatever the speed (a KnottedLoad's piece).
  CubicPiece piece(double angle, double direction, double speed, bool misfires) const;
  /// The largest size of its slope by the size of the speed, over ranges of the angle and of that size [Pa s/rad].
  double steepest_by_speed(const Interval& angle, const Interval& size, bool misfires) const;
  bool follows_speed() const {
    return !params_.speed.empty() || !params_.peak_speed.empty() || params_.firing.gated();
  }
  bool empty() const { return params_.angle.empty(); }
  const Params& params() const { return params_; }
  void check(ParameterCheck& check) const;

 private:
  struct Scale {
    double factor = 1.0, slope = 0.0;  // of the pressure by the peak over speed; by the size of the speed
  };
  Scale peak_scale(double size) const;
  Point ungated(double angle, double speed, bool misfires) const;
  std::vector<double> ungated_factors(double size) const;
  CubicPiece ungated_piece(double angle, double direction, const std::vector<double>& parts,
                           bool misfires) const;
  double largest(const Interval& angle, const std::vector<double>& parts, bool misfires) const;
  double firing_part(double size) const { return params_.firing.at(size).value; }
  double mirrored(double& angle, bool misfires) const;  // -1 behind the firing dead centre, with its angle
  Params params_;
  double period_ = 0.0, reference_ = 0.0;
  CurveFamily curves_;
  std::vector<double> bends_;  // sizes of the speed between which its factors are parabolas, ascending
  bool sizes_fit_ = false;
};

}  // namespace drev
