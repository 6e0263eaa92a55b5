#pragma once
/// Steady state of the camshaft with its gear held and the source's loads, which follow the nominal angle: a
/// linear system under periodic loads, by superposition of cylinders, harmonics and modes.
///
///   x(t) = sum_k w_k(t - j_k T/N)      cylinder k of N fires in place j_k = 0 ... N - 1 of the order
///   w_k(t) = sum_n e^{i n Omega t} sum_m phi_m (phi_m' f_{k,n}) / d_{m,n}
///   d_{m,n} = w_m^2 - (n Omega)^2 + i n Omega (a + b w_m^2)
///
/// f_{k,n}: Fourier coefficients of the cylinder's three cam torques, exact for their straight stretches;
/// phi_m, w_m: undamped modes, which Rayleigh damping C = a M + b K leaves uncoupled. Harmonics n < 1440.
///
/// What follows for firing orders: all that an order changes is j_k. Shifting every j_k shifts time, so that
/// cylinder 1 may fire first: (N - 1)! orders are left. And the part of x that repeats N times a
/// revolution (n = 0, N, 2N, ...) is the same in all of them.
#include <Eigen/Core>
#include <utility>
#include <vector>

#include "models/camshaft/camshaft_data.hpp"

namespace drev {

class SteadyShaft {
 public:
  static constexpr int kSamples = 2880;  ///< a revolution; whole numbers of 6, 8 and 9 cylinders' share
  /// Row: sample of one revolution; column 0: twist from the first to the last cam [rad], then the torques of
  /// the sections [N m].
  using Waves = Eigen::MatrixXd;

  explicit SteadyShaft(int cylinders);

  /// Waves w_k of the cylinders, each firing in place 0. omega: speed of the camshaft [rad/s]. Undamped at a
  /// resonance they are not finite.
  std::vector<Waves> cylinder_waves(double omega, const RayleighCase& damping) const;
  /// Deflection of the whole shaft in the source's firing order [rad].
  Eigen::VectorXd deflection(double omega, const RayleighCase& damping) const;

  int cylinders() const { return cylinders_; }

 private:
  using Spectrum = Eigen::MatrixXcd;  // row: mode, column: harmonic
  /// The first `count` waves.
  Waves respond(const Spectrum& force, double omega, const RayleighCase& damping, Eigen::Index count) const;

  int cylinders_;
  Eigen::VectorXd lambda_;       // w_m^2
  Eigen::MatrixXd outputs_;      // row: wave, column: mode
  std::vector<Spectrum> force_;  // of each cylinder in place 0
  Spectrum all_;                 // of all in the source's order
};

/// The shaft's waves from the cylinders' in a firing order: x(t) above. Only columns [first, first + count).
SteadyShaft::Waves in_order(const std::vector<SteadyShaft::Waves>& cylinder_waves,
                            const std::vector<int>& order, Eigen::Index first, Eigen::Index count);

/// Amplitudes of the orders 1 to 200 of a revolution's samples, and the orders: the largest first.
std::vector<std::pair<double, int>> largest_orders(const Eigen::VectorXd& wave);

/// Largest |value| of a periodic wave, by a parabola through the largest sample and its neighbours.
double peak_of(const Eigen::Ref<const Eigen::VectorXd>& wave);

}  // namespace drev
