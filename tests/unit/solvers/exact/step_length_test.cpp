// How long steps are (solvers/exact/step_length.hpp).
#include "solvers/exact/step_length.hpp"

#include "tests/catch.hpp"

using namespace drev;

TEST_CASE(
    "Steps to a stop are alike to the last bit but for the last few, no longer than allowed, and the last "
    "one ends there") {
  StepLength step;
  const double end = 5.0, longest = 8.1e-5;
  step.start(StepLength::longest_angle(1e-6) / longest, end, 1e-6);
  double t = 0.0, first = 0.0;
  long count = 0, changes = 0;
  while (t < end) {
    const double h = step.next(t, end);
    if (h > longest * (1.0 + 1e-7)) FAIL("step " << count << " too long");
    if (count == 0) first = h;
    changes += h != first;
    if (t + h * (1.0 + 1e-6) < end) {
      t += h;
    } else {
      CHECK(h == end - t);  // exactly, or a sliver of a step would be left over
      t = end;
    }
    ++count;
  }
  CHECK(count >= 61729);  // ceil(5/8.1e-5)
  CHECK(count <= 61730);
  CHECK(changes < 5);  // the last few, for which the rounding of 61,729 times matters
  // A change of contact inside a step moves the times behind it.
  const double from = 1.0 + 0.3 * first, h = step.next(from, end);
  CHECK(h <= longest);
  CHECK(h == Approx(first).epsilon(1e-4));
  CHECK(step.next(from + h, end) == h);
  CHECK(step.next(4.99999, end) == end - 4.99999);
}

namespace {
// So many steps from here on are no longer than what passes bear; each is as long as it may be.
int steps_held_back(StepLength& step, double end) {
  for (int held = 0;; ++held) {
    const double h = step.next(0.0, end);
    if (h > step.longest_projected() || held == 5000) return held;
    step.attempted(h, h);
    step.count();
  }
}
}  // namespace

TEST_CASE("A longer step that is given up is tried again, the later the sooner it is given up again") {
  StepLength step;
  const double end = 1e6;
  step.start(2.0, end, 1e-6);
  CHECK(step.longest_projected() == 1.5);
  CHECK(step.longest() == 2.0);
  StepLength loose;
  loose.start(2.0, end, 1e-3);
  CHECK(loose.longest_projected() == 1.5);
  CHECK(loose.longest() == 2.5);
  loose.start(2.0, end, 1e-2);
  CHECK(loose.longest() == 2.75);
  CHECK(step.next(0.0, end) == Approx(2.0).epsilon(1e-5));
  CHECK(step.hold_back(1.4) == 1.4);  // not a longer one
  CHECK(step.next(0.0, end) > step.longest_projected());
  CHECK(step.hold_back(2.0) == step.longest_projected());
  CHECK(step.next(0.0, end) <= step.longest_projected());
  const int first = steps_held_back(step, end);
  CHECK(first >= 8);
  CHECK(first <= 10);
  step.hold_back(2.0);
  const int second = steps_held_back(step, end);
  CHECK(second >= 2 * 8);
  CHECK(second <= 2 * first);
  for (int i = 0; i < 20; ++i) {
    step.hold_back(2.0);
    CHECK(steps_held_back(step, end) <= 1026);
  }
  // Where enough of them went well, that is forgotten.
  for (int i = 0; i < 16; ++i) step.count();
  step.hold_back(2.0);
  CHECK(steps_held_back(step, end) == first);
}

TEST_CASE(
    "A step that was shortened grows threefold at a time, or as what is projected bears, terms that overflow "
    "leave a sixteenth") {
  StepLength step;
  step.start(1.0, 1e6, 1e-6);
  CHECK(step.attempted(4.0, 1.0) == 1.0);
  CHECK(step.attempted(0.5, 0.5) == 3.0);
  CHECK(step.attempted(1.5, 1.5, 1.2) == 1.5 * 1.2);
  CHECK(step.attempted(1.8, 1.8, 0.9) == 1.8 * 0.9);
  CHECK(step.attempted(3.375, 3.375) == 4.0);
  CHECK(step.attempted(4.0, 0.0) == 0.25);
  // Without a mode, or in a run shorter than its step, the run is one step.
  step.start(0.0, 7.0, 1e-6);
  CHECK(step.next(0.0, 7.0) == 7.0);
  CHECK(step.longest_projected() == 7.0);
  step.start(0.1, 7.0, 1e-6);
  CHECK(step.next(0.0, 7.0) == 7.0);
}
