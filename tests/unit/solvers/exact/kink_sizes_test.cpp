// KinkSizes beside its formulas, one kink after the other.
// Covers solvers/exact/kink_sizes.hpp and solvers/exact/lane_table.hpp.
#include "solvers/exact/kink_sizes.hpp"

#include <drev/elements/catalogue.hpp>

#include <cmath>

#include "tests/catch.hpp"

using namespace drev;

TEST_CASE("Sizes of kinks: what they set in, what comes back, and what they push at most") {
  constexpr int kDiscs = 11;
  Model m("discs");
  m.add_node("bed");
  m.constant_speed("bed", 20.0);
  for (int i = 0; i < kDiscs; ++i) {
    const std::string disc = "disc" + std::to_string(i), before = i ? "disc" + std::to_string(i - 1) : "bed";
    m.add_node(disc);
    m.add<Inertia>("J" + disc, {disc}, {.inertia = 0.1 + 0.02 * i});
    m.add<ShaftSpring>("k" + disc, {before, disc}, {.stiffness = 2e4});
    m.add<CamTorque>(
        "cam" + disc, {disc},
        {.angle_table = PeriodicTable({0.0, 1.0, 2.0}, {0.0, 3.0, -9.0}), .twist_feedback = i % 3 != 1});
  }
  const System system = m.build();
  const TaylorSeries series(system);
  std::vector<PlacedLoad> loads;
  for (const LoadTerm& term : system.loads()) {
    loads.emplace_back(system, term).find_reach(series);
    CHECK(loads.back().reach == Approx(1.0 / (0.1 + 0.02 * loads.back().row)).epsilon(1e-14));
  }
  const double h = 3e-4;
  KinkSizes sizes;
  for (const int count : {kDiscs, 3, 8, 0}) {  // a list after a longer one, too
    INFO(count << " kinks");
    sizes.clear();
    double most_pull = 0.0, most_gain = 0.0, push = 0.0, least_rate = std::numeric_limits<double>::infinity();
    std::vector<double> pull, gain;
    for (int i = 0; i < count; ++i) {
      const PlacedLoad& load = loads[static_cast<std::size_t>(i)];
      const double rate = i % 2 == 0 ? 1e-3 * (1 + i) : -2e-3 * (1 + i), chord = 5.0 + i,
                   slope = 6.0 + 2.0 * i;
      sizes.add(load, rate, chord, slope);
      const double inertia = 0.1 + 0.02 * i;
      pull.push_back(chord * std::abs(rate) / inertia);
      gain.push_back(load.feedback ? slope / inertia : 0.0);
      if (load.feedback) least_rate = std::min(least_rate, 0.75 * std::abs(rate));
      push += 1.25 * h * h * slope * std::abs(rate) / std::sqrt(inertia);
      most_pull = std::max(most_pull, pull.back());
      most_gain = std::max(most_gain, gain.back());
    }
    sizes.find(h);
    REQUIRE(sizes.count() == count);
    for (int i = 0; i < count; ++i) {
      CHECK(&sizes.load_of(i) == &loads[static_cast<std::size_t>(i)]);
      CHECK(sizes.pull()[i] == Approx(pull[static_cast<std::size_t>(i)]).epsilon(1e-14));
      CHECK(sizes.gain()[i] == Approx(gain[static_cast<std::size_t>(i)]).epsilon(1e-14));
    }
    for (int i = count; i < whole_lanes(count); ++i) {
      CHECK(sizes.pull()[i] == 0.0);
      CHECK(sizes.gain()[i] == 0.0);
    }
    CHECK(sizes.most_pull() == Approx(most_pull).epsilon(1e-14));
    CHECK(sizes.most_gain() == Approx(most_gain).epsilon(1e-14));
    CHECK(sizes.push() == Approx(push).epsilon(1e-14));
    if (std::isinf(least_rate))
      CHECK(std::isinf(sizes.least_rate()));
    else
      CHECK(sizes.least_rate() == Approx(least_rate).epsilon(1e-14));
  }
}
