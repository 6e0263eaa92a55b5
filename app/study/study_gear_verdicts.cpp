// What the gear drive's studies say.
#include <cmath>

#include "app/base/text_layout.hpp"
#include "app/study/study_gear_drive.hpp"
#include "models/camshaft/published.hpp"

namespace drev::app {

namespace {

std::string change(const Estimate& of, const Estimate& over) { return percent(of.value, over.value); }

/// Differs by more than a tenth.
bool far(const Estimate& of, const Estimate& over) { return std::abs(of.value / over.value - 1.0) > 0.1; }

}  // namespace

std::string with_error(const Estimate& k, const std::string& unit) {
  return estimate_text(k) + " +- " + short_digits(k.error, 2) + " " + unit;
}

std::vector<std::string> gear_verdicts(const GearStudy& s) {
  const auto &constant = published::kStiffness[0], &varying = published::kStiffness[1];
  const auto settled_of = [](const CamshaftCase& c) {
    return c.estimate(&CamshaftFigures::settled_deflection);
  };
  const auto torque_of = [](const CamshaftCase& c) { return c.estimate(&CamshaftFigures::settled_torque); };
  const CamshaftCase& widest = s.gaps.back();
  const auto rise = [](double wide, double narrow) { return wide / narrow - 1.0; };
  const double printed_rise =
                   rise(published::kBacklash.back().deflection, published::kBacklash.front().deflection),
               converged_rise = rise(widest.deflection().value, s.gaps[0].deflection().value);
  return {
      "**Is the gear drive needed for the deflection of the 9-cylinder shaft?** In case 1 the "
      "largest deflection is " +
          with_error(s.held.deflection(), "deg") + " with the gear held, " +
          with_error(s.tight.deflection(), "deg") + " with a drive without backlash (" +
          change(s.tight.deflection(), s.held.deflection()) + ") and " +
          with_error(s.gap().deflection(), "deg") + " with 0.15 mm (" +
          change(s.gap().deflection(), s.held.deflection()) + "); settled " +
          with_error(settled_of(s.held), "deg") + ", " + with_error(settled_of(s.tight), "deg") + " and " +
          with_error(settled_of(s.gap()), "deg") + std::string(". ") +
          (far(s.gap().deflection(), s.held.deflection())
               ? "**Yes**: a drive of finite stiffness changes it by far more than any error here."
               : "**No.**") +
          " With 8 cylinders it brings the first mode to " + digits(s.first_8, 4) +
          " Hz, nearer to the 16th order: 0.15 mm and case 1 make " +
          with_error(s.eight.deflection(), "deg") + " of " + with_error(s.held_8.deflection(), "deg") + ".",
      "**Is backlash?** From none to 0.15 mm the largest deflection changes by " +
          change(s.gap().deflection(), s.tight.deflection()) + ", the settled one by " +
          change(settled_of(s.gap()), settled_of(s.tight)) + "; to 0.5 mm by " +
          change(widest.deflection(), s.tight.deflection()) + " and " +
          change(settled_of(widest), settled_of(s.tight)) + ". Undamped, 0.15 mm changes the largest by " +
          change(s.undamped.deflection(), s.tight_undamped.deflection()) + ", the torque by " +
          change(s.undamped.torque(), s.tight_undamped.torque()) + ". The source's Table 5.13 grows by " +
          percent(published::kBacklash.back().deflection, published::kBacklash.front().deflection) +
          " from 0.05 to 0.5 mm, drev at 1 ms by " +
          percent(widest.at_step(&CamshaftFigures::deflection),
                  s.gaps[0].at_step(&CamshaftFigures::deflection)) +
          " and converged by " + change(widest.deflection(), s.gaps[0].deflection()) + ". " +
          (converged_rise < 0.25 * printed_rise
               ? "**That backlash increases the deflection significantly does not stand for a "
                 "damped shaft**: the rise is of the energy that average acceleration makes at "
                 "impacts, whose balance at 1 ms is off by " +
                     percent(1.0 + widest.source[0].summary.energy.relative_error(), 1.0) + " at 0.5 mm."
               : "**That it increases the deflection stands.**") +
          (far(s.undamped.torque(), s.tight_undamped.torque()) ? " For the undamped one it stands." : "") +
          " What the source printed is what its step gives: undamped with 0.15 mm " +
          printed(published::kGearDrive[0].deflection) + " deg, drev at 1 ms " +
          s.undamped.step_cell(&CamshaftFigures::deflection) + " deg, converged " +
          with_error(s.undamped.deflection(), "deg") + ".",
      "**Is varying stiffness?** Without backlash " +
          std::string(s.growth.value > 0.0
                          ? "the shaft is parametrically unstable at 750 rpm: free motion grows by exp(" +
                                digits(s.growth.value, 3) + " t), t in s, where the source saw " +
                                percent(varying.deflection, constant.deflection) +
                                " at a step that cannot see the meshes. **\"Insignificant\" does not "
                                "stand.**"
                          : "free motion decays by exp(" + digits(s.growth.value, 3) + " t), t in s.") +
          " With 0.15 mm the gaps bound it: the settled deflection is " +
          with_error(settled_of(s.varying), "deg") + " against " + with_error(settled_of(s.gap()), "deg") +
          " with constant stiffness (" + change(settled_of(s.varying), settled_of(s.gap())) +
          "), the settled torque " +
          change(s.varying.estimate(&CamshaftFigures::settled_torque),
                 s.gap().estimate(&CamshaftFigures::settled_torque)) +
          std::string(". ") +
          (far(settled_of(s.varying), settled_of(s.gap()))
               ? "**It is needed with gaps, too.**"
               : "**For the deflection it may be left out as long as the model has the gaps**; "
                 "without gaps it must not.") +
          " The inertias of crank gear and idler are typical values: the speeds of instability are "
          "those of this drive, not of the builder's.",
      "**Is it with the true curve?** By the gears' geometry (docs/gears.md, bores of 0.3 of the root "
      "circles) against "
      "its mean as a constant: without backlash free motion " +
          std::string(s.drawn_growth.value > 0.0 ? "grows by exp(" : "decays by exp(") +
          digits(s.drawn_growth.value, 3) + " t), the largest deflection changes by " +
          change(s.drawn.deflection(), s.drawn_mean.deflection()) + ", the largest torque by " +
          change(s.drawn.torque(), s.drawn_mean.torque()) + "; with 0.15 mm the settled ones by " +
          change(settled_of(s.drawn_gap), settled_of(s.drawn_mean_gap)) + " and " +
          change(torque_of(s.drawn_gap), torque_of(s.drawn_mean_gap)) + ". " +
          (s.drawn_growth.value > 0.0 || far(s.drawn.deflection(), s.drawn_mean.deflection()) ||
                   far(settled_of(s.drawn_gap), settled_of(s.drawn_mean_gap))
               ? "**\"Insignificant\" does not stand.**"
               : std::string("**For the deflection \"insignificant\" stands**") +
                     (far(torque_of(s.drawn_gap), torque_of(s.drawn_mean_gap))
                          ? ", for the torque it does not"
                          : "") +
                     "; the instability is the square wave's."),
      "**Does damping suppress the hammering?** Impacts on the front flank in 5 s: undamped " +
          estimate_text(s.undamped.estimate(&CamshaftFigures::front)) + ", case 1 " +
          estimate_text(s.gap().estimate(&CamshaftFigures::front)) + ", case 2 " +
          estimate_text(s.case_2.estimate(&CamshaftFigures::front)) + ", case 3 corrected " +
          estimate_text(s.corrected.estimate(&CamshaftFigures::front)) + "; settled torque " +
          cell(s.undamped.estimate(&CamshaftFigures::settled_torque).value) + ", " +
          cell(s.gap().estimate(&CamshaftFigures::settled_torque).value) + ", " +
          cell(s.case_2.estimate(&CamshaftFigures::settled_torque).value) + " and " +
          cell(s.corrected.estimate(&CamshaftFigures::settled_torque).value) + std::string(" N m. ") +
          (s.gap().estimate(&CamshaftFigures::front).value <
                   s.undamped.estimate(&CamshaftFigures::front).value
               ? "**It stands.**"
               : "**It does not stand.**") +
          " The published counts are off by " +
          percent(published::kGearDrive[0].front, s.undamped.estimate(&CamshaftFigures::front).value) +
          " undamped and " +
          percent(published::kGearDrive[1].front, s.gap().estimate(&CamshaftFigures::front).value) +
          " in case 1."};
}

}  // namespace drev::app
