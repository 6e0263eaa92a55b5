#pragma once
/// FrequencyStiffness: a complex stiffness that depends on the frequency, for methods in the frequency domain
/// (linear sweeps). A torque T exp(i omega t) on a deflection X exp(i omega t): T = k*(omega) X, Re k* >= 0 and
/// Im k* >= 0 for omega > 0 of the whole element. It may follow what the element carries, by equivalent linearisation:
/// the mean torque and the effective amplitude sqrt(sum |X_h|^2) over all orders h. Methods in time do not see it.
#include <complex>
#include <optional>
#include <vector>

namespace drev {

/// What an element carries at a speed.
struct CarriedLoad {
  double mean_torque = 0.0;  ///< N m, its size counts
  double amplitude = 0.0;    ///< sqrt(sum |X_h|^2) of the deflection over the orders [rad], >= 0
};

/// What an element's matrices have in place of k* over a band of frequencies.
struct BandFit {
  double error = 0.0;                  ///< largest, relative to k* [-]
  double lowest = 0.0, highest = 0.0;  ///< of the band [Hz]
};

class FrequencyStiffness {
 public:
  virtual ~FrequencyStiffness() = default;
  /// k* under that load less what the element's own matrices give at the circular frequency omega > 0 [rad/s]; N m/rad.
  virtual std::complex<double> beyond_matrices(double omega, const CarriedLoad& load) const = 0;
  /// k* less what they give while the element's internal nodes do not move: the frequency domain then needs no such
  /// nodes. nullopt: not known, or there are none.
  virtual std::optional<std::complex<double>> beyond_held(double /*omega*/,
                                                          const CarriedLoad& /*load*/) const {
    return std::nullopt;
  }
  /// Whether beyond_held() does, at the load it is asked for.
  virtual bool follows_frequency() const { return true; }
  virtual bool follows_mean_torque() const { return false; }
  /// The load under which the element's own matrices are.
  virtual CarriedLoad load_in_matrices() const { return {}; }
  /// How near its matrices are to k* under that load; nullopt: they are k*, or it is not known.
  virtual std::optional<BandFit> fit_in_matrices() const { return std::nullopt; }
  /// Amplitudes between which it follows them smoothly, ascending [rad]: it is constant outside. Empty: it does not follow any.
  virtual std::vector<double> amplitudes() const { return {}; }
  /// Of its own matrices: mean torque over mean deflection [N m/rad].
  virtual double static_stiffness() const { return 0.0; }
  /// The static stiffness that the element states less that of its matrices [N m/rad]; the frequency domain's means have it.
  virtual double static_beyond_matrices() const { return 0.0; }
};

}  // namespace drev
