#pragma once
/// Weights: with which factors the matrices of a system are summed.

namespace drev {

/// S = m M + c C + k K + the laws' slopes with the same weights. Static, implicit steps and modal shifts
/// are this one call. With the acceleration as unknown: m = 1 - alpha_m, c = (1 - alpha_f) gamma h, ...
struct Weights {
  double m = 0.0, c = 0.0, k = 0.0;
};

}  // namespace drev
