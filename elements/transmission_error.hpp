#pragma once
/// TransmissionError: the static (unloaded) error e of a gear pair along the line of action.
///
///   x = b^T q - e(s),   s = mesh phase in mesh periods, at the NOMINAL gear angle
///
/// e > 0 is missing material: the flanks in front meet later, by e. Its rate acts as well:
/// x_dot = b^T v - de/dt. Harmonics of the mesh phase, e = sum A_n cos(2 pi n s + phase_n), or a
/// table over one mesh period, linear between its points (its rate jumps at them).
#include <drev/elements/harmonic.hpp>
#include <drev/elements/periodic_table.hpp>

#include <variant>
#include <vector>

namespace drev {

class TransmissionError {
 public:
  TransmissionError() = default;  ///< none
  /// Whole orders per mesh period, amplitude [m], phase [rad].
  TransmissionError(std::vector<Harmonic> harmonics)  // NOLINT: implicit by intent
      : law_(std::move(harmonics)) {}
  /// Phases in [0, 1) ascending, errors [m].
  static TransmissionError table(std::vector<double> phases, std::vector<double> errors) {
    TransmissionError e;
    e.law_ = PeriodicTable(std::move(phases), std::move(errors), 1.0);
    return e;
  }

  /// e [m] and its slope against the phase [m per mesh period].
  CurvePoint at(double phase) const {
    if (const auto* table = std::get_if<PeriodicTable>(&law_)) return table->at(phase);
    const CurvePoint sum = sum_at(std::get<std::vector<Harmonic>>(law_), kTwoPi * phase);
    return {sum.value, kTwoPi * sum.slope};
  }
  /// The next phase beyond at which the slope jumps, upwards where direction > 0; none for harmonics.
  std::optional<double> next_knot(double phase, double direction) const {
    const auto* table = std::get_if<PeriodicTable>(&law_);
    return table ? table->next_knot(phase, direction) : std::nullopt;
  }
  bool varies() const {
    const auto* harmonics = std::get_if<std::vector<Harmonic>>(&law_);
    return harmonics == nullptr || !harmonics->empty();
  }
  void check(ParameterCheck& check, const std::string& parameter) const {
    if (const auto* table = std::get_if<PeriodicTable>(&law_))
      table->check(check, parameter, "mesh periods", "m");
    else
      check_harmonics(check, parameter, std::get<std::vector<Harmonic>>(law_), "m", true);
  }
  using Law = std::variant<std::vector<Harmonic>, PeriodicTable>;
  const Law& law() const { return law_; }

 private:
  Law law_;
};

}  // namespace drev
