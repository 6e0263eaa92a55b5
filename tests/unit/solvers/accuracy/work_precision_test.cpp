// Work and precision of methods on an oscillator whose error is known in closed form.
#include "solvers/accuracy/work_precision.hpp"

#include <drev/core/units.hpp>

#include <cmath>

#include "tests/catch.hpp"
#include "tests/problems/general_elements.hpp"
#include "tests/problems/unit_oscillator.hpp"

using namespace drev;

namespace {

System oscillator() {
  Model m = unit_oscillator();
  m.set_initial("m", 1.0, 0.0);
  return m.build();
}

}  // namespace

TEST_CASE("Work and precision: stopped at any moment, it says so and compares nothing") {
  const System smooth = oscillator();
  Model other = unit_oscillator();
  other.add<problems::Maxwell>("own", {"m"}, {});  // exact propagation refuses it
  other.set_initial("m", 1.0, 0.0);
  const System stepped = other.build();
  for (const System* system : {&smooth, &stepped}) {
    long calls = 0, all = 0;
    const auto stopped_after = [&](long last) {
      calls = 0;
      return work_precision(*system, {.sample_interval = 1.0 / 32.0,
                                      .samples = 64,
                                      .methods = {"average_acceleration", "sdirk4@tolerance"},
                                      .most_seconds = 1e-3,
                                      .progress = [&](double) { return ++calls < last; }});
    };
    REQUIRE_FALSE(stopped_after(1L << 60).interrupted);
    all = calls;
    for (long last = 1; last < all / 2; last += std::max(1L, last / 4)) {
      CAPTURE(last, all);
      const bool interrupted = stopped_after(last).interrupted;
      CHECK(interrupted == (calls >= last));  // a slow machine may be done in fewer calls
    }
  }
}

TEST_CASE(
    "Work and precision: the error of average acceleration on an oscillator is that of its "
    "period") {
  const System system = oscillator();
  // 2 s in samples of 1/32 s, period 1 s.
  const WorkPrecision wp = work_precision(system, {.channels = {"m.position_m"},
                                                   .sample_interval = 1.0 / 32.0,
                                                   .samples = 64,
                                                   .methods = {"exact", "average_acceleration"},
                                                   .most_seconds = 0.02});
  CHECK(wp.peak == Approx(1.0).epsilon(1e-12));
  CHECK(wp.unit == "m");
  CHECK(wp.agreement < 1e-6);
  REQUIRE(wp.curves.size() == 2);
  const WorkCurve& average = wp.curves[1];
  REQUIRE(average.points.size() > 4);
  for (const WorkPoint& p : average.points) {
    REQUIRE(p.ok);
    // cos(w' t) with tan(w' h / 2) = w h / 2; the samples themselves, in closed form.
    const double h = p.method.step, rate = 2.0 / h * std::atan(kPi * h);
    double error = 0.0;
    for (int i = 0; i <= 64; ++i)
      error = std::max(error, std::abs(std::cos(rate * i / 32.0) - std::cos(kTwoPi * i / 32.0)));
    CHECK(p.error == Approx(error).epsilon(1e-6).margin(1e-10));
    CHECK(p.work >= 2.0 / h);  // a solve a step, and one for the first acceleration
  }
  // Exact propagation keeps what it was asked for.
  for (const WorkPoint& p : wp.curves[0].points) CHECK(p.error <= 10.0 * p.method.tolerance);
}

TEST_CASE("Work and precision: the cheapest is the one that keeps the error from there on") {
  WorkPrecision wp;
  wp.agreement = 1e-5;
  const auto point = [](double error, double seconds, bool ok = true) {
    return WorkPoint{.ok = ok, .error = error, .seconds = seconds};
  };
  // By luck good at its coarsest, then bad, then good again.
  wp.curves.push_back({"lucky", {point(1e-3, 1.0), point(1e-1, 2.0), point(1e-3, 4.0), point(1e-6, 8.0)}});
  wp.curves.push_back({"steady", {point(1.0, 1.0, false), point(5e-3, 3.0), point(5e-5, 9.0)}});
  CHECK(wp.cheapest(1e-2)->curve->name == "steady");
  CHECK(wp.cheapest(1e-2)->point->seconds == 3.0);
  CHECK(wp.cheapest(2e-3)->curve->name == "lucky");
  CHECK(wp.cheapest(2e-3)->point->seconds == 4.0);
  CHECK(wp.cheapest(2e-5)->point->seconds == 8.0);
  CHECK_FALSE(wp.cheapest(5e-6));  // below the agreement
  CHECK_FALSE(wp.trusted(wp.curves[0].points[3]));
  CHECK_FALSE(wp.trusted(wp.curves[1].points[0]));
}

TEST_CASE("Work and precision: every fault of the options at once") {
  const System system = oscillator();
  try {
    work_precision(system, {.channels = {"n.position_m"},
                            .sample_interval = 0.0,
                            .samples = 1,
                            .methods = {"euler"},
                            .most_seconds = -1.0});
    FAIL("nothing was refused");
  } catch (const ModelError& error) {
    CHECK(error.findings().size() == 5);
  }
}
