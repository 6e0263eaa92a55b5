// Average acceleration beside the least that it can take: a loop written for this one model
// (peers/step_floor.cpp). The 9-cylinder camshaft over 5 s, held and with its gear drive. Processor time,
// medians of runs by turns; set-up included on both sides, nothing observed. That both are the same method
// is seen with the loads converged a hundred times closer: at the tolerance timed, what it leaves is more.
//   build/release/bin/bench_step
//   build/release/bin/bench_step "Step held*"      one drive
//   build/release/bin/bench_step "Whole process*"  the command `drev run` beside the same loop
#include <drev/solvers/stepping/transient.hpp>

#include <cstdlib>
#include <sys/resource.h>

#include "tests/benchmark/peer_harness.hpp"
#include "tests/benchmark/peers/step_floor.hpp"

using namespace drev;
using namespace drev::benchmark;
using peers::FloorRun;

namespace {

constexpr double kDuration = 5.0;  // s
constexpr double kTight = 1e-12;   // closer, and rounding of the angles keeps the loads from settling
constexpr double kSteps[] = {1e-3, 1e-4, 1e-5};

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }
int runs(double h) { return h > 5e-4 ? 101 : h > 5e-5 ? 21 : 7; }

State drev_run(const Problem& p, double h, double t_end, double load_tolerance = 0.0) {
  State state = State::initial(p.system, 0.0);
  TransientOptions options{.step = h, .t_end = t_end, .energy_tolerance = 1e9};
  if (load_tolerance > 0.0) options.newton.load_tolerance = load_tolerance;
  const RunSummary r = simulate(p.system, options, state);
  INFO(r.reason);
  REQUIRE(r.ok());
  return state;
}

/// Largest difference of the end states' angles and rates, each over its largest.
double off(const State& state, const FloorRun& floor) {
  const auto part = [](const Vector& own, const std::vector<double>& other) {
    return (own - Eigen::Map<const Vector>(other.data(), own.size())).lpNorm<Eigen::Infinity>() /
           own.lpNorm<Eigen::Infinity>();
  };
  return std::max(part(state.z, floor.z), part(state.v, floor.v));
}

void report_times(const std::string& problem, double own, double floor, int wanted) {
  char remark[80];
  std::snprintf(remark, sizeof remark, "%.2f times the loop (wanted: at most %d)", own / floor, wanted);
  report(problem, "hand-written loop", own, floor, remark);
}

void measure(const char* drive, double compared) {
  const Problem p = make_problem(drive, false);
  std::printf(
      "\n%s: %d unknowns, average acceleration over %.0f s\n"
      "| step [s] | drev [ns a step] | floor [ns a step] | ratio | load passes a step "
      "| difference after %g s |\n|---|---|---|---|---|---|\n",
      p.name.c_str(), p.system.size(), kDuration, compared);
  for (const double h : kSteps) {
    const double difference =
        off(drev_run(p, h, compared, kTight), run_step_floor(p.chain, h, compared, kTight));
    std::vector<double> own, floor;
    FloorRun last;
    for (int i = 0; i < runs(h); ++i) {
      const double start = processor_seconds();
      drev_run(p, h, kDuration);
      own.push_back(processor_seconds() - start);
      last = run_step_floor(p.chain, h, kDuration);
      floor.push_back(last.seconds);
    }
    const double count = static_cast<double>(last.steps);
    std::printf("| %.0e | %.0f | %.0f | %.2f | %.2f | %.1e |\n", h, 1e9 * median(own) / count,
                1e9 * median(floor) / count, median(own) / median(floor),
                static_cast<double>(last.load_passes) / count, difference);
    report_times(std::string("5 s, ") + drive + ", h = " + to_text(h) + " s", median(own), median(floor), 2);
    REQUIRE(difference < 1e-8);
  }
}

double seconds_of_children() {
  rusage used{};
  getrusage(RUSAGE_CHILDREN, &used);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

}  // namespace

TEST_CASE("Step held") { measure("held", kDuration); }
// The rattle amplifies rounding a decade in 59 ms: compared before that.
TEST_CASE("Step gears") { measure("gears", 0.05); }

TEST_CASE("Whole process held") {
  const Problem p = make_problem("held", false);
  for (const double h : kSteps) {
    const std::string command = std::string("\"") + DREV_EXECUTABLE +
                                "\" run camshaft --set drive=held --method average_acceleration --step " +
                                to_text(h) + " > /dev/null";
    std::vector<double> own, floor;
    for (int i = 0; i < 7; ++i) {
      const double start = seconds_of_children();
      REQUIRE(std::system(command.c_str()) == 0);
      own.push_back(seconds_of_children() - start);
      floor.push_back(run_step_floor(p.chain, h, kDuration).seconds);
    }
    report_times("5 s, held, whole process, h = " + to_text(h) + " s", median(own), median(floor), 3);
  }
}
