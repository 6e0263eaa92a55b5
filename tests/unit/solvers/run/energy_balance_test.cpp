// What one run and eight in lanes share: balance (energy_balance.hpp), extremes (peak.hpp) and contact
// totals (contact_record.hpp) are the same numbers for a double as in each lane.
#include <drev/core/law_element.hpp>
#include <drev/core/model.hpp>
#include <drev/elements/inertia.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/run/contact_statistics.hpp>
#include <drev/solvers/run/energy_balance.hpp>
#include <drev/solvers/run/peaks.hpp>

#include <cmath>

#include "tests/catch.hpp"
#include "tests/unit/not_finite.hpp"

using namespace drev;

namespace {

constexpr int kSteps = 200;

/// Numbers that differ from lane to lane and step to step.
double some(int lane, int step, double phase) {
  return std::sin(0.37 * step + 0.9 * lane + phase) * (1.0 + 0.1 * lane);
}
LaneRow row(int step, double phase) {
  LaneRow all;
  for (int lane = 0; lane < kLanes; ++lane) all.v[lane] = some(lane, step, phase);
  return all;
}
const LaneMask kAll = ~LaneMask{};

}  // namespace

TEST_CASE("Energy balance: the same for one run and in lanes, a step that is not finite is not entered") {
  constexpr int kBad = 5;  // lane, in step 100
  Balance<LaneRow> lanes;
  Balance<double> one[kLanes];
  for (int step = 1; step <= kSteps; ++step) {
    LaneRow kinetic = row(step, 0.1);
    if (step == 100) kinetic.v[kBad] = kNan;
    LaneMask good = kAll;
    enter_step(lanes, kinetic.v, row(step, 0.2).v, row(step, 0.3).v, row(step, 0.4).v, 0.1 * step, good);
    for (int lane = 0; lane < kLanes; ++lane) {
      bool entered = true;
      enter_step(one[lane], kinetic.v[lane], some(lane, step, 0.2), some(lane, step, 0.3),
                 some(lane, step, 0.4), 0.1 * step, entered);
      CHECK(entered == (step != 100 || lane != kBad));
      CHECK(entered == (good[lane] != 0));
      CHECK(one[lane].kinetic == lanes.kinetic.v[lane]);
      CHECK(one[lane].imbalance == lanes.imbalance.v[lane]);
    }
  }
  for (int lane = 0; lane < kLanes; ++lane) {
    CHECK(one[lane].worst_imbalance == lanes.worst_imbalance.v[lane]);
    CHECK(one[lane].worst_time == lanes.worst_time.v[lane]);
    CHECK(one[lane].given == lanes.given.v[lane]);
    CHECK(one[lane].scale == lanes.scale.v[lane]);
    CHECK(one[lane].worst_time > 0.0);
  }
}

TEST_CASE("Extremes and contact totals: the same for one run and in lanes") {
  constexpr double kLow = -0.4, kHigh = 0.3, h = 0.1;
  Extremes<LaneRow> lane_peaks;
  Extremes<double> peaks[kLanes];
  ContactTotals<LaneRow> lane_totals;
  ContactTotals<double> totals[kLanes];
  LaneRow lane_largest;
  double largest[kLanes] = {};
  for (int step = 1; step <= kSteps; ++step) {
    const double t = h * step;
    const LaneRow value = row(step, 0.5);
    const Lanes low = Lanes{} + kLow, high = Lanes{} + kHigh;
    Lanes size = value.v;
    magnitude(size);
    lane_peaks.note(value.v, t, kAll);
    note_force(lane_totals, size, t, kAll, lane_largest);
    const bool passes = note_time_separated(lane_totals, low, high, row(step - 1, 0.5).v, value.v, h, kAll);
    bool any_passes = false;
    for (int lane = 0; lane < kLanes; ++lane) {
      const double x_0 = some(lane, step - 1, 0.5), x_1 = some(lane, step, 0.5);
      peaks[lane].note(x_1, t, true);
      note_force(totals[lane], std::abs(x_1), t, true, largest[lane]);
      any_passes |= note_time_separated(totals[lane], kLow, kHigh, x_0, x_1, h, true);
    }
    CHECK(passes == any_passes);
  }
  for (int lane = 0; lane < kLanes; ++lane) {
    CHECK(peaks[lane].max == lane_peaks.max.v[lane]);
    CHECK(peaks[lane].max_time == lane_peaks.max_time.v[lane]);
    CHECK(peaks[lane].min == lane_peaks.min.v[lane]);
    CHECK(peaks[lane].min_time == lane_peaks.min_time.v[lane]);
    CHECK(totals[lane].time_separated == Approx(lane_totals.time_separated.v[lane]).epsilon(1e-14));
    CHECK(totals[lane].time_separated > 0.1 * kSteps * h);
    CHECK(totals[lane].time_separated < 0.9 * kSteps * h);
    CHECK(totals[lane].largest_force == lane_totals.largest_force.v[lane]);
    CHECK(totals[lane].largest_force_time == lane_totals.largest_force_time.v[lane]);
    CHECK(largest[lane] == lane_largest.v[lane]);
  }
}

namespace {

/// A coupling that snaps through: y = -k x + a x^3, of energy a/4 x^4 - k/2 x^2, below zero between its two rests.
struct SnapLaw {
  double k = 1e3, a = 1e6;
  ScalarResponse operator()(const ScalarInput& in) const {
    const double x = in.x, x_2 = x * x;
    return {.y = (a * x_2 - k) * x,
            .dy_dx = 3.0 * a * x_2 - k,
            .stored_energy = (0.25 * a * x_2 - 0.5 * k) * x_2};
  }
};

}  // namespace

TEST_CASE("A law whose energy is below zero leaves a scale to the balance, in every method") {
  Model m("snap");
  m.add_node("a");
  m.add<Inertia>("J", {"a"}, {.inertia = 1.0});
  m.add<LawElement<SnapLaw>>("coupling", {"a"}, {});
  m.set_initial("a", 0.001, 0.0);
  const System s = m.build();
  for (const Method& method :
       {Method{.name = "exact", .tolerance = 1e-10}, Method{.name = "dormand_prince", .tolerance = 1e-9},
        Method{.name = "sdirk4", .tolerance = 1e-8}}) {
    INFO(to_text(method));
    State state = State::initial(s);
    const RunSummary summary = run_method(s, method, {.t_end = 0.5}, state, {});
    CHECK(summary.ok());
    CHECK(summary.steps + summary.rejected < 20000);
    CHECK(state.z[0] == Approx(0.0433873387002).epsilon(1e-6));  // DOP853 of scipy at 1e-13
  }
}
