#pragma once
/// SpeedScaledLoad: what a Load may say besides: at a steady speed w of its node, where nothing deviates, its torque
/// is curves over the angle, scaled by functions of the speed alone,
///
///   tau(theta, w) = sum_k f_k(w) S_k(theta)
///
/// and its slope dtau/dw has the mean 0 over a cycle. It does not depend on the time. Sweeps over speed then find the
/// orders of each curve once.
#include <vector>

namespace drev {

class SpeedScaledLoad {
 public:
  /// Loads with the same curves, one behind the other, such as the cylinders of an engine:
  /// S_k(theta) = C_k(theta - start), C_k of all loads of one `id`.
  struct Family {
    const void* id = nullptr;  ///< null: a load alone
    double start = 0.0;        ///< rad of the node
  };
  virtual ~SpeedScaledLoad() = default;
  /// f_k(w), as many at every speed; w with its sign [rad/s].
  virtual std::vector<double> speed_factors(double speed) const = 0;
  /// S_k(theta) [N m over f_k's unit].
  virtual double curve(int k, double angle) const = 0;
  virtual Family family() const { return {}; }
};

}  // namespace drev
