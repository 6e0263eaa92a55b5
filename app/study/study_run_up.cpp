// Figures 5.16 to 5.18 and A.11 to A.13: run-up from 20 to 800 rpm.
#include <drev/core/units.hpp>
#include <drev/models/ready_made.hpp>

#include <algorithm>
#include <cmath>

#include "app/base/text_layout.hpp"
#include "app/chart/svg_chart.hpp"
#include "app/study/study_runs.hpp"
#include "models/camshaft/published.hpp"
#include "models/camshaft/steady_shaft.hpp"

namespace drev::app {

namespace {

constexpr double kSlow = 20.0, kFast = 800.0;  // rpm of the engine
// The source's program raises the speed in every tenth step by 780 rpm h: 78 rpm/s.
constexpr double kTime = 10.0;  // s
constexpr int kWindows = 78;    // of 10 rpm
constexpr int kShafts[] = {6, 8, 9};
constexpr const char* kRunUpDampings[] = {"undamped", "case_1", "case_2", "case_3"};
constexpr const char* kNames[] = {"undamped", "case 1", "case 2", "case 3"};
constexpr double kNeeded = 1.2;  // times case 1's peak
constexpr double kRunUpCoarse = 1e-6, kRunUpFine = 1e-10;
constexpr std::size_t kKinds = 3;  // of run: at 1 ms, exact to both tolerances

double speed_of(std::size_t window) {
  return kSlow + (kFast - kSlow) * (static_cast<double>(window) + 0.5) / kWindows;
}

struct RunUp {
  std::vector<double> deflection, torque;  // deg, N m: peak of each window
};

RunUp run_one(int cylinders, const char* damping, const Method& method) {
  const RayleighCase rayleigh = rayleigh_case(damping, cylinders);
  const ModelCase held =
      build_case("camshaft", {{"cylinders", std::to_string(cylinders)}, {"drive", "held"}});
  Model model("run_up");
  add_camshaft(
      model,
      {.cylinders = cylinders, .twist_feedback = false, .rayleigh_a = rayleigh.a, .rayleigh_b = rayleigh.b});
  model.hold("gear");
  model.set_reference("gear", run_up(rpm(0.5 * kSlow), rpm(0.5 * kFast), 0.0, kTime));
  const System system = model.build();
  WindowPeaks deflection(find_channels(system, {held.deflection}), method.exact(), 0.0, kTime / kWindows);
  WindowPeaks torque(find_channels(system, held.torques), method.exact(), 0.0, kTime / kWindows);
  run_watched(system, method, kTime, {&deflection, &torque});
  RunUp result{deflection.amplitudes(), torque.amplitudes()};
  for (double& value : result.deflection) value = to_deg(value);
  return result;
}

/// "79 to 94", of values times a factor.
std::string range(const std::vector<double>& values, double factor) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return digits(factor * *low, 2) + " to " + digits(factor * *high, 2);
}

std::size_t top(const std::vector<double>& peaks) {
  return static_cast<std::size_t>(std::max_element(peaks.begin(), peaks.end()) - peaks.begin());
}

StudyRow row_of(const std::string& source, const std::string& name, const std::string& unit,
                const std::vector<double>& step, const std::vector<double>& coarse,
                const std::vector<double>& fine) {
  const std::size_t at = top(fine), at_step = top(step);
  return {source,
          name,
          unit,
          "curve only",
          cell(step[at_step]),
          from_two(coarse[top(coarse)], fine[at], kRunUpFine),
          "at " + digits(speed_of(at), 3) + " rpm; at 1 ms at " + digits(speed_of(at_step), 3) + " rpm"};
}

/// Case 1 in the steady state at each window's speed: deflection [deg].
std::vector<double> steady(int cylinders) {
  const SteadyShaft shaft(cylinders);
  std::vector<double> peaks(kWindows);
  for_all(kWindows, [&](std::size_t w) {
    peaks[w] = to_deg(peak_of(shaft.deflection(rpm(0.5 * speed_of(w)), rayleigh_case("case_1", cylinders))));
  });
  return peaks;
}

}  // namespace

