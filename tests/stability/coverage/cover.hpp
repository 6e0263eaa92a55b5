#pragma once
/// Each of these compares one kind of figure of one model with the reference and enters it in the table.
#include "tests/stability/coverage/coverage_table.hpp"
#include "tests/stability/coverage/reference_figures.hpp"

namespace coverage {

/// What is known of a model before drev is asked.
struct Case {
  Spec spec;
  std::vector<double> times;  ///< of samples, ascending, inside the run
  ReferenceResult fine, check;
  double growth = 1.0;  ///< of a small difference of the state over the run
  bool usable = false;  ///< both references ended
  std::string problem;
  double truth_error(std::size_t channel) const;  ///< of peaks
  static constexpr double kChaos = 1e6;
  bool chaotic() const { return growth > kChaos; }
};
Case make_case(const Spec& spec);

/// Values at random times and contact counts of exact propagation at tolerances 1e-8 and 1e-11, peaks beside them.
void cover_runs(const Case& c, Table& table);
/// Peaks of one channel of every kind, contact changes and order amplitudes from run_to_accuracy.
void cover_accuracy(const Case& c, double accuracy, Table& table);

}  // namespace coverage
