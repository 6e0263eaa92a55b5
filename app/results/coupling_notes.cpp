#include "app/results/coupling_notes.hpp"

#include <drev/core/law/frequency_stiffness.hpp>

#include <algorithm>
#include <cmath>

#include "app/base/text_layout.hpp"

namespace drev::app {

namespace {

constexpr int kCouplingDigits = 4;
constexpr double kSameMean = 1e-3;  // relative difference of mean torques that is not worth a word [-]

/// Sizes of the mean torques that a coupling carries in the motions and runs; empty: it is no section of the sweep.
std::vector<double> carried_means(const NonlinearSweep& sweep, const std::string& coupling) {
  std::vector<double> means;
  for (std::size_t c = 0; c < sweep.sections.size(); ++c) {
    if (sweep.sections[c].name != coupling + ".torque_Nm") continue;
    const auto note = [&](const Vector& mean) {
      const auto at = static_cast<Eigen::Index>(c);
      if (at < mean.size() && std::isfinite(mean[at])) means.push_back(std::abs(mean[at]));
    };
    for (const SweptBranch& branch : sweep.branches)
      for (const SweptMotion& motion : branch.motions) note(motion.mean);
    for (const SweptRun& run : sweep.runs) note(run.mean);
  }
  return means;
}

std::string mean_torque_text(double taken, const std::vector<double>& means) {
  const std::string text = short_digits(taken, kCouplingDigits) + " N m";
  if (means.empty()) return text;
  const auto [low, high] = std::minmax_element(means.begin(), means.end());
  if (std::max(*high - taken, taken - *low) <= kSameMean * std::max(*high, taken)) return text;
  const std::string least = short_digits(*low, kCouplingDigits), most = short_digits(*high, kCouplingDigits);
  return text + " (the motions carry " + (least == most ? most : least + " to " + most) + " N m)";
}

}  // namespace

std::vector<std::string> coupling_notes(const System& system, const NonlinearSweep& sweep) {
  std::vector<std::string> notes;
  for (const FrequencyTerm& term : system.frequency_terms()) {
    const FrequencyStiffness& spring = *term.stiffness;
    const std::string& name = system.element_instances()[idx(index(term.element))].name;
    const CarriedLoad load = spring.load_in_matrices();
    std::vector<std::string> taken;
    if (spring.follows_mean_torque())
      taken.push_back("the stiffness of its at_mean_torque, " +
                      mean_torque_text(load.mean_torque, carried_means(sweep, name)));
    if (spring.amplitudes().size() > 1)
      taken.push_back("the stiffness of its at_amplitude, " + short_digits(load.amplitude, kCouplingDigits) +
                      " rad");
    if (const auto fit = spring.fit_in_matrices())
      taken.push_back("the loss of its chain, off by up to " + short_digits(100.0 * fit->error, 2) +
                      " % from " + short_digits(fit->lowest, kCouplingDigits) + " to " +
                      short_digits(fit->highest, kCouplingDigits) + " Hz");
    if (taken.empty()) continue;
    notes.push_back(name + " has here, as in runs in time, " + join(taken, " and ") +
                    ". A linear sweep (--contact closed) has what its tables say at each speed and order.");
  }
  return notes;
}

}  // namespace drev::app
