// A slice of the friction trains; friction_suite is their long form.
#include "tests/catch.hpp"
#include "tests/stability/friction/friction_train.hpp"

TEST_CASE("Random trains that stick and slip move as an event-splitting integrator says") {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    drev::test::FrictionTrain train = drev::test::random_friction_train(seed);
    train.duration = 0.05;
    const drev::test::FrictionVerdict verdict = drev::test::judge(train);
    INFO("seed " << seed << ", difference " << verdict.difference << ' ' << verdict.failure);
    CHECK(verdict.agrees());
  }
}
