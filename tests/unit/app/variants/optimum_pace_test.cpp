// The time left of a search for an optimum: right by its measured progress, or not stated.
#include "app/variants/optimum_pace.hpp"

#include "tests/catch.hpp"

using drev::app::OptimumPace;

namespace {

/// Time left [s] as app/base/progress.hpp says it; negative: not stated.
double left_after(OptimumPace& pace, std::uint64_t computed, double seconds) {
  const auto time =
      std::chrono::duration_cast<OptimumPace::Clock::duration>(std::chrono::duration<double>(seconds));
  const double part = pace.part_done(computed, OptimumPace::Clock::time_point{} + time);
  return part > 0.0 ? seconds * (1.0 - part) / part : -1.0;
}

}  // namespace

TEST_CASE("All combinations take the time of those there are, not of those that are allowed") {
  OptimumPace pace(0, 110, 2, {});
  CHECK(left_after(pace, 11, 24.0) == Approx(216.0));
}

TEST_CASE("Behind variants that are computed side by side the time of one by itself counts") {
  // 250 variants of 2 s by 4 threads: 125 s; then 750 of 2 s: 1500 s.
  OptimumPace pace(250, 1000, 4, {});
  CHECK(left_after(pace, 25, 12.5) == Approx(1625.0 - 12.5));
  CHECK(left_after(pace, 250, 125.0) == Approx(1500.0));
  CHECK(left_after(pace, 350, 325.0) == Approx(1300.0));
  // Those that follow take half the time.
  OptimumPace faster(250, 1000, 4, {});
  CHECK(left_after(faster, 250, 125.0) == Approx(1500.0));
  CHECK(left_after(faster, 350, 225.0) == Approx(650.0));
  CHECK(left_after(faster, 1000, 900.0) == Approx(0.0));
}

TEST_CASE("Nothing is said of the time left while variants are in lockstep, whose gain is not known") {
  OptimumPace pace(250, 1000, 0, {});
  CHECK(left_after(pace, 125, 10.0) < 0.0);
  CHECK(left_after(pace, 250, 20.0) < 0.0);
  CHECK(left_after(pace, 260, 40.0) == Approx(1480.0));
}
