#pragma once
/// FrequencyStiffness: a complex stiffness that depends on the frequency, for methods in the frequency domain
/// (drev sweep). A torque T exp(i omega t) on a deflection X exp(i omega t): T = k*(omega) X, Re k* >= 0 and
/// Im k* >= 0 for omega > 0 of the whole element. Methods in time do not see it.
#include <complex>

namespace drev {

class FrequencyStiffness {
 public:
  virtual ~FrequencyStiffness() = default;
  /// k* less what the element's own matrices give at the circular frequency omega > 0 [rad/s]; N m/rad.
  virtual std::complex<double> beyond_matrices(double omega) const = 0;
};

}  // namespace drev
