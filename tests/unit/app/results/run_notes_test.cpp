// Notes of a run: what they say of orders, beside what its run-up tracked.
// Covers app/results/run_text.hpp
#include "app/results/run_text.hpp"
#include "tests/catch.hpp"

using namespace drev;
using namespace drev::app;

TEST_CASE("The note of a train off its nominal speed says which turns the orders are of") {
  RunResult result;
  CHECK(notes_of(result).empty());
  result.speeds = {{.node = "a", .nominal = 125.0, .actual = 62.0}};
  const auto says = [&](const char* speed) {
    REQUIRE(notes_of(result).size() == 1);
    CHECK_THAT(notes_of(result).front(), Catch::Contains(speed));
  };
  says("per turn at the actual speed");
  result.run_up.emplace();  // over a stated run-up, of the nominal angle
  says("per turn at the nominal speed");
  result.run_up->orders.shaft = "a";  // of its actual angle
  says("per turn at the actual speed");
}
