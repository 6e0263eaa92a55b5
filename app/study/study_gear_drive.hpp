#pragma once
/// The cases of the gear drive's studies, computed once for their tables and their verdicts.
#include "app/study/study_runs.hpp"

namespace drev::app {

struct GearStudy {
  /// Without gaps: gear held and a drive without backlash, case 1 and undamped; 8 cylinders held, case 1.
  CamshaftCase held, held_undamped, tight, tight_undamped, held_8;
  /// With 0.15 mm: damping cases; case 1 with mesh stiffness that steps, and with 8 cylinders.
  CamshaftCase undamped, case_2, corrected, varying, eight;
  /// Mesh stiffness from the gears' geometry and its mean as a constant, case 1: without backlash, with 0.15 mm.
  CamshaftCase drawn, drawn_mean, drawn_gap, drawn_mean_gap;
  std::vector<CamshaftCase> gaps;   ///< case 1, each of published::kBacklash
  CamshaftFigures varying_at_step;  ///< no backlash, case 1, stepped stiffness, at the source's step
  Estimate growth;                  ///< of free motion in that case [1/s]
  Estimate drawn_growth;            ///< the same with the stiffness from geometry
  double first_8 = 0.0;             ///< Hz, first mode of 8 cylinders with the drive
  const CamshaftCase& gap() const { return gaps[1]; }  ///< 0.15 mm, case 1
};

std::vector<std::string> gear_verdicts(const GearStudy& study);

/// "1.2769 +- 2.3e-11 deg".
std::string with_error(const Estimate& known, const std::string& unit);

}  // namespace drev::app
