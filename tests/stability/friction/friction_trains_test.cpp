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

TEST_CASE("Random trains: a self-holding gear without bearing torques, whose two bounds share a line") {
  const drev::test::FrictionVerdict verdict = drev::test::judge(drev::test::random_friction_train(1070));
  INFO("difference " << verdict.difference << ' ' << verdict.failure);
  CHECK(verdict.agrees());
}

TEST_CASE("Random trains: a gear that carries nothing turns its drive among contacts that share a torque") {
  drev::test::FrictionTrain train = drev::test::random_friction_train(443);
  train.duration = 0.06;  // it does at 0.049 s
  const drev::test::FrictionVerdict verdict = drev::test::judge(train);
  INFO("difference " << verdict.difference << ' ' << verdict.failure);
  CHECK(verdict.agrees());
}

TEST_CASE("Random trains with break-away ratios in loops of contacts run, end and close their balance") {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    const drev::test::FrictionVerdict verdict =
        drev::test::judge_alone(drev::test::random_friction_train(seed, true));
    INFO("seed " << seed << ' ' << verdict.failure);
    CHECK(verdict.failure.empty());
    CHECK(verdict.changes < 1000);
  }
}
