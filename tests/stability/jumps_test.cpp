// Order of accuracy where forces jump: a load let go of, a stepped mesh stiffness. Jumps that the
// model states as breakpoints keep second order; those that steps pass over unseen make it first.
#include <drev/core/law_element.hpp>
#include <drev/core/units.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <algorithm>
#include <cmath>

#include "tests/catch.hpp"
#include "tests/problems/driven_gear.hpp"
#include "tests/problems/stepped_spring.hpp"
#include "tests/problems/twist_backlash.hpp"
#include "tests/problems/unit_oscillator.hpp"

using namespace drev;
using namespace drev::problems;

namespace {

/// A wall at x = 0 with k = 1e4 and a damper c = 20 that acts, and pulls, while x > 0.
struct SwitchedDamper {
  std::vector<LawPiece> pieces() const {
    return {{.bounds = {{0.0, -1.0, 0.0, 1}}},
            {.k = 1e4, .c = 20.0, .elastic_k = 1e4, .bounds = {{0.0, 1.0, 0.0, 0}}}};
  }
};

/// Thrown against it at 1 m/s from `start`.
template <class Law>
System thrown(const Law& law, double start) {
  Model m("thrown");
  m.add_node("m", NodeKind::translational);
  m.add<Inertia>("mass", {"m"}, {.inertia = 1.0});
  m.add<LawElement<Law>>("wall", {"m"}, law);
  m.set_initial("m", start, 1.0);
  return m.build();
}

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

TEST_CASE("A load let go of between two steps: first order unseen, second where the time is stated") {
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

TEST_CASE("Stepped mesh stiffness: second order with the jumps on steps that are told, first without") {
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
    const System system =
        DrivenGear{
            .speed = w, .stiffness = MeshStiffness::step(single, both, 1.6), .damping = 0.06, .mean = 1.0}
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

TEST_CASE("A damper that is switched on by contact: exact propagation to rounding") {
  // Thrown from x = -0.01. In contact e^(-10 s) sin(w s)/w, w^2 = 1e4 - 100, s = t - 0.01; out at
  // s = pi/w with -e^(-10 pi/w).
  const double w = std::sqrt(9900.0), exit = -.7292476142876709;
  CHECK(-std::exp(-10.0 * kPi / w) == Approx(exit).epsilon(1e-14));
  const System pulling = thrown(SwitchedDamper{}, -0.01);
  State s = State::initial(pulling);
  CHECK(propagate(pulling, {.tolerance = 1e-14, .t_end = 0.06}, s).ok());
  CHECK(s.v[0] == Approx(exit).epsilon(1e-12));
  CHECK(s.z[0] == Approx(-.01343697494286793).margin(1e-14));

  // The catalogue's law never pulls: out where k x + c x' = 0, at tan w t = -w/490, and no slower from there.
  const double gap = 0.1;
  const System clipped = thrown(TwistBacklash{BacklashLaw({.normal_backlash = 2 * gap,
                                                           .damping = 20.0,
                                                           .damping_law = MeshDamping::contact_only}),
                                              1e4},
                                0.0);
  const double out = (kPi - std::atan(w / 490.0)) / w, decay = std::exp(-10.0 * out);
  const double v_out = decay * (std::cos(w * out) - 10.0 / w * std::sin(w * out));
  const double x_out = decay * std::sin(w * out) / w;
  s = State::initial(clipped);
  CHECK(propagate(clipped, {.tolerance = 1e-14, .t_end = gap + 0.06}, s).ok());
  CHECK(s.v[0] == Approx(v_out).epsilon(1e-12));
  CHECK(s.z[0] == Approx(gap + x_out + v_out * (0.06 - out)).margin(1e-13));
}
