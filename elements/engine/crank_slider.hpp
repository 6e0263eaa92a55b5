#pragma once
/// Kinematics of a crank and its piston.
///
///   x(a) = r cos a + sqrt(l^2 - r^2 sin^2 a)      from the crank's centre to the piston's pin; a = 0: top dead centre
///
/// with crank radius r = stroke/2 and connecting rod l > r [m]. The derivatives by the crank angle are exact.
#include <cmath>

namespace drev {

struct CrankSlider {
  double radius = 0.0, rod = 0.0;  ///< r, l [m]

  struct Derivatives {
    double first = 0.0, second = 0.0, third = 0.0;  ///< dx/da, d2x/da2, d3x/da3 [m]
  };
  Derivatives at(double angle) const {
    const double s = std::sin(angle), c = std::cos(angle), r_2 = radius * radius;
    const double w = std::sqrt(rod * rod - r_2 * s * s);  // height of the pin above the crank's pin
    const double w_1 = -r_2 * s * c / w;
    const double w_2 = -(r_2 * (c * c - s * s) + w_1 * w_1) / w;
    const double w_3 = (4.0 * r_2 * s * c - 3.0 * w_1 * w_2) / w;
    return {-radius * s + w_1, -radius * c + w_2, radius * s + w_3};
  }
  /// Bounds of the sizes of dx/da and d2x/da2 [m].
  Derivatives most() const {
    const double r_2 = radius * radius, w = std::sqrt(rod * rod - r_2), w_1 = 0.5 * r_2 / w;
    return {radius + w_1, radius + (r_2 + w_1 * w_1) / w, 0.0};
  }
  /// Mean of (dx/da)^2 over a turn [m^2]: mean inertia of a mass of 1 kg at the pin.
  double mean_square() const {
    constexpr int kPoints = 256;  // of a function as smooth as this: exact to rounding for l > 1.2 r
    double sum = 0.0;
    for (int i = 0; i < kPoints; ++i) {
      const double first = at(6.283185307179586477 * i / kPoints).first;
      sum += first * first / kPoints;
    }
    return sum;
  }
};

}  // namespace drev
