// What wears out over long runs and large angles: the clock, and differences of angles that have grown.
#include <drev/core/assembler.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/periodic/spectrum.hpp>
#include <drev/solvers/run/evaluated_state.hpp>
#include <drev/solvers/run/observer.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <cmath>

#include "tests/catch.hpp"
#include "tests/problems/unit_oscillator.hpp"

using namespace drev;

TEST_CASE("Two million steps: the clock reads n h, the phase is the method's own") {
  // Adding h up would be off by 6e-10 s by then.
  class Clock final : public Observer {
   public:
    explicit Clock(double h) : h_(h) {}
    void start(const Assembler&, const EvaluatedState&) override {}
    void step(const Assembler&, const EvaluatedState&, const EvaluatedState& to) override {
      summed += h_;
      ++n;
      worst = std::max(worst, std::abs(to.state.t - static_cast<double>(n) * h_));
    }
    double summed = 0.0, worst = 0.0;
    long n = 0;

   private:
    double h_;
  };
  Model m = unit_oscillator();
  m.set_initial("m", 1.0, 0.0);
  const System system = m.build();
  const double h = 1e-3;
  State s = State::initial(system);
  Clock clock(h);
  const RunSummary run = simulate(system, {.step = h, .t_end = 2000.0}, s, {&clock});
  CHECK(run.ok());
  CHECK(clock.n == 2'000'000);
  CHECK(std::abs(clock.summed - 2000.0) > 1e-9);
  CHECK(clock.worst <= 2.3e-13);  // one unit in the last place
  // Average acceleration turns by 2 atan(w h/2) a step and keeps the amplitude.
  const double angle = 2e6 * 2.0 * std::atan(kPi * h);
  CHECK(s.z[0] == Approx(std::cos(angle)).margin(1e-8));
  CHECK(std::abs(run.energy.relative_error()) < 1e-9);
}

TEST_CASE("After an hour at 1500 rpm the shaft's torque is as clean as at the start") {
  // theta = 565487 rad, known to 1.2e-10 rad: as a difference of angles a shaft of 1e7 N m/rad would carry
  // noise of 1.2e-3 N m. Deviations carry none.
  Model m("an hour");
  for (const char* node : {"a", "b"}) {
    m.add_node(node);
    m.add<Inertia>(std::string("J_") + node, {node}, {.inertia = 0.5});
  }
  m.add<ShaftSpring>("shaft", {"a", "b"}, {.stiffness = 1e7, .damping = 100.0});
  m.set_reference("a", constant_speed(rpm(1500)));
  m.set_initial("a", 1e-9, 0.0);
  const System system = m.build();
  State early = State::initial(system), late = early;
  simulate(system, {.step = 1e-5, .t_end = 0.01}, early);
  simulate(system, {.step = 1e-5, .t_start = 3600.0, .t_end = 3600.01}, late);
  const double twist = 1e-9;
  // 3600.01 s is known to 2e-13 s, of a period of 1e-3 s.
  CHECK(std::abs((late.z - early.z)[0]) < 1e-8 * twist);
  CHECK(std::abs((late.z - early.z)[1]) < 1e-8 * twist);
  CHECK(early.z[0] != early.z[1]);
}

TEST_CASE("Sampling: tones above half the sampling rate fold, forces of contact fold as 1/N^2",
          "[spectrum]") {
  // 700 and 1300 Hz sampled at 1000 Hz both show as 300 Hz with their full amplitude.
  for (const double f : {700.0, 1300.0}) {
    std::vector<double> s;
    for (int j = 0; j < 1000; ++j) s.push_back(std::cos(kTwoPi * f * j * 1e-3));
    const Spectrum folded = spectrum(s, 1e-3, {.drop_end_point = false});
    CHECK(folded.amplitude[300] == Approx(1.0).epsilon(1e-9));
  }
  // Half-wave sine (one flank's force): mean 1/pi, first harmonic 1/2, second 2/(3 pi), from N samples.
  const double error[] = {8.5e-3, 5.1e-4, 3.2e-5};
  int i = 0;
  for (const int n : {16, 64, 256}) {
    std::vector<double> s;
    for (int j = 0; j < n; ++j) s.push_back(std::max(0.0, std::sin(kTwoPi * j / n)));
    const Spectrum sp = spectrum(s, 1.0 / n, {.drop_end_point = false});
    INFO("N = " << n);
    CHECK(sp.amplitude[1] == Approx(0.5).epsilon(1e-12));
    CHECK(std::abs(sp.amplitude[2] - 2.0 / (3.0 * kPi)) == Approx(error[i++]).epsilon(0.02));
  }
}
