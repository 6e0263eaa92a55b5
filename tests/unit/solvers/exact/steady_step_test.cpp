// Lengths of steps to a stop (solvers/exact/steady_step.hpp).
#include "solvers/exact/steady_step.hpp"

#include "tests/catch.hpp"

using namespace drev;

TEST_CASE(
    "Steps to a stop are alike to the last bit but for the last few, no longer than allowed, and the last "
    "one ends there") {
  SteadyStep step;
  const double end = 5.0, longest = 8.1e-5;
  double t = 0.0, first = 0.0;
  long count = 0, changes = 0;
  while (t < end) {
    const double h = step.next(t, end, longest);
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
  const double from = 1.0 + 0.3 * first, h = step.next(from, end, longest);
  CHECK(h <= longest);
  CHECK(h == Approx(first).epsilon(1e-4));
  CHECK(step.next(from + h, end, longest) == h);
  CHECK(step.next(4.99999, end, longest) == end - 4.99999);
}
