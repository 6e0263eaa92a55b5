#pragma once
/// Gears of random trains by a code of its own: their equations, and elimination.
#include <algorithm>
#include <cmath>
#include <utility>

#include "tests/stability/friction/friction_train.hpp"

namespace drev::test {

using TrainGear = FrictionTrain::Gear;

struct GearMode {
  int turns = 0;   ///< sign of the speed of a; 0: stuck
  int drives = 0;  ///< 0: a, 1: b
  bool rests = false, beyond = false;
};

inline TrainGear::Loss loss_at(const TrainGear& g, double speed) {
  if (g.knot_speed == 0.0) return g.loss;
  const double part = std::min(1.0, std::abs(speed) / g.knot_speed);
  const auto between = [part](double a, double b) { return a + part * (b - a); };
  return {between(g.loss.forward, g.far.forward), between(g.loss.backward, g.far.backward),
          between(g.loss.bearing_forward, g.far.bearing_forward),
          between(g.loss.bearing_backward, g.far.bearing_backward)};
}

/// Torque that a must put in for it to turn that way with this torque out and this shaft driving.
inline double asks(const TrainGear::Loss& loss, int turns, int drives, double out) {
  return drives == 0 ? (out + turns * loss.bearing_forward) / loss.forward
                     : loss.backward * (out + turns * loss.bearing_backward);
}

/// Rows of equations with their right side behind, made diagonal with pivots; false: they depend on each other.
inline bool eliminate(std::vector<std::vector<double>>& w) {
  const std::size_t m = w.size();
  for (std::size_t k = 0; k < m; ++k) {
    std::size_t best = k;
    for (std::size_t r = k; r < m; ++r)
      if (std::abs(w[r][k]) > std::abs(w[best][k])) best = r;
    if (std::abs(w[best][k]) < 1e-9) return false;
    std::swap(w[k], w[best]);
    for (std::size_t r = 0; r < m; ++r) {
      if (r == k) continue;
      const double factor = w[r][k] / w[k][k];
      for (std::size_t s = k; s <= m; ++s) w[r][s] -= factor * w[k][s];
    }
  }
  return true;
}

}  // namespace drev::test
