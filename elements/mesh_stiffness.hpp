#pragma once
/// MeshStiffness: stiffness of a gear mesh along the line of action, over the mesh phase.
///
///   k(s),  s = mesh phase in mesh periods (one period a tooth), s = teeth theta/(2 pi) + offset
///
///   constant   k
///   step       k_double for 0 <= s < eps - 1, k_single for eps - 1 <= s < 1: two pairs of teeth
///              carry for the fraction eps - 1 of the period. It jumps: where the order of accuracy
///              matters, use the Fourier form.
///   fourier    mean + sum A_n cos(2 pi n s + phase_n)
///   table      linear between points over one period
///
/// The Fourier series of the step has A_n = 2 (k_double - k_single) sin(pi n (eps - 1))/(pi n) and
/// phase_n = -pi n (eps - 1): built from the contact ratio. (The source's series, S. L. Sunde,
/// NTNU, 2015, equation 4.15, gives no square wave of a stated contact ratio.) Truncated, it
/// overshoots the step by 9 %.
#include <drev/elements/harmonic.hpp>
#include <drev/elements/periodic_table.hpp>

#include <optional>
#include <variant>
#include <vector>

namespace drev {

class MeshStiffness {
 public:
  /// Constant k [N/m], > 0. Implicit, so that `.stiffness = 2e8` reads as it should.
  MeshStiffness(double stiffness) : law_(stiffness) {}  // NOLINT: implicit by intent
  /// k_single, k_double [N/m] > 0; contact ratio 1 < eps < 2.
  static MeshStiffness step(double single, double both, double contact_ratio);
  /// mean [N/m]; harmonics per mesh period: whole orders from 1 to kMostOrder, amplitude [N/m], phase [rad]. The
  /// sum must stay > 0.
  static MeshStiffness fourier(double mean, std::vector<Harmonic> harmonics);
  /// Fourier series of the step with the first `harmonics` orders.
  static MeshStiffness fourier_of_step(double single, double both, double contact_ratio, int harmonics);
  /// Phases in [0, 1) ascending, stiffnesses [N/m].
  static MeshStiffness table(std::vector<double> phases, std::vector<double> stiffnesses);

  /// k [N/m] and its slope against the phase [N/m per mesh period]; the step's slope is 0.
  CurvePoint at(double phase) const;
  double mean() const;  ///< over one mesh period [N/m]
  /// The next phase beyond at which k jumps or kinks, upwards where direction > 0; none for a smooth k.
  std::optional<double> next_knot(double phase, double direction) const;
  /// k about a phase as value and slope between knots, without the harmonics of a Fourier series; within rounding of a
  /// knot the stretch ahead of it: above it where direction > 0, else below.
  TableStretch stretch(double phase, double direction) const;
  bool varies() const { return !std::holds_alternative<double>(law_); }
  void check(ParameterCheck& check, const std::string& parameter) const;

  struct Step {
    double single, both, contact_ratio;
  };
  struct Fourier {
    double mean;
    std::vector<Harmonic> harmonics;
  };
  using Law = std::variant<double, Step, Fourier, PeriodicTable>;
  const Law& law() const { return law_; }
  static constexpr double kMostOrder = 10000.0;  ///< of a Fourier series, per mesh period

 private:
  static double low_value_of(const Fourier& series);
  explicit MeshStiffness(Law law) : law_(std::move(law)) {}

  Law law_;
};

}  // namespace drev
