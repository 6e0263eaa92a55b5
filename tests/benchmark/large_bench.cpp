// Chains, branched trains and looped gear trains of 1e2 to 1e6 unknowns: processor time to build, factor,
// solve, make a step of average acceleration, and find the ten lowest modes; memory of the whole process
// an unknown; exponents in n, fitted over all sizes (modes: from 2e4). Other programs' modes: bench_modes.
//   build/release/bin/bench_large            "[peaks]" for memory alone, "[modes]" for modes alone
#include <drev/core/assembler.hpp>
#include <drev/core/units.hpp>
#include <drev/solvers/modes/modes.hpp>
#include <drev/solvers/run/evaluated_state.hpp>
#include <drev/solvers/run/observer.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <algorithm>
#include <ctime>
#include <memory>
#include <vector>

#include "solvers/linear/sparse_cholesky.hpp"
#include "tests/benchmark/large_models.hpp"
#include "tests/catch.hpp"

using namespace drev;
using namespace drev::benchmark;

namespace {

constexpr const char* kShapes[] = {"chain", "branched", "looped"};

double now() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double median(std::vector<double> x) {
  std::sort(x.begin(), x.end());
  return x[x.size() / 2];
}

/// Median time of one call, of 5 rounds of at least 10 ms.
template <class F>
double seconds(F&& call) {
  std::vector<double> rounds;
  for (int calls = 1; rounds.size() < 5;) {
    const double start = now();
    for (int i = 0; i < calls; ++i) call();
    const double spent = now() - start;
    if (spent < 0.01)
      calls *= 2;
    else
      rounds.push_back(spent / calls);
  }
  return median(rounds);
}

/// Processor time of the steps alone: from the end of the first one (which factors) to the last.
class StepClock final : public Observer {
 public:
  void start(const Assembler&, const EvaluatedState&) override {}
  void step(const Assembler&, const EvaluatedState&, const EvaluatedState&) override {
    ++steps_;
    if (steps_ == 1) first_ = now();
    last_ = now();
  }
  double seconds() const { return (last_ - first_) / static_cast<double>(steps_ - 1); }

 private:
  long steps_ = 0;
  double first_ = 0.0, last_ = 0.0;
};

double step_seconds(const System& system, int steps) {
  StepClock clock;
  constexpr double h = 1e-4;
  const RunSummary run = simulate(system, {.step = h, .t_end = h * steps}, {&clock});
  INFO(run.reason);
  CHECK(run.ok());
  return clock.seconds();
}

void print(const char* what, const std::string& shape, int n, double value, const char* unit) {
  std::printf("%s %s %d %.4g %s\n", what, shape.c_str(), n, value, unit);
  std::fflush(stdout);
}

/// Slope of log(time) over log(n), by least squares.
class Exponents {
 public:
  void add(const std::string& what, int n, double value) {
    auto found = std::find_if(rows_.begin(), rows_.end(), [&](const Row& r) { return r.what == what; });
    if (found == rows_.end()) found = rows_.insert(rows_.end(), Row{what, {}});
    found->points.push_back({std::log(n), std::log(value)});
  }
  ~Exponents() {
    for (const Row& row : rows_) {
      double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
      const auto count = static_cast<double>(row.points.size());
      for (const auto& [a, b] : row.points) x += a, y += b, xx += a * a, xy += a * b;
      std::printf("exponent %s %.3f\n", row.what.c_str(), (count * xy - x * y) / (count * xx - x * x));
    }
  }

 private:
  struct Row {
    std::string what;
    std::vector<std::pair<double, double>> points;
  };
  std::vector<Row> rows_;
};

}  // namespace

TEST_CASE("Large models: build, factor, solve, step", "[steps]") {
  Exponents exponents;
  for (const std::string shape : kShapes)
    for (const int n : {100, 1000, 10000, 100000, 1000000}) {
      const auto note = [&](const char* what, double value) {
        print(what, shape, n, value, "s");
        exponents.add(std::string(what) + " " + shape, n, value);
      };
      const LargeModel model(shape, n);
      std::unique_ptr<System> system;
      const double start = now();
      int builds = 0;
      do {
        system = std::make_unique<System>(model.build());
        ++builds;
      } while (now() - start < 0.05);
      note("build", (now() - start) / builds);
      Vector values;
      const Assembler assembler(*system);
      assembler.contact_values({1.0, 0.0, 1e-8}, Contact::closed, values);
      note("analyse", seconds([&] { SparseCholesky fresh(system->pattern()); }));
      SparseCholesky cholesky;
      note("factor",
           seconds([&] { REQUIRE(cholesky.factorize(system->pattern(), values) == FactorStatus::success); }));
      const Vector b = Vector::Ones(system->size());
      Vector x;
      note("solve", seconds([&] { cholesky.solve(b, x); }));
      std::vector<double> rounds;
      for (int i = 0; i < 3; ++i) rounds.push_back(step_seconds(*system, std::clamp(3000000 / n, 20, 10000)));
      note("step", median(rounds));
    }
}

TEST_CASE("Large models: memory of model, system, factor and run", "[peaks]") {
  for (const std::string shape : kShapes)  // brings the program itself into memory
    step_seconds(LargeModel(shape, 100).build(), 20);
  for (const std::string shape : kShapes)
    for (const int n : {1000, 10000, 100000, 1000000}) {
      forget_memory_peak();
      const double before = process_memory("VmRSS:");
      {
        const LargeModel model(shape, n);
        const System system = model.build();
        const double built = process_memory("VmHWM:");
        step_seconds(system, 20);
        print("memory_built", shape, n, (built - before) / n, "B");
        print("memory_now", shape, n, (process_memory("VmRSS:") - before) / n, "B");
        print("memory_peak", shape, n, (process_memory("VmHWM:") - before) / n, "B");
      }
    }
}

TEST_CASE("Large models: the ten lowest modes", "[modes]") {
  Exponents exponents;
  for (const std::string shape : kShapes)
    for (const int n : {38, 200, 2000, 20000, 200000, 1000000}) {
      const System system = LargeModel(shape, n).build();
      forget_memory_peak();
      const double before = process_memory("VmRSS:");
      std::vector<double> rounds;
      double worst = 0.0;
      const int repeats = n <= 200 ? 1001 : n <= 20000 ? 11 : n <= 200000 ? 5 : 3;
      for (int i = 0; i < repeats; ++i) {
        const double start = now();
        const ModeSet modes = solve_modes(system, {.count = 10});
        rounds.push_back(now() - start);
        for (int j = 0; shape == "chain" && j < 10; ++j)
          worst = std::max(worst, std::abs(modes.frequency_Hz[idx(j)] / chain_frequency(n, j + 1) - 1.0));
      }
      print("modes", shape, n, median(rounds), "s");
      if (n >= 20000) {
        exponents.add("modes " + shape, n, median(rounds));
        print("modes_memory", shape, n, (process_memory("VmHWM:") - before) / n, "B");
      }
      if (shape == "chain") print("modes_error", shape, n, worst, "");
    }
}
