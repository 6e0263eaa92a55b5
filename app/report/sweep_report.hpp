#pragma once
/// The report of a sweep: one page with amplitudes over speed, by order and in sum, orders at a speed,
/// critical speeds and the Campbell diagram.
#include <drev/solvers/strength/section_strength.hpp>

#include <string>
#include <vector>

#include "app/results/sweep_result.hpp"

namespace drev::app {

/// A limit that is drawn into the chart of a section.
struct DrawnLimit {
  int section = 0;
  std::string name;
  Vector values;  ///< limit at each speed, in the section's unit; not finite where there is none
};

/// Permissible torques of sections at the speeds [rad/s], in continuous running and while a speed range is
/// passed, for those among the channels `sections` that have a limit.
std::vector<DrawnLimit> limits_of(const Strength& strength, const std::vector<std::string>& sections,
                                  const std::vector<double>& speeds);

/// A sweep with the same speeds and sections that is drawn with the first one, for example with a misfiring
/// cylinder.
struct SweepBeside {
  std::string name;
  const LinearSweep* sweep = nullptr;
};

/// The page's data for report_page(..., ReportPage::sweep). title: for example "vibration by orders"; words:
/// the command that reproduces it, without the model's parameters.
Json sweep_report_data(const SweepRequest& request, const LinearSweep& sweep, const std::string& title,
                       const std::string& words, const std::vector<DrawnLimit>& limits = {},
                       const std::vector<SweepBeside>& beside = {});

}  // namespace drev::app
