#pragma once
/// A range of admissible values, declared beside the option that it limits: the check and every message on it
/// are made from this one place.
namespace drev {

/// From low to high, both included, in the unit of the value.
struct Range {
  double low = 0.0, high = 0.0;
  bool holds(double value) const { return value >= low && value <= high; }  ///< false for NaN
};

}  // namespace drev
