#pragma once
/// The torque of a cylinder as openTorsion's example of a six-cylinder diesel takes it (examples/ICE_example.py, commit
/// 88ab789): 500 angles that hold both ends of the cycle of 720 degrees, so that its orders are 0.499, 0.998, ... in
/// place of 0.5, 1, ...; x'' by a series; 24 lines of the discrete Fourier transform. The reference shaft turns at
/// kSlower of the engine's speed here, so that these are its orders 0.5, 1, ... .
///
/// Data: models/six_cylinder (openTorsion, MIT licence). Peak pressures beyond the table's ends are those at the ends.
#include <drev/core/element.hpp>
#include <drev/core/law/harmonic_load.hpp>
#include <drev/core/law/speed_scaled_load.hpp>
#include <drev/core/units.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <vector>

#include "tests/published/six_cylinder_train.hpp"

namespace drev::test {

class SampledCylinder final : public Element, public Load, public SpeedScaledLoad {
 public:
  static constexpr int kAngles = 500, kLines = 24;
  static constexpr double kSlower = (kAngles - 1.0) / kAngles;
  static constexpr std::array<int, 6> kFiring{0, 4, 2, 5, 1, 3};  ///< lead of cylinders 1 to 6 [120 deg]
  struct Curves {
    std::vector<double> angle, pressure;  ///< rad, Pa over the peak
    std::vector<double> speed, peak;      ///< rad/s of the engine, Pa
  };

  /// cylinder: from 0. curves: outlive this.
  SampledCylinder(const Curves& curves, int cylinder)
      : curves_(curves), start_(-kFiring[static_cast<std::size_t>(cylinder)] * kTwoPi / 3.0 * kSlower) {
    constexpr double rod = 0.207, bore = 0.105, r = 0.5 * 0.137, mass = 2.521, l = r / rod;
    std::array<std::vector<double>, 2> samples;  // over the peak pressure; over the square of the speed
    for (int i = 0; i < kAngles; ++i) {
      const double a = 2.0 * kTwoPi * i / (kAngles - 1), b = std::asin(l * std::sin(a));
      const double arm = r * std::sin(a + b) / std::cos(b);
      const double series = std::cos(a) + l * std::cos(2 * a) - std::pow(l, 3) / 4 * std::cos(4 * a) +
                            9 * std::pow(l, 5) / 128 * std::cos(6 * a);
      samples[0].push_back(between(curves.angle, curves.pressure, a) * 0.25 * kPi * bore * bore * arm);
      samples[1].push_back(-mass * r * series * arm);
    }
    for (std::size_t k = 0; k < 2; ++k)
      for (int n = 1; n <= kLines; ++n) {
        std::complex<double> line = 0.0;
        for (int i = 0; i < kAngles; ++i)
          line +=
              samples[k][static_cast<std::size_t>(i)] * std::polar(2.0 / kAngles, -kTwoPi * n * i / kAngles);
        lines_[k].push_back({0.5 * n, line.real(), -line.imag()});
      }
  }

  std::string_view type() const override { return "sampled cylinder"; }
  int min_nodes() const override { return 1; }
  void check(ParameterCheck& /*check*/) const override {}
  void describe(int /*nodes*/, Terms& terms) const override { terms.loads.push_back({0, this}); }
  bool depends_on_motion() const override { return false; }
  LoadResponse evaluate(const LoadInput& in) const override {
    const std::vector<double> factors = speed_factors(in.nominal_speed);
    return {.torque = factors[0] * curve(0, in.nominal_angle) + factors[1] * curve(1, in.nominal_angle)};
  }
  std::vector<double> speed_factors(double speed) const override {
    const double w = std::abs(speed) / kSlower;
    return {between(curves_.speed, curves_.peak, w), w * w};
  }
  double curve(int k, double angle) const override {
    return LoadOrders{0.0, lines_[static_cast<std::size_t>(k)]}.at(angle - start_).torque;
  }
  Family family() const override { return {&curves_, start_}; }

 private:
  static double between(const std::vector<double>& x, const std::vector<double>& y, double at) {
    if (at <= x.front()) return y.front();
    if (at >= x.back()) return y.back();
    const auto i = static_cast<std::size_t>(std::upper_bound(x.begin(), x.end(), at) - x.begin());
    return y[i - 1] + (y[i] - y[i - 1]) * (at - x[i - 1]) / (x[i] - x[i - 1]);
  }
  const Curves& curves_;
  double start_;
  std::array<std::vector<LoadOrder>, 2> lines_;
};

/// Of the gas pressure as measured, 15.2 MPa at its peak.
inline SampledCylinder::Curves sampled_curves(const GasPressure::Params& gas) {
  SampledCylinder::Curves curves{gas.angle, gas.pressure, gas.peak_speed, gas.peak_pressure};
  for (double& p : curves.pressure) p /= gas.reference_pressure;
  return curves;
}

/// The example's train; loss factor of the shafts 0.035. Speeds of the engine are those of the reference shaft over
/// kSlower.
inline Model sampled_engine(const SampledCylinder::Curves& curves) {
  Model m = train(0.035, SampledCylinder::kSlower * rpm(2000.0), std::nullopt);
  for (int i = 0; i < 6; ++i)
    m.add("gas_" + std::to_string(i + 1), {"n" + std::to_string(i + 2)},
          std::make_shared<const SampledCylinder>(curves, i));
  return m;
}

}  // namespace drev::test
