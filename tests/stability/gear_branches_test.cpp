// A gear pair with backlash under a harmonic load, x'' + 0.1 x' + dz(x) = 0.1 + 0.05 w^2 cos w t, half gap 1:
// two stable motions side by side between its jump frequencies 0.7080316187 and 0.8284639844. Expected:
// periodic solutions from closed-form pieces, confirmed by a Runge-Kutta method of 8th order to 6e-11.
#include <drev/core/units.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/run/peaks.hpp>
#include <drev/solvers/run/recorder.hpp>

#include <cmath>

#include "tests/catch.hpp"
#include "tests/problems/driven_gear.hpp"
#include "tests/problems/stepped_spring.hpp"

using namespace drev;
using namespace drev::problems;

namespace {

constexpr double kDamping = 0.1, kMean = 0.1, kAmplitude = 0.05;

System gear_at(double w) {
  return DrivenGear{.speed = w,
                    .half_gap = 1.0,
                    .damping = kDamping,
                    .mean = kMean,
                    .harmonics = {{1.0, kAmplitude * w * w, 0.0}}}
      .build();
}

/// Forced motion without loss of contact: 1 + kMean + r cos(w t - phase).
struct Linear {
  explicit Linear(double w) {
    const double real = 1.0 - w * w, imaginary = kDamping * w;
    amplitude = kAmplitude * w * w / std::hypot(real, imaginary);
    phase = std::atan2(imaginary, real);
    x = 1.0 + kMean + amplitude * std::cos(phase);
    v = amplitude * w * std::sin(phase);
  }
  double amplitude, phase, x, v;
};

/// `periods` periods from (x, v), and the largest and smallest deflection in the last one.
struct Orbit {
  double x, v, low, high;
};
Orbit run(double w, double x, double v, int periods) {
  const System system = gear_at(w);
  State state = State::initial(system);
  state.z[0] = x, state.v[0] = v;
  const double period = kTwoPi / w;
  if (periods > 1)
    REQUIRE(propagate(system, {.tolerance = 1e-11, .t_end = (periods - 1) * period}, state).ok());
  // Stops between, so that the peaks inside steps are exact to 1e-9.
  Recorder stops(system, {"wheel.angle_rad"}, period / 200);
  Peaks peaks({find_channel(system, "wheel.angle_rad")}, true);
  REQUIRE(propagate(system,
                    {.tolerance = 1e-13, .t_start = (periods - 1) * period, .t_end = periods * period}, state,
                    {&stops, &peaks})
              .ok());
  return {state.z[0], state.v[0], peaks.peaks()[0].min, peaks.peaks()[0].max};
}

}  // namespace

TEST_CASE("Gear with backlash: the upper branch's orbits close on themselves") {
  struct Row {
    double w, x, v, low, high;
  };
  for (const Row& row : {Row{.72, .88721799533, .20428573832, .6949972142, 1.3640231879},
                         {.75, .83384301254, .16407875180, .7163491204, 1.3530419874},
                         {.78, .82361102712, .13814349513, .7435481590, 1.3409323931},
                         {.80, .82523678827, .12460592546, .7615700518, 1.3330093091},
                         {.82, .83027291179, .11310294160, .7789160648, 1.3253336988},
                         {.85, .84127443450, .09870539956, .8032955385, 1.3143623041},
                         {1.0, .90596537477, .05577444413, .8952878757, 1.2692553680}}) {
    const Orbit once = run(row.w, row.x, row.v, 1), later = run(row.w, row.x, row.v, 200);
    INFO("w = " << row.w);
    CHECK(once.x == Approx(row.x).margin(1e-9));
    CHECK(once.v == Approx(row.v).margin(1e-9));
    CHECK(once.low == Approx(row.low).margin(2e-9));
    CHECK(once.high == Approx(row.high).margin(2e-9));
    // Stable: it stays there.
    CHECK(later.x == Approx(row.x).margin(1e-9));
    CHECK(later.v == Approx(row.v).margin(1e-9));
  }
}

