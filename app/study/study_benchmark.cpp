// Tables 4.3 to 4.5, figures 4.8 and 4.9: two masses with backlash.
#include <drev/solvers/modes/modes.hpp>
#include <drev/solvers/run/recorder.hpp>

#include <algorithm>
#include <cmath>

#include "app/base/text_layout.hpp"
#include "app/chart/svg_chart.hpp"
#include "app/study/study_runs.hpp"
#include "models/camshaft/published.hpp"

namespace drev::app {

namespace {

struct Case {
  const char* source;
  const char* name;
  ParameterValues parameters;
};
const Case kCases[] = {
    {"Figure 4.8", "no backlash", {{"k_2_N_per_m", "2000"}, {"half_gap_1_m", "0"}, {"half_gap_2_m", "0"}}},
    {"Table 4.3, Table 4.4",
     "half gaps 0.05 m",
     {{"k_2_N_per_m", "2000"}, {"half_gap_1_m", "0.05"}, {"half_gap_2_m", "0.05"}}},
    {"Table 4.5", "k 2000 and 1000, half gaps 0.05 and 0.03 m", {}}};
constexpr double kEvery = 0.02, kEnd = 5.0;  // s; the figures' range is not printed
constexpr double kAgree = 0.01;              // of the largest position
constexpr double kBenchmarkCoarse = 1e-12, kBenchmarkFine = 1e-15;

Recorder history(const System& system, const Method& method) {
  Recorder recorder(system, {"mass_1.position_m", "mass_2.position_m"}, kEvery);
  run_watched(system, method, kEnd, {&recorder});
  return recorder;
}

}  // namespace

StudyGroup study_benchmark() {
  StudyGroup group{.title = "Two masses with backlash"};
  group.how =
      "The source's benchmark against FEDEM; its figures are curves, and the size of the force is "
      "not printed (100 N "
      "here). Converged: exact propagation to 1e-15. Deviation: of 1 ms from it, the larger of "
      "both masses.";
  StudyTable table{"Positions"};
  std::vector<std::string> worst_texts, largest_texts;
  bool agree = true;
  for (const Case& c : kCases) {
    const System system = build_case("two_mass_backlash", c.parameters).model.build();
    const Recorder stepped = history(system, source_method()),
                   coarse = history(system, exact_method(kBenchmarkCoarse)),
                   fine = history(system, exact_method(kBenchmarkFine));
    for (std::size_t mass = 0; mass < 2; ++mass)
      table.rows.push_back({c.source, std::string(c.name) + ", mass " + std::to_string(mass + 1) + " at 5 s",
                            "m", "curve only", digits(stepped.samples(mass).back(), 6),
                            from_two(coarse.samples(mass).back(), fine.samples(mass).back(), kBenchmarkFine),
                            ""});
    double worst = 0.0, largest = 0.0;
    for (std::size_t mass = 0; mass < 2; ++mass)
      for (std::size_t i = 0; i < fine.times().size(); ++i) {
        worst = std::max(worst, std::abs(stepped.samples(mass)[i] - fine.samples(mass)[i]));
        largest = std::max(largest, std::abs(fine.samples(mass)[i]));
      }
    agree = agree && worst < kAgree * largest;
    largest_texts.push_back(digits(largest, 2));
    table.rows.push_back(
        {c.source, std::string(c.name) + ", deviation up to 5 s", "m", "-", short_digits(worst, 2), {}, ""});
    worst_texts.push_back(short_digits(1e3 * worst, 2) + " mm (" + c.name + ")");
    if (&c == &kCases[2])
      group.pictures.push_back(
          {"two_masses", "Two masses with backlash: positions at 1 ms and exact",
           svg_chart({.title = "Two masses with backlash", .x_label = "time [s]", .y_label = "position [m]"},
                     {{.name = "mass 1, exact", .x = fine.times(), .y = fine.samples(0)},
                      {.name = "mass 2, exact", .x = fine.times(), .y = fine.samples(1)},
                      {.name = "mass 1, 1 ms", .x = stepped.times(), .y = stepped.samples(0)},
                      {.name = "mass 2, 1 ms", .x = stepped.times(), .y = stepped.samples(1)}})});
  }
  group.tables.push_back(std::move(table));
  const auto fastest = [](const System& system) {
    return solve_modes(system, {.count = system.size()}).frequency_Hz.back();
  };
  const double here = fastest(build_case("two_mass_backlash", {}).model.build()),
               there = fastest(build_case("camshaft", {}).model.build());
  group.verdicts = {
      "\"The two solutions are generally in agreement\": **it " + stands(agree) +
      ".** Average acceleration at 1 ms stays within " + join(worst_texts, ", ") +
      " of the exact curves, whose largest positions are " + join(largest_texts, ", ") +
      " m. It says nothing of the gear drive: here the step is 1/" +
      digits(1.0 / (here * published::kStep), 2) + " of the fastest mode's period, there " +
      digits(there * published::kStep, 2) +
      " periods. Table 4.3 is FEDEM's entry of the dead band, whose stiffness rises over 0.1 mm; "
      "drev's springs "
      "have the kink itself."};
  return group;
}

}  // namespace drev::app
