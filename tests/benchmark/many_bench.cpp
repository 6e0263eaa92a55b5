// Many variants of the camshaft with gear drive in lockstep, beside single runs of the same variants on one
// core, by turns: throughput in steps and variants a second. Processor time of all threads, and the wall's.
//   build/release/bin/bench_many
//   build/release/bin/bench_many "[thousand]"    a thousand variants of 5 s: some minutes of processor time
#include <drev/core/system.hpp>
#include <drev/models/ready_made.hpp>
#include <drev/solvers/batch/simulate_many.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <thread>

#include "tests/catch.hpp"

using namespace drev;

namespace {

constexpr std::size_t kSingle = 2;

/// part: 0 to 1 over the variants.
System variant(double part) {
  Parameters s("camshaft", camshaft_entry().parameters);
  s.set("engine_rpm", to_text(600.0 + 100.0 * part));
  s.set("backlash_mm", to_text(0.1 + 0.03 * part));
  return build_camshaft(s).model.build();
}

struct Clock {
  std::clock_t processor = std::clock();
  std::chrono::steady_clock::time_point wall = std::chrono::steady_clock::now();
  double processor_seconds() const { return static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC; }
  double wall_seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - wall).count();
  }
};

double median(std::vector<double> x) {
  std::sort(x.begin(), x.end());
  return x[x.size() / 2];
}

/// The channels whose peaks a table of `drev run --table` is made of.
std::vector<std::string> channels_of_table() {
  const ModelCase model_case = build_case("camshaft", {});
  std::vector<std::string> names{model_case.deflection, "mesh_1.force_N", "mesh_2.force_N"};
  names.insert(names.end(), model_case.torques.begin(), model_case.torques.end());
  return names;
}

void compare(std::size_t variants, double duration, double step, int turns,
             const std::vector<std::string>& channels = {"inlet_9-fuel_1.twist_rad"}) {
  const TransientOptions options{.step = step, .t_end = duration, .energy_tolerance = 1e3};
  const auto builder = [](std::size_t count) {
    return [count](std::size_t i) { return variant(static_cast<double>(i) / static_cast<double>(count)); };
  };
  const ManyOptions many{.channels = channels};
  ManyOptions one = many;
  one.threads = 1;
  one.lockstep = false;
  std::vector<double> single, lanes_processor, lanes_wall;
  double steps = 0.0;
  long alone = 0;
  const auto count_steps = [&](const ManyResult& result) {
    steps = 0.0, alone = 0;
    for (const VariantResult& v : result.variants) {
      CHECK(v.ok());
      steps += static_cast<double>(v.summary.steps);
      alone += v.steps_alone;
    }
  };
  for (int turn = 0; turn < turns; ++turn) {
    const Clock single_clock;
    count_steps(simulate_many(kSingle, builder(kSingle), options, one));
    single.push_back(single_clock.processor_seconds() / steps);
    const Clock clock;
    count_steps(simulate_many(variants, builder(variants), options, many));
    lanes_processor.push_back(clock.processor_seconds() / steps);
    lanes_wall.push_back(clock.wall_seconds() / steps);
  }
  const double s = median(single), p = median(lanes_processor), w = median(lanes_wall);
  std::printf(
      "h = %g s, %zu channels: %zu variants, %.0f steps in all, %ld of them alone; us a step and variant: "
      "single %.3f, lockstep %.4f of processor time, %.4f of the wall's on %u processors\n"
      "throughput over that of single runs on one core: %.1f a core, %.1f on all\n",
      step, channels.size(), variants, steps, alone, 1e6 * s, 1e6 * p, 1e6 * w,
      std::thread::hardware_concurrency(), s / p, s / w);
}

}  // namespace

TEST_CASE("Many variants in lockstep against single runs") {
  compare(32, 1.0, 1e-5, 5);
  compare(32, 1.0, 1e-5, 5, channels_of_table());
  compare(32, 20.0, 1e-3, 5);
}

TEST_CASE("A thousand variants in lockstep against single runs", "[.][thousand]") {
  compare(1000, 5.0, 1e-5, 1);
}
