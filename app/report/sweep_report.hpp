#pragma once
/// The report of a sweep: one page with amplitudes over speed, by order and in sum, orders at a speed, criticals
/// and the Campbell diagram.
#include <drev/solvers/strength/section_strength.hpp>

#include <string>
#include <vector>

#include "app/results/sweep_result.hpp"

namespace drev::app {

/// A limit that is drawn into the chart of a section.
struct DrawnLimit {
  int section = 0;
  std::string name;
  Vector values;  ///< over the speeds, in the section's unit; not finite where there is none
};

/// Torques that sections may carry, continuously and while a range is passed, over the speeds [rad/s]; of those among
/// the channels `sections` that have a limit.
std::vector<DrawnLimit> limits_of(const Strength& strength, const std::vector<std::string>& sections,
                                  const std::vector<double>& speeds);

/// A sweep of the same speeds and sections that is drawn beside the first: one cylinder misfiring.
struct SweepBeside {
  std::string name;
  const LinearSweep* sweep = nullptr;
};

/// The page's data, for report_page(..., ReportPage::sweep). title: "vibration by orders"; words: the command that
/// gives it again, without the model's parameters.
Json sweep_report_data(const SweepRequest& request, const LinearSweep& sweep, const std::string& title,
                       const std::string& words, const std::vector<DrawnLimit>& limits = {},
                       const std::vector<SweepBeside>& beside = {});

}  // namespace drev::app
