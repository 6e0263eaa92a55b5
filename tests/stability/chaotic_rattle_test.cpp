// Chaotic rattle, x'' + 0.1 x' + dz(x; 1) = 0.1 + 0.5 cos t: a deviation grows by 0.688 a period (Lyapunov
// exponent 0.10947), so that trajectories part after 40 periods at best. Statistics are comparable.
#include <drev/core/units.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/run/recorder.hpp>

#include <algorithm>
#include <cmath>

#include "tests/catch.hpp"
#include "tests/problems/driven_gear.hpp"

using namespace drev;
using namespace drev::problems;

namespace {

System rattle(double x = 0.0) {
  return DrivenGear{.half_gap = 1.0, .damping = 0.1, .mean = 0.1, .harmonics = {{1.0, 0.5, 0.0}}, .x = x}
      .build();
}

constexpr int kSamples = 50, kBatches = 20, kPeriods = 250;  // a period, of kPeriods each

struct Figure {
  double value, error;  // of the mean over batches
};
struct Statistics {
  Figure mean, deviation, in_gap, low, high;
};

/// Mean, standard deviation, fraction in the gap, 1 % and 99 % quantile over batches of the record.
Statistics statistics(const std::vector<double>& x, std::size_t first) {
  std::vector<std::vector<double>> per_batch(5);
  constexpr std::size_t length = kSamples * kPeriods;
  for (std::size_t b = 0; b < kBatches; ++b) {
    std::vector<double> s(x.begin() + static_cast<long>(first + b * length),
                          x.begin() + static_cast<long>(first + (b + 1) * length));
    double sum = 0.0, squares = 0.0, gap = 0.0;
    for (const double value : s) {
      sum += value;
      squares += value * value;
      gap += std::abs(value) < 1.0;
    }
    const double n = static_cast<double>(length);
    std::sort(s.begin(), s.end());
    per_batch[0].push_back(sum / n);
    per_batch[1].push_back(std::sqrt(squares / n - sum / n * sum / n));
    per_batch[2].push_back(gap / n);
    per_batch[3].push_back(s[length / 100]);
    per_batch[4].push_back(s[length - 1 - length / 100]);
  }
  const auto figure = [](const std::vector<double>& values) {
    double mean = 0.0, variance = 0.0;
    for (const double v : values) mean += v / kBatches;
    for (const double v : values) variance += (v - mean) * (v - mean) / (kBatches - 1);
    return Figure{mean, std::sqrt(variance / kBatches)};
  };
  return {figure(per_batch[0]), figure(per_batch[1]), figure(per_batch[2]), figure(per_batch[3]),
          figure(per_batch[4])};
}

/// Within three standard errors of 5000 periods by a separate program (exact pieces).
void check(const Statistics& s) {
  const auto compare = [](const char* what, Figure got, double value, double error) {
    INFO(what << ": " << got.value << " +- " << got.error << ", expected " << value << " +- " << error);
    CHECK(std::abs(got.value - value) < 3.0 * std::hypot(got.error, error));
    CHECK(got.error < 3.0 * error);
  };
  compare("mean", s.mean, .3926, .0039);
  compare("standard deviation", s.deviation, .9676, .0028);
  compare("fraction in the gap", s.in_gap, .5816, .0036);
  compare("1 % quantile", s.low, -1.849, .009);
  compare("99 % quantile", s.high, 1.996, .005);
}

}  // namespace

TEST_CASE("Chaotic rattle: statistics of 5000 periods by exact propagation") {
  const System system = rattle();
  Recorder r(system, {"wheel.angle_rad"}, kTwoPi / kSamples);
  const RunSummary run = propagate(
      system, {.tolerance = 1e-8, .t_end = (kBatches * kPeriods + 100.5) * kTwoPi, .energy_tolerance = 1e-4},
      {&r});
  INFO(run.brief_report());
  CHECK(run.ok());
  check(statistics(r.samples(0), 100 * kSamples));
}

TEST_CASE("Chaotic rattle: statistics by average acceleration with 50 steps a period") {
  const System system = rattle();
  Recorder r(system, {"wheel.angle_rad"}, kTwoPi / kSamples);
  const RunSummary run =
      run_method(system, {.step = kTwoPi / kSamples},
                 {.t_end = (kBatches * kPeriods + 100.5) * kTwoPi, .energy_tolerance = 1.0}, {&r});
  INFO(run.brief_report());
  check(statistics(r.samples(0), 100 * kSamples));
}

TEST_CASE("Chaotic rattle: a deviation of 1e-12 reaches 0.05 after some 35 periods") {
  // 31 to 41 periods were seen; ln(0.05/1e-12)/0.688 = 36. From 1e-6: 15.5, of which 21 were seen.
  for (const auto& [deviation, low, high] : {std::tuple{1e-12, 28.0, 44.0}, {1e-6, 10.0, 24.0}}) {
    const double t_end = 150 * kTwoPi, start = 100 * kTwoPi;
    const System system = rattle();
    Recorder a(system, {"wheel.angle_rad"}, kTwoPi / 8), b = a;
    State first = State::initial(system);
    propagate(system, {.tolerance = 1e-13, .t_end = start}, first);
    State second = first;
    second.z[0] += deviation;
    const ExactOptions options{.tolerance = 1e-14, .t_start = start, .t_end = t_end};
    propagate(system, options, first, {&a});
    propagate(system, options, second, {&b});
    double parted = 0.0;
    for (std::size_t i = 0; i < a.times().size() && parted == 0.0; ++i)
      if (std::abs(a.samples(0)[i] - b.samples(0)[i]) > 0.05) parted = (a.times()[i] - start) / kTwoPi;
    INFO("deviation " << deviation << " parted after " << parted);
    CHECK(parted > low);
    CHECK(parted < high);
  }
}
