// Order of accuracy where forces jump: a load let go of, a stepped mesh stiffness. Jumps that the
// model states as breakpoints keep second order; those that steps pass over unseen make it first.
#include <algorithm>
#include <cmath>

#include "core/units.hpp"
#include "solvers/transient.hpp"
#include "tests/catch.hpp"
#include "tests/problems/driven_gear.hpp"
#include "tests/problems/stepped_spring.hpp"
#include "tests/problems/unit_oscillator.hpp"

using namespace drev;
using namespace drev::problems;

namespace {

/// Steady load k, let go of at `release`, from rest at 0: error of u(2.25), w = 2 pi.
double release_error(double release, double h, bool stated) {
  Model m = unit_oscillator();
  const double k = 4 * kPi * kPi;
  m.add<AppliedTorque>("load", {"m"},
                       {.torque = [=](double t) { return t < release ? k : 0.0; },
                        .breakpoints = stated ? std::vector{release} : std::vector<double>{}});
  const System system = m.build();
  State s = State::initial(system);
  simulate(system, {.step = h, .t_end = 2.25, .energy_tolerance = 10.0}, s);
  return s.z[0] - (std::cos(kTwoPi * (2.25 - release)) - std::cos(kTwoPi * 2.25));
}

double worst_release(double h, bool stated) {
  double worst = 0.0;
  for (int i = 0; i < 20; ++i) {
    const double release = 1 / std::sqrt(2.0) + 0.8 + (i / 20.0 - 1.0) * h;
    worst = std::max(worst, std::abs(release_error(release, h, stated)));
  }
  return worst;
}

}  // namespace

TEST_CASE(
    "A load let go of between two steps: first order unseen, second where the time is stated") {
  // Worst over where in the step it happens, by a separate program.
  CHECK(-std::cos(kTwoPi * 2.25) + std::cos(kTwoPi * (2.25 - 1 / std::sqrt(2.0) - 0.8)) ==
        Approx(-0.04463838552478572).margin(1e-14));
  const double unseen[] = {.282, .0443, .0103}, stated[] = {.153, 9.68e-3, 6.06e-4};
  int i = 0;
  for (const double h : {.05, .0125, .003125}) {
    INFO("h = " << h);
    CHECK(worst_release(h, false) == Approx(unseen[i]).epsilon(0.1));
    CHECK(worst_release(h, true) == Approx(stated[i]).epsilon(0.1));
    ++i;
  }
}

TEST_CASE(
    "Stepped mesh stiffness: second order with the jumps on steps that are told, first without") {
  // k_double/k_single = 1.5 for 0.6 of the period, mean 1, w = 1.3, zeta = .03, load 1, from rest:
  // exact after ten periods from the closed forms of the pieces.
  const double x = 1.133776757881699, v = .3420058131547483, w = 1.3, period = kTwoPi / w;
  const double single = 1.0 / 1.3, both = 1.5 * single;
  const auto error = [&](const State& s) { return std::hypot(s.z[0] - x, s.v[0] - v); };
  const auto told = [&](int steps) {
    const System system = SteppedOscillator{.both = both,
                                            .single = single,
                                            .duty = 0.6,
                                            .damping = 0.06,
                                            .load = 1.0,
                                            .period = period,
                                            .periods = 10}
                              .build();
    State s = State::initial(system);
    simulate(system, {.step = period / steps, .t_end = 10 * period, .energy_tolerance = 10.0}, s);
    return error(s);
  };
  CHECK(told(240) == Approx(3.28e-4).epsilon(0.01));
  CHECK(told(480) == Approx(8.20e-5).epsilon(0.01));

  const auto gear = [&](int steps) {
    const System system = DrivenGear{.speed = w,
                                     .stiffness = MeshStiffness::step(single, both, 1.6),
                                     .damping = 0.06,
                                     .mean = 1.0}
                              .build();
    State s = State::initial(system);
    simulate(system, {.step = period / steps, .t_end = 10 * period, .energy_tolerance = 10.0}, s);
    return error(s);
  };
  // The mesh's jumps lie off the steps: 16 times as many would make a 256th of the error.
  const double coarse = gear(277), fine = gear(277 * 16);
  INFO("off the steps: " << coarse << ", " << fine);
  CHECK(coarse < 0.02);
  CHECK(fine < 0.1 * coarse);
  CHECK(fine > coarse / 64);
}

TEST_CASE("Average acceleration moves the primary tongue's upper end by -1.575/N^2") {
  // N steps a mesh period that end on the jumps. Exact 2.12527221; N = 20: 2.12133464 by a separate program.
  const auto trace = [&](double w, int steps) {
    const double period = kTwoPi / w;
    const System system = SteppedOscillator{.period = period}.build();
    double sum = 0.0;
    for (const bool speed : {false, true}) {
      State s = State::initial(system);
      (speed ? s.v[0] : s.z[0]) = 1.0;
      simulate(system, {.step = period / steps, .t_end = period, .energy_tolerance = 1e9}, s);
      sum += speed ? s.v[0] : s.z[0];
    }
    return sum;
  };
  for (const int steps : {20, 40, 80}) {
    double inside = 2.0, outside = 2.3;
    while (outside - inside > 1e-9) {
      const double w = 0.5 * (inside + outside);
      (std::abs(trace(w, steps)) > 2.0 ? inside : outside) = w;
    }
    if (steps == 20) CHECK(inside == Approx(2.12133464).margin(1e-8));
    CHECK((inside - 2.1252722147406) * steps * steps == Approx(-1.575).margin(0.005));
  }
}