StudyGroup study_run_up() {
  StudyGroup group{.title = "Run-up from 20 to 800 rpm"};
  group.how =
      "The source prints curves only, of a speed \"slowly increased\". Its program makes 78 rpm/s "
      "of it (a tenth of the rate it "
      "asks for), and so do these runs: 10 s, gear held to the ramp, loads at the nominal angle, "
      "peaks in "
      "windows of 10 rpm. Converged: exact propagation of the same ramp. Beside it the steady "
      "state at each speed, "
      "by superposition of modes and harmonics, which no ramp reaches at a resonance; below some "
      "200 rpm a window is a part of a revolution, and the ramp's peaks are lower for that.";
  std::vector<RunUp> runs(std::size(kShafts) * std::size(kRunUpDampings) * kKinds);
  for_all(runs.size(), [&](std::size_t i) {
    const Method methods[kKinds] = {source_method(), exact_method(kRunUpCoarse), exact_method(kRunUpFine)};
    runs[i] = run_one(kShafts[i / kKinds / std::size(kRunUpDampings)],
                      kRunUpDampings[i / kKinds % std::size(kRunUpDampings)], methods[i % kKinds]);
  });
  std::vector<double> speeds;
  for (std::size_t w = 0; w < kWindows; ++w) speeds.push_back(speed_of(w));

  std::vector<std::string> undamped_tops, ramp_and_steady;
  std::vector<double> undamped_over_case_1, ramp_over_steady;
  bool same_speeds = true;
  for (std::size_t s = 0; s < std::size(kShafts); ++s) {
    const std::string n = std::to_string(kShafts[s]);
    StudyTable table{n + " cylinders: largest over the run-up"};
    std::vector<ChartSeries> deflections, torques;
    for (std::size_t d = 0; d < std::size(kRunUpDampings); ++d) {
      const RunUp* of = &runs[(s * std::size(kRunUpDampings) + d) * kKinds];
      const std::string figure = "Figure 5." + std::to_string(16 + s),
                        other = "Figure A." + std::to_string(11 + s);
      table.rows.push_back(row_of(figure, std::string(kNames[d]) + ", deflection", "deg", of[0].deflection,
                                  of[1].deflection, of[2].deflection));
      table.rows.push_back(row_of(other, std::string(kNames[d]) + ", torque", "N m", of[0].torque,
                                  of[1].torque, of[2].torque));
      deflections.push_back({.name = kNames[d], .x = speeds, .y = of[2].deflection});
      torques.push_back({.name = kNames[d], .x = speeds, .y = of[2].torque});
      if (d == 0) {
        same_speeds = same_speeds && top(of[0].deflection) == top(of[2].deflection);
        undamped_tops.push_back(n + " cylinders " + digits(of[2].deflection[top(of[2].deflection)], 3) +
                                " deg at " + digits(speed_of(top(of[2].deflection)), 3) + " rpm (at 1 ms " +
                                digits(of[0].deflection[top(of[0].deflection)], 3) + " deg at " +
                                digits(speed_of(top(of[0].deflection)), 3) + " rpm)");
      }
      if (d == 1) {
        deflections.push_back({.name = "case 1 at 1 ms", .x = speeds, .y = of[0].deflection});
        const std::vector<double> still = steady(kShafts[s]);
        deflections.push_back({.name = "case 1, steady", .x = speeds, .y = still});
        const double ramped = of[2].deflection[top(of[2].deflection)];
        undamped_over_case_1.push_back(
            runs[s * std::size(kRunUpDampings) * kKinds + 2]
                .deflection[top(runs[s * std::size(kRunUpDampings) * kKinds + 2].deflection)] /
            ramped);
        ramp_over_steady.push_back(ramped / still[top(still)]);
        ramp_and_steady.push_back(n + " cylinders " + digits(still[top(still)], 3) + " deg at " +
                                  digits(speed_of(top(still)), 3) + " rpm steady, " +
                                  digits(of[2].deflection[top(of[2].deflection)], 3) + " deg at " +
                                  digits(speed_of(top(of[2].deflection)), 3) + " rpm in the ramp");
      }
    }
    group.tables.push_back(std::move(table));
    const auto picture = [&](const std::string& name, const std::string& what, const std::string& unit,
                             const std::vector<ChartSeries>& series) {
      group.pictures.push_back({"run_up_" + name + "_" + n, "Run-up of " + n + " cylinders: " + what,
                                svg_chart({.title = "Run-up, " + n + " cylinders",
                                           .x_label = "engine speed [rpm]",
                                           .y_label = what + " [" + unit + "]"},
                                          series)});
    };
    picture("deflection", "largest deflection", "deg", deflections);
    picture("torque", "largest torque", "N m", torques);
  }
  group.verdicts = {
      "\"Without damping these peaks are large\", as at 600 rpm with 9 cylinders: undamped, the "
      "largest are " +
          join(undamped_tops, "; ") + ", " + range(undamped_over_case_1, 1.0) +
          " times those of case 1. **That damping is needed where the shaft passes critical speeds " +
          stands(*std::min_element(undamped_over_case_1.begin(), undamped_over_case_1.end()) > kNeeded) +
          "**; where those speeds lie " + stands(same_speeds) +
          (same_speeds ? "." : ", since 1 ms puts every frequency too low."),
      "In case 1 the largest of all speeds is " + join(ramp_and_steady, "; ") + ": the ramp reaches " +
          range(ramp_over_steady, 100.0) + " % of the steady state's peaks."};
  return group;
}

}  // namespace drev::app
