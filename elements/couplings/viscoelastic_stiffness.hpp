#pragma once
/// ViscoelasticStiffness: a spring with a loss factor (hysteretic damping), rubber or the material of a shaft.
///
///   k*(f) = k(f) (1 + i eta(f))        torque amplitude = k* times twist amplitude, heat = w/2 Im(k*) |twist|^2
///
/// k, eta constant, or tables over the frequency, the mean torque |T_m| and the amplitude A of the twist, as data sheets
/// print them (linear between their points, constant outside). The first that is given, in that order, gives the values;
/// a further table scales them by its own values over those at its first point:
///
///   k = k_f(f) k_m(|T_m|)/k_m,1 k_A(A)/k_A,1,        eta alike
///
/// A = sqrt(sum |X_h|^2) over the orders h (for one order its amplitude): an equivalent linearisation, solved for at each
/// speed of a sweep; T_m is the mean torque at that speed. In time, with contacts followed and for modes both stand at
/// `at_mean_torque` and `at_amplitude`; modes of a sweep have the mean torque at each speed. Modes have k* at their own frequency
/// f = Im lambda/(2 pi), Im lambda > 0: J lambda^2 + k* = 0 of one inertia. Relative damping psi (loss a cycle over elastic energy) = 2 pi eta.
/// In linear sweeps and modes k* holds exactly at every order. In time and with contacts followed a chain of Maxwell branches stands for it,
///
///   G(s) = k_0 + sum_j k_j (c_j s + m_j s^2)/(k_j + c_j s + m_j s^2),     c_j = tau_j k_j,  m_j = c_j/(8 w_high)
///
/// fitted with k_j >= 0, k_0 >= Re k*(0)/10 to k* over lowest_frequency <= f <= highest_frequency (least squares of the relative
/// error at 80 frequencies, evenly on a log scale; tau_j even on a log scale between 1/(2 w_high) and 2/w_low).
/// fit_error() is the largest |G - k*|/|k*| there. No causal material has both k and eta constant: k then grows by
/// (2/pi) eta ln 10 = 1.47 eta a decade, so that for eta = 0.1 the error over a decade is 5 %. Keep the band
/// to what matters, about the resonance; fit_error is refused above `permitted_error`.
///
/// m_j makes a node of each branch's inner point that methods in time can step; it is part of the fit.
/// Below the band the chain's stiffness falls to its static one, k_0, which carries the mean torque in time. The fit chooses it, so
/// that it may be far below k: over an octave 0.86 k for eta = 0.1, 0.55 k for 0.3, 0.26 k for 0.5. Means of linear sweeps have
/// Re k*(0), the stated stiffness, under the load that is taken in time.
/// Source: H. Oberst's loss factor as in D. I. G. Jones, Handbook of Viscoelastic Vibration Damping, Wiley, 2001;
/// mini-oscillators: P. C. Hughes, D. J. McTavish, J. Vib. Acoust. 115 (1993) 103.
#include <drev/core/element_interface.hpp>
#include <drev/core/law/frequency_stiffness.hpp>
#include <drev/elements/not_given.hpp>

#include <Eigen/Core>
#include <complex>
#include <vector>

namespace drev {

class ViscoelasticStiffness final : public FrequencyStiffness {
 public:
  /// k [N m/rad], > 0, and eta [-], 0 to 2, at ascending values of something; empty: none.
  struct Table {
    std::vector<double> at = {}, stiffnesses = {}, loss_factors = {};
  };
  struct Params {
    double stiffness = kNotGiven;           ///< k [N m/rad], > 0; or the tables below
    double loss_factor = 0.0;               ///< eta [-], 0 to 2
    std::vector<double> frequencies = {};   ///< of the tables, ascending [Hz]
    std::vector<double> stiffnesses = {};   ///< k at these [N m/rad], > 0
    std::vector<double> loss_factors = {};  ///< eta at these [-], 0 to 2
    Table by_mean_torque = {};              ///< over |T_m| [N m], >= 0
    Table by_amplitude = {};                ///< over A [rad], >= 0
    double at_mean_torque = 0.0;            ///< |T_m| in time [N m], >= 0
    double at_amplitude = 0.0;              ///< A in time [rad], >= 0
    double lowest_frequency = kNotGiven;    ///< of the fit [Hz], > 0; needed where anything is lost
    double highest_frequency = kNotGiven;   ///< of the fit [Hz], > lowest_frequency
    int branches = 0;                       ///< of the chain, at most 12; 0: two a decade and one
    double permitted_error = 0.1;           ///< of the fit [-], > 0
  };
  struct Branch {
    double stiffness = 0.0, damping = 0.0, inertia = 0.0;  ///< k_j, c_j, m_j
  };

  ViscoelasticStiffness() = default;
  explicit ViscoelasticStiffness(Params params);

  const Params& params() const { return params_; }
  std::complex<double> at(double omega, const CarriedLoad& load) const;  ///< k* [N m/rad]; omega >= 0 [rad/s]
  /// The same under the load that is taken in time.
  std::complex<double> at(double omega) const { return at(omega, load_in_matrices()); }
  std::complex<double> chain(double omega) const;  ///< G(i omega)
  std::complex<double> beyond_matrices(double omega, const CarriedLoad& load) const override {
    return at(omega, load) - chain(omega);
  }
  std::optional<std::complex<double>> beyond_held(double omega, const CarriedLoad& load) const override {
    return at(omega, load) - held_stiffness_;
  }
  bool follows_frequency() const override { return params_.frequencies.size() > 1; }
  bool follows_mean_torque() const override { return params_.by_mean_torque.at.size() > 1; }
  CarriedLoad load_in_matrices() const override { return {params_.at_mean_torque, params_.at_amplitude}; }
  std::optional<BandFit> fit_in_matrices() const override {
    if (!loses()) return std::nullopt;
    return BandFit{fit_error_, params_.lowest_frequency, params_.highest_frequency};
  }
  std::vector<double> amplitudes() const override { return params_.by_amplitude.at; }
  double static_stiffness() const override { return static_stiffness_; }  ///< k_0 [N m/rad]
  double static_beyond_matrices() const override { return at(0.0).real() - static_stiffness_; }
  const std::vector<Branch>& branches() const { return branches_; }
  double fit_error() const { return fit_error_; }
  bool loses() const;  ///< whether a loss factor is > 0 or the stiffness follows the frequency
  void check(ParameterCheck& check) const;
  /// Adds the chain along b, whose branches' points are the local nodes from `first` on, and what the frequency domain
  /// adds. damping: viscous, beside it [N m s/rad].
  void describe(const Eigen::VectorXd& b, int first, double damping, Terms& terms) const;

 private:
  bool usable() const;
  void fit();

  Params params_;
  double static_stiffness_ = 0.0, fit_error_ = 0.0;
  double held_stiffness_ = 0.0;  // k_0 + sum k_j
  std::vector<Branch> branches_;
};

}  // namespace drev
