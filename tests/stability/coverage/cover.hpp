#pragma once
/// Each of these compares one kind of figure of one model with the reference and enters it in the table.
#include "tests/stability/coverage/coverage_table.hpp"
#include "tests/stability/coverage/reference_figures.hpp"

namespace coverage {

inline constexpr std::size_t kUnits = 6;
/// Angles, speeds, accelerations, mesh forces, mesh deflections, torques.
inline std::size_t unit(ChannelId::Kind kind) {
  using Kind = ChannelId::Kind;
  if (kind == Kind::angle || kind == Kind::twist || kind == Kind::polyline_deflection) return 0;
  if (kind == Kind::speed) return 1;
  if (kind == Kind::acceleration) return 2;
  if (kind == Kind::mesh_force) return 3;
  return kind == Kind::mesh_deflection ? 4 : 5;
}

/// What is known of a model before drev is asked.
struct Case {
  Spec spec;
  std::vector<double> times;  ///< of samples, ascending, inside the run
  ReferenceResult fine, check;
  double growth = 1.0;          ///< of a small difference of the state over the run
  std::vector<double> growths;  ///< of the same in each channel, at least that
  bool usable = false;          ///< both references ended
  std::string problem;
  double truth_error(std::size_t channel) const;  ///< of peaks
  static constexpr double kChaos = 1e6;
  bool chaotic() const { return growth > kChaos; }
};
Case make_case(const Spec& spec);

/// Values at random times and contact counts of exact propagation at tolerances 1e-8 and 1e-11, peaks beside them.
void cover_runs(const Case& c, Table& table);
/// What run_to_accuracy is asked for: `pairs` times two channels, each of another kind; `which` chooses them.
struct Asked {
  double accuracy = 1e-6;
  std::string method = "exact";
  std::size_t which = 0;
  int pairs = 2;
};
/// Peaks, contact changes, and whether "reached" is true.
void cover_accuracy(const Case& c, const Asked& asked, Table& table);
/// Impacts, times apart and largest forces of drev's contact table, from exact propagation at 1e-11.
void cover_contacts(const Case& c, Table& table);
/// Frequencies, and values lambda of the damped motion, contacts closed.
void cover_modes(const Spec& spec, Table& table);
/// Motion, peaks and order amplitudes of solve_periodic, against a reference run that has settled; order
/// amplitudes of run_to_accuracy. The spec has a period.
void cover_periodic(const Spec& spec, int harmonics, Table& table);
/// 95 % intervals of time averages of a chaotic model, `runs` times from other starts, against a longer run.
void cover_statistics(unsigned seed, int runs, Table& table);

}  // namespace coverage
