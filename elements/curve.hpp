#pragma once
/// A point of a known curve.

namespace drev {

struct CurvePoint {
  double value = 0.0;
  double slope = 0.0;  ///< d value / d argument
};

}  // namespace drev