TEST_CASE("Gear with backlash: the lower branch is the linear formula while contact holds") {
  struct Row {
    double w, low, high;
  };
  for (const Row& row : {Row{.72, 1.0467709691, 1.1532290309},
                         {.75, 1.0366385693, 1.1633614307},
                         {.78, 1.0238152624, 1.1761847376},
                         {.80, 1.0132278169, 1.1867721831},
                         {.82, 1.0004461323, 1.1995538677}}) {
    const Linear linear(row.w);
    CHECK(1.0 + kMean - linear.amplitude == Approx(row.low).margin(1e-9));
    const Orbit later = run(row.w, linear.x, linear.v, 100);
    INFO("w = " << row.w);
    CHECK(later.x == Approx(linear.x).margin(1e-9));
    CHECK(later.low == Approx(row.low).margin(2e-9));
    CHECK(later.high == Approx(row.high).margin(2e-9));
  }
}

TEST_CASE("Gear with backlash, swept up and down: it jumps between the printed speeds") {
  // Half the swing goes from .112 to .268 between .8280 and .8285, and down to .050 below .7080.
  double x = Linear(0.82).x, v = Linear(0.82).v;
  const auto half_swing = [&](double w, int periods) {
    const Orbit o = run(w, x, v, periods);
    x = o.x, v = o.v;
    return 0.5 * (o.high - o.low);
  };
  double last = 0.0;
  for (const double w : {0.82, 0.824, 0.826, 0.8275, 0.8280}) last = half_swing(w, 400);
  CHECK(last == Approx(0.112).margin(1e-3));
  CHECK(half_swing(0.8285, 2000) == Approx(0.268).margin(1e-3));
  for (const double w : {0.80, 0.76, 0.73, 0.715, 0.710, 0.7082}) last = half_swing(w, 400);
  CHECK(last > 0.3);
  CHECK(half_swing(0.7075, 2000) == Approx(0.050).margin(1e-3));
}

TEST_CASE("Gear with backlash and stepped stiffness: orbits of one and two mesh periods close") {
  // x'' + .06 x' + k(t) dz(x; 1) = 1, k mean 1, k_double/k_single = 1.5 for 0.6 of the period. At w = 1.7 a
  // motion of one period and one of two with loss of contact are both stable.
  struct Row {
    double w;
    int periods;
    double x, v, low, high;  // low: NaN where not printed
  };
  const double none = NAN;
  for (const Row& row : {Row{0.9, 1, 2.80553043034, 1.68253294017, -.1124111420, 3.6637464933},
                         {1.7, 1, 1.95886609019, .23399610848, none, 2.0980394053},
                         {1.7, 2, 3.28878884008, 1.68931395055, -.5124068351, 3.9675291418},
                         {2.0, 2, 2.96215722707, 1.15132539598, none, 3.3878499575}}) {
    const double period = kTwoPi / row.w;
    const System system = SteppedOscillator{.both = 1.5 / 1.3,
                                            .single = 1.0 / 1.3,
                                            .half_gap = 1.0,
                                            .duty = 0.6,
                                            .damping = 0.06,
                                            .load = 1.0,
                                            .period = period,
                                            .periods = row.periods}
                              .build();
    State s = State::initial(system);
    s.z[0] = row.x, s.v[0] = row.v;
    Peaks peaks({find_channel(system, "m.position_m")}, true);
    run_method(system, {.step = period / 8000}, {.t_end = row.periods * period, .energy_tolerance = 10.0}, s,
               {&peaks});
    INFO("w = " << row.w << ", " << row.periods << " periods");
    // Average acceleration at 8000 steps: (w h)^2/12 = 5e-8 of the phase.
    CHECK(s.z[0] == Approx(row.x).margin(3e-6));
    CHECK(s.v[0] == Approx(row.v).margin(3e-6));
    CHECK(peaks.peaks()[0].max == Approx(row.high).margin(3e-6));
    if (!std::isnan(row.low)) CHECK(peaks.peaks()[0].min == Approx(row.low).margin(3e-6));
  }
}
