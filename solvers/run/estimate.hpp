#pragma once
/// Estimate: a computed value with its error. Figure: an estimate with its name, unit and scale.
#include <string>

namespace drev {

struct Estimate {
  enum class Kind {
    bound,     ///< the error is no larger: what rounded data leave open
    estimate,  ///< error estimated, from two runs of different accuracy or from the terms left out: no bound
    interval,  ///< half-width of a 95 % confidence interval of a statistic
    measured   ///< the largest error that the method was measured to make on problems with known solutions
  };
  double value = 0.0;
  double error = 0.0;  ///< >= 0, of the value's unit; infinity: unknown
  Kind kind = Kind::estimate;
};

struct Figure : Estimate {
  std::string name, unit;
  double scale = 0.0;  ///< >= 0: what the error is compared with, of the value's unit
  bool keeps(double accuracy) const { return error <= accuracy * scale; }
  /// Error over scale [-]; 0 without a scale.
  double relative() const { return scale > 0.0 ? error / scale : 0.0; }
};

}  // namespace drev
