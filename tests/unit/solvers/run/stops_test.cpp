// Where steps end: breakpoints, times of observers, the end; even steps between them.
#include "solvers/run/stops.hpp"

#include <drev/core/assembler.hpp>
#include <drev/elements/applied_torque.hpp>
#include <drev/solvers/run/evaluated_state.hpp>

#include <cmath>

#include "tests/catch.hpp"
#include "tests/problems/unit_oscillator.hpp"

using namespace drev;

namespace {

class Asks final : public Observer {
 public:
  explicit Asks(double t) : t_(t) {}
  void start(const Assembler&, const EvaluatedState&) override {}
  void step(const Assembler&, const EvaluatedState&, const EvaluatedState&) override {}
  double next_stop(double) const override { return t_; }

 private:
  double t_;
};

System with_breakpoints(std::vector<double> at) {
  Model m = unit_oscillator();
  m.add<AppliedTorque>("load", {"m"}, {.torque = [](double) { return 0.0; }, .breakpoints = std::move(at)});
  return m.build();
}

}  // namespace

TEST_CASE("Stops: breakpoints, observers and the end, in their order") {
  const System system = with_breakpoints({1.0, 2.0, 9.0});
  Asks asks(1.5);
  const Stops stops(system, 3.0, 1e-9, {&asks});
  CHECK(stops.after(0.0).t == 1.0);
  CHECK(stops.after(0.0).at_break);
  CHECK(stops.after(1.0).t == 1.5);
  CHECK_FALSE(stops.after(1.0).at_break);
  CHECK(stops.after(1.5).t == 2.0);  // what was asked for is passed
  CHECK(stops.after(2.0).t == 3.0);
  CHECK_FALSE(stops.after(2.0).at_break);
}

TEST_CASE("Stops: those that differ by rounding are one, at the breakpoint") {
  const System system = with_breakpoints({1.0, 3.0 + 1e-10});
  Asks asks(1.0 - 1e-10);
  const Stops stops(system, 3.0, 1e-9, {&asks});
  CHECK(stops.after(0.0).t == 1.0);
  CHECK(stops.after(0.0).at_break);
  CHECK(stops.after(1.0).t == 3.0 + 1e-10);
  CHECK(stops.after(1.0).at_break);
  // None differ where nothing is taken for rounding.
  const Stops exact(system, 3.0, 0.0, {&asks});
  CHECK(exact.after(0.0).t == 1.0 - 1e-10);
  CHECK_FALSE(exact.after(0.0).at_break);
  CHECK(exact.after(1.0).t == 3.0);
}

TEST_CASE("Stops: just before a breakpoint loads have their old values") {
  CHECK(Stop{1.0, true}.evaluation_time() == std::nextafter(1.0, 0.0));
  CHECK(Stop{1.0, false}.evaluation_time() == 1.0);
}

TEST_CASE("Even steps end at the end, and none is longer than asked for but by rounding") {
  const EvenSteps whole(0.1, 0.7, 0.2);  // 0.6 / 0.2 is above 3 by rounding
  CHECK(whole.count == 3.0);
  CHECK(whole.end_of(3.0) == 0.7);
  const EvenSteps cut(0.0, 1.0, 0.3);
  CHECK(cut.count == 4.0);
  CHECK(cut.h == 0.25);
  CHECK(cut.end_of(1.0) == 0.25);
  CHECK(EvenSteps(0.0, 1e-9, 1.0).count == 1.0);
}
