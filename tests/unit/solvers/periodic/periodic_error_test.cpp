// The error that a periodic response states, against periodic orbits found by shooting with exact propagation.
#include <drev/core/state.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/periodic/periodic_response.hpp>
#include <drev/solvers/run/observer.hpp>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <optional>

#include "tests/catch.hpp"
#include "tests/problems/driven_gear.hpp"

using namespace drev;
using namespace drev::problems;

namespace {

const Method kReference{.name = "exact", .tolerance = 1e-11};

State after(const System& system, const State& start, double t) {
  State end = start;
  if (t > 0.0) run_method(system, kReference, {.t_end = t, .energy_tolerance = 1e9}, end);
  return end;
}

std::complex<double> at(const std::vector<std::complex<double>>& amplitudes, double part, double w) {
  double value = 0.0, rate = 0.0;
  for (std::size_t n = 0; n < amplitudes.size(); ++n) {
    const auto order = static_cast<double>(n);
    const std::complex<double> y = amplitudes[n] * std::exp(std::complex<double>(0.0, kTwoPi * order * part));
    value += y.real();
    rate -= order * w * y.imag();
  }
  return {value, rate};
}

/// The periodic orbit near the start; nothing where Newton's method does not close it.
std::optional<State> closed_orbit(const System& system, State start, double period) {
  for (int i = 0; i < 12; ++i) {
    const State end = after(system, start, period);
    const Eigen::Vector2d open(end.z[0] - start.z[0], end.v[0] - start.v[0]);
    const double size = std::abs(start.z[0]) + std::abs(start.v[0]);
    if (open.norm() <= 1e-11 * size) return start;
    Eigen::Matrix2d slope;
    const double d = 1e-6 * size;
    for (int k = 0; k < 2; ++k) {
      State other = start;
      (k == 0 ? other.z[0] : other.v[0]) += d;
      other = after(system, other, period);
      slope.col(k) << (other.z[0] - end.z[0]) / d, (other.v[0] - end.v[0]) / d;
    }
    const Eigen::Matrix2d equations = Eigen::Matrix2d::Identity() - slope;
    const Eigen::Vector2d step = equations.inverse() * open;
    start.z[0] += step[0];
    start.v[0] += step[1];
  }
  return std::nullopt;
}

}  // namespace

TEST_CASE("The error that a periodic response states holds, and says no more than it must",
          "[periodic][once]") {
  int settings = 0, within_100 = 0;
  for (const int kind : {0, 1, 2, 3})
    for (const double damping : {0.02, 0.3})
      for (const double half_gap : {0.3, 1.0})
        for (const double amplitude : {0.5, 2.0})
          for (const double speed : {0.37, 1.7})
            for (const int harmonics : {0, 64, 256}) {
              DrivenGear gear{.speed = speed,
                              .half_gap = half_gap,
                              .damping = damping,
                              .mean = 0.7,
                              .harmonics = {{1.0, amplitude, 0.2}}};
              if (kind == 1) gear.stiffness = MeshStiffness::step(0.8, 1.2, 1.5);
              if (kind == 2) gear.stiffness = MeshStiffness::fourier(1.0, {{1.0, 0.2, 0.0}});
              if (kind == 3) gear.harmonics.push_back({3.0, amplitude, 0.7});
              const System system = gear.build();
              const PeriodicResponse r =
                  solve_periodic(system, {.harmonics = harmonics, .channels = {"wheel.angle_rad"}});
              if (!r.found) continue;
              const std::vector<std::complex<double>>& a = r.amplitudes[0];
              State start = State::initial(system);
              const std::complex<double> first = at(a, 0.0, speed);
              start.z[0] = first.real();
              start.v[0] = first.imag();
              const std::optional<State> orbit = closed_orbit(system, start, r.period);
              if (!orbit) continue;
              double off = 0.0, largest = 0.0;
              for (int i = 0; i < 16; ++i) {
                const double part = i / 16.0 + 0.013, z = after(system, *orbit, part * r.period).z[0];
                off = std::max(off, std::abs(at(a, part, speed).real() - z));
                largest = std::max(largest, std::abs(z));
              }
              INFO("kind " << kind << ", damping " << damping << ", half gap " << half_gap << ", amplitude "
                           << amplitude << ", speed " << speed << ", harmonics " << r.harmonics);
              constexpr double kOfReference = 1e-10;
              CHECK(off <= (r.error + kOfReference) * largest);
              ++settings;
              within_100 += r.error * largest <= 100.0 * (off + kOfReference * largest);
            }
  CHECK(settings >= 100);
  CHECK(within_100 >= 0.9 * settings);
}
