// Figures 5.9 to 5.11, A.9 and A.10: frequencies of the camshaft with its gear held, from modes and from the
// spectrum of a decay as the source has them.
#include <drev/core/units.hpp>
#include <drev/solvers/modes/modes.hpp>
#include <drev/solvers/periodic/spectrum.hpp>
#include <drev/solvers/run/recorder.hpp>

#include <algorithm>
#include <cmath>

#include "app/base/text_layout.hpp"
#include "app/study/study_runs.hpp"
#include "models/camshaft/published.hpp"

namespace drev::app {

namespace {

constexpr int kHeldModes = 3;
constexpr double kStart = 1e-3;  // rad, of the free end

/// The inverse of shown_at_step().
double true_one(double shown_Hz, double h) { return to_hz(2.0 / h * std::tan(0.5 * hz(shown_Hz) * h)); }

/// The held camshaft without loads, let go with its free end turned.
System let_go(int cylinders) {
  const Model full =
      build_case("camshaft",
                 {{"cylinders", std::to_string(cylinders)}, {"drive", "held"}, {"damping", "undamped"}})
          .model;
  Model model("let_go");
  for (const std::string& node : full.node_names()) model.add_node(node);
  for (const ElementInstance& p : full.element_instances())
    if (!p.name.starts_with("cam_")) model.add(p.name, p.nodes, p.element);
  model.hold("gear");
  model.set_initial("end", kStart, 0.0);
  return model.build();
}

/// Frequencies of the free end's motion nearest to those expected.
std::vector<double> decay_frequencies(const System& system, const Method& method,
                                      const std::vector<double>& expected) {
  Recorder recorder(system, {"end.angle_rad"}, published::kStep);
  run_watched(system, method, published::kDuration, {&recorder});
  const auto peaks =
      spectrum_peaks(spectrum(recorder.samples(0), published::kStep, {.window = Window::hann}), 20, 5.0);
  std::vector<double> found;
  for (const double f : expected)
    found.push_back(std::min_element(peaks.begin(), peaks.end(), [&](const auto& a, const auto& b) {
                      return std::abs(a.frequency_Hz - f) < std::abs(b.frequency_Hz - f);
                    })->frequency_Hz);
  return found;
}

/// A frequency as it appears at the sampling rate 1/h.
double folded(double frequency_Hz, double h) {
  const double rate = 1.0 / h, f = std::fmod(frequency_Hz, rate);
  return std::min(f, rate - f);
}

}  // namespace

StudyGroup study_held_frequencies() {
  StudyGroup group{.title = "Frequencies of the held camshaft"};
  group.how =
      "At 1 ms: the source's way, the spectrum of a history (5 s, the free end let go, no load). "
      "Converged: the "
      "modes. The notes have what average acceleration must show of the mode, tan(w' h/2) = w h/2, "
      "and the "
      "spectrum of the exact motion sampled at 1 ms, where frequencies above 500 Hz fold back. "
      "Only the first "
      "frequency of 8 cylinders is printed as a number.";
  constexpr double h = published::kStep;
  StudyTable table{"First three modes"};
  double first_8 = 0.0, shown_8 = 0.0, second_off = 0.0, worst = 0.0;
  for (int cylinders = 6; cylinders <= 10; ++cylinders) {
    const System system = let_go(cylinders);
    const ModeSet modes = solve_modes(system, {.count = kHeldModes});
    std::vector<double> by_step, by_sampling;
    for (const double f : modes.frequency_Hz) {
      by_step.push_back(shown_at_step(f, h));
      by_sampling.push_back(folded(f, h));
    }
    const std::vector<double> stepped = decay_frequencies(system, source_method(), by_step);
    const std::vector<double> exact = decay_frequencies(system, exact_method(1e-10), by_sampling);
    for (int m = 0; m < (cylinders == 7 || cylinders == 10 ? 1 : kHeldModes); ++m) {
      const auto at = static_cast<std::size_t>(m);
      const double f = modes.frequency_Hz[at];
      const bool in_text = cylinders == 8 && m == 0;
      if (in_text) first_8 = f, shown_8 = stepped[at];
      if (cylinders == 8 && m == 1) second_off = stepped[at] / f;
      worst = std::max(worst, std::abs(stepped[at] - by_step[at]));
      table.rows.push_back({cylinders == 6   ? "Figure 5.9"
                            : cylinders == 7 ? "Figure A.9"
                            : cylinders == 8 ? "Figure 5.10"
                            : cylinders == 9 ? "Figure 5.11"
                                             : "Figure A.10",
                            std::to_string(cylinders) + " cylinders, mode " + std::to_string(m + 1), "Hz",
                            in_text ? printed(published::kHeldFirst8) : "-", digits(stepped[at], 5),
                            Estimate{f, kModeError * f, Estimate::Kind::measured},
                            "by the step's formula " + digits(by_step[at], 5) + ", exact motion's spectrum " +
                                digits(exact[at], 5) + (f > 0.5 / h ? " (folded)" : "")});
    }
  }
  group.tables.push_back(std::move(table));
  group.verdicts = {
      "The printed " + digits(published::kHeldFirst8, 5) +
          " Hz is no frequency of the shaft: it is what a step of 1 ms shows of " +
          digits(true_one(published::kHeldFirst8, h), 5) + " Hz. On the reconstruction a mode of " +
          digits(first_8, 5) + " Hz shows as " + digits(shown_8, 5) + " Hz. **The frequency " +
          stands(std::abs(published::kHeldFirst8 - first_8) <= std::abs(published::kHeldFirst8 - shown_8)) +
          "**; of the second mode of 8 cylinders 1 ms shows a frequency that is off by " +
          percent(second_off, 1.0) + ".",
      "The spectra at 1 ms agree with the step's formula to " + digits(worst, 2) + " Hz" +
          (worst < 0.01 * (first_8 - shown_8) ? ", so that the step alone makes the difference"
                                              : "; the rest is not the step's") +
          ". The source's remark that the step "
          "must be small for "
          "the higher frequencies names only the sampling (Nyquist at 500 Hz), not the method's "
          "own period error."};
  return group;
}

}  // namespace drev::app
