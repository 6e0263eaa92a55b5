// Exact propagation against the exact curves of the source's benchmark and their contact changes
// (piecewise matrix exponentials with located changes in extended precision; data/case_*.csv).
#include <drev/core/system.hpp>
#include <drev/models/ready_made.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/run/contact_statistics.hpp>
#include <drev/solvers/run/recorder.hpp>

#include <algorithm>
#include <cmath>

#include "tests/catch.hpp"
#include "tests/published/read_csv.hpp"

using namespace drev;

namespace {

System build_exact_case(const std::string& name) {
  const bool b = name == "case_B";
  Parameters s("two_mass_backlash", two_mass_backlash_entry().parameters);
  s.set("k_2_N_per_m", b ? "1000" : "2000");
  s.set("half_gap_1_m", name == "case_A" ? "0" : "0.05");
  s.set("half_gap_2_m", name == "case_A" ? "0" : b ? "0.03" : "0.05");
  return two_mass_backlash_entry().build(s).model.build();
}

}  // namespace

TEST_CASE("Exact propagation, two masses with backlash: curves and contact changes to 1e-11") {
  for (const std::string name : {"case_A", "case_A2", "case_B"}) {
    const System system = build_exact_case(name);
    Recorder recorder(
        system,
        {"mass_1.position_m", "mass_2.position_m", "mass_1.velocity_m_per_s", "mass_2.velocity_m_per_s"},
        0.5);
    ContactStatistics contacts(system);
    std::vector<ContactChange> changes;
    // A2 multiplies a deviation by 2.6e4 in 10 s: the tolerance is near rounding.
    const RunSummary run = propagate(system,
                                     {.tolerance = 1e-15,
                                      .t_end = 10.0,
                                      .energy_tolerance = 1e-11,
                                      .on_change = [&](const ContactChange& c) { changes.push_back(c); }},
                                     {&recorder, &contacts});
    INFO(name << ": " << run.brief_report());
    CHECK(run.ok());
    CHECK(run.scheme == "exact");

    const auto curve = read_csv(name + "_100N.csv");
    REQUIRE(recorder.times().size() == curve.size() + 1);
    double worst = 0.0;
    for (std::size_t i = 0; i < curve.size(); ++i)
      for (std::size_t c = 0; c < 4; ++c)
        worst = std::max(worst, std::abs(recorder.samples(c)[i + 1] - std::stod(curve[i][c + 1])) *
                                    (c < 2 ? 1.0 : 0.1));  // velocities in m/s are 10 times as large
    CHECK(worst < 1e-11);

    // Every change of the table and no other, in its order; pieces 0, 1, 2: behind, in the gap, in
    // front.
    const auto events = read_csv(name + "_100N_events.csv");
    REQUIRE(changes.size() == events.size());
    CHECK(run.contact_changes == static_cast<long>(events.size()));
    double worst_time = 0.0;
    for (std::size_t i = 0; i < events.size(); ++i) {
      const int law = std::stoi(events[i][1]) - 1;
      CHECK(changes[i].law == law);
      CHECK(changes[i].from == std::stoi(events[i][static_cast<std::size_t>(2 + law)]) + 1);
      CHECK(changes[i].to == std::stoi(events[i][static_cast<std::size_t>(4 + law)]) + 1);
      worst_time = std::max(worst_time, std::abs(changes[i].t - std::stod(events[i][0])));
    }
    CHECK(worst_time < 1e-11);
    for (int law = 0; law < 2; ++law) {
      if (name == "case_A") continue;  // no gap
      const auto count = [&](int from, int to) {
        return std::count_if(changes.begin(), changes.end(), [&](const ContactChange& c) {
          return c.law == law && c.from == from && c.to == to;
        });
      };
      const ContactRecord& record = contacts.records()[static_cast<std::size_t>(law)];
      CHECK(record.front_impacts == count(1, 2));
      CHECK(record.back_impacts == count(1, 0));
      CHECK(record.front_speed.count() == count(1, 2));
      CHECK(record.back_speed.count() == count(1, 0));
      // Contacts that were left again; the masses start in the gaps.
      CHECK(record.front_force.count() == count(2, 1));
      CHECK(record.back_force.count() == count(0, 1));
    }
  }
}
