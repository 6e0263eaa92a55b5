// The source's benchmark against the exact curves (piecewise matrix exponentials with located contact
// changes in extended precision; tests/published/data/case_*.csv).
#include <drev/core/system.hpp>
#include <drev/models/ready_made.hpp>
#include <drev/solvers/run/contact_statistics.hpp>
#include <drev/solvers/run/recorder.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <cmath>
#include <map>

#include "tests/catch.hpp"
#include "tests/published/read_csv.hpp"

using namespace drev;

namespace {

System build_case(const std::string& name, const std::string& k_1 = "2000", const std::string& k_2 = "") {
  const bool b = name == "case_B";
  Parameters s("two_mass_backlash", two_mass_backlash_entry().parameters);
  s.set("k_1_N_per_m", k_1);
  s.set("k_2_N_per_m", !k_2.empty() ? k_2 : b ? "1000" : "2000");
  s.set("half_gap_1_m", name == "case_A" ? "0" : "0.05");
  s.set("half_gap_2_m", name == "case_A" ? "0" : b ? "0.03" : "0.05");
  return two_mass_backlash_entry().build(s).model.build();
}

struct Deviations {
  RunSummary run;
  std::map<double, double> up_to;  // time -> largest deviation of both positions so far [m]
  std::map<double, double> at;     // time -> deviation there [m]
  double largest_position = 0.0;
};

Deviations deviations(const std::string& name, const System& system, const StepScheme& scheme, double step) {
  Recorder recorder(system, {"mass_1.position_m", "mass_2.position_m"}, 0.5);
  Deviations d;
  d.run =
      simulate(system, {.scheme = scheme, .step = step, .t_end = 10.0, .energy_tolerance = 1.0}, {&recorder});
  double worst = 0.0;
  for (const auto& row : read_csv(name + "_100N.csv")) {
    const double t = std::stod(row[0]);
    const auto i = static_cast<std::size_t>(std::lround(t / 0.5));
    if (i >= recorder.times().size()) break;
    d.at[t] = std::max(std::abs(recorder.samples(0)[i] - std::stod(row[1])),
                       std::abs(recorder.samples(1)[i] - std::stod(row[2])));
    worst = std::max(worst, d.at[t]);
    d.up_to[t] = worst;
  }
  for (std::size_t i = 0; i < recorder.times().size(); ++i)
    d.largest_position =
        std::max({d.largest_position, std::abs(recorder.samples(0)[i]), std::abs(recorder.samples(1)[i])});
  return d;
}

}  // namespace

TEST_CASE("Two masses with backlash: average acceleration at 1 ms beside FEDEM, A2 to 5 s") {
  // FEDEM R8.1.6 on the same problem: 5e-4 (A), 7.7e-3 (A2) and 1.25e-2 m (B) over 10 s.
  const auto average = average_acceleration();
  const Deviations a = deviations("case_A", build_case("case_A"), average, 1e-3);
  CHECK(a.up_to.at(2.0) <= 2.0e-6);
  CHECK(a.up_to.at(5.0) <= 5e-4);
  CHECK(a.up_to.at(10.0) <= 5.5e-4);
  const Deviations b = deviations("case_B", build_case("case_B"), average, 1e-3);
  CHECK(b.up_to.at(2.0) <= 1.8e-5);
  CHECK(b.up_to.at(5.0) <= 1.7e-3);
  CHECK(b.up_to.at(10.0) <= 1.25e-2);
  const Deviations a2 = deviations("case_A2", build_case("case_A2"), average, 1e-3);
  CHECK(a2.up_to.at(2.0) <= 2.7e-5);
  CHECK(a2.up_to.at(5.0) <= 4.8e-3);
}

TEST_CASE("Two masses with backlash, A2 to 10 s: FEDEM's 7.7e-3 m is missed at 1 ms, reached at 0.1 ms") {
  const auto average = average_acceleration();
  const Deviations a2 = deviations("case_A2", build_case("case_A2"), average, 1e-3);
  // A2 multiplies a deviation by 2.6e4 in 10 s: with the release at 2 s exact, the method's own error at 1 ms
  // is 2.367e-2 m by then (a separate program with the same method has the same). FEDEM's 7.7e-3 is not the
  // method's limit but where its release, spread over one step, happened to lead. Below it from 0.1 ms on.
  CHECK(a2.up_to.at(10.0) == Approx(2.367e-2).epsilon(1e-3));
  CHECK(deviations("case_A2", build_case("case_A2"), average, 1e-4).up_to.at(10.0) <= 7.7e-3);
}

TEST_CASE("Two masses with backlash: every implicit method is of order 2.00 +- 0.02") {
  // Up to 2 s case B has two contact changes; A is linear, with the jump of the load at 2 s behind it at
  // 2.5 s. Later in B, A2 the deviations are amplified and lose their regular decrease.
  for (const std::string method :
       {"average_acceleration", "linear_acceleration", "newmark:0.3,0.5", "hht:0.05", "hht:0.1", "hht:0.3",
        "generalized_alpha:0.9", "generalized_alpha:0.8", "generalized_alpha:0.5", "generalized_alpha:0"}) {
    INFO(method);
    const StepScheme scheme = step_scheme(method);
    for (const auto& [name, time] : {std::pair<std::string, double>{"case_A", 2.5}, {"case_B", 2.0}}) {
      const System system = build_case(name);
      const double coarse = deviations(name, system, scheme, 5e-4).at.at(time);
      const double fine = deviations(name, system, scheme, 2.5e-4).at.at(time);
      INFO(name << " at " << time << " s: " << coarse << ", " << fine);
      CHECK(std::log2(coarse / fine) == Approx(2.0).margin(0.02));
    }
  }
}

TEST_CASE("Two masses with backlash, case B: the energy balance is kept to 1e-3 of the input") {
  for (const double step : {1e-3, 1e-4}) {
    const Deviations b = deviations("case_B", build_case("case_B"), average_acceleration(), step);
    CHECK(std::abs(b.run.energy.worst_imbalance) < 1e-3 * b.run.energy.input);
    // Exact energy after the release, extended precision: 4.35862005966056 J.
    CHECK(b.run.energy.kinetic + b.run.energy.stored == Approx(4.35862005966056).epsilon(1e-3));
  }
}

TEST_CASE("Two masses with backlash: contact changes are those of the exact solution") {
  for (const std::string name : {"case_A2", "case_B"}) {
    const System system = build_case(name);
    ContactStatistics contacts(system);
    simulate(system, {.step = 1e-4, .t_end = 5.0}, {&contacts});
    long front[2] = {0, 0}, back[2] = {0, 0};
    for (const auto& row : read_csv(name + "_100N_events.csv")) {
      if (std::stod(row[0]) > 5.0) continue;
      const auto spring = static_cast<std::size_t>(std::stoi(row[1]) - 1);
      const int before = std::stoi(row[2 + spring]), after = std::stoi(row[4 + spring]);
      if (before == 0 && after == 1) ++front[spring];
      if (before == 0 && after == -1) ++back[spring];
    }
    for (std::size_t s = 0; s < 2; ++s) {
      INFO(name << " spring " << s + 1);
      CHECK(contacts.records()[s].front_impacts == front[s]);
      CHECK(contacts.records()[s].back_impacts == back[s]);
    }
  }
}

TEST_CASE("Two masses with backlash, k = 2e8 N/m at 1 ms: never passed as success") {
  // omega h = 4.5: average acceleration gains energy at impacts. The true motion stays below 0.09 m.
  for (const std::string k_2 : {"1000", "2e8"}) {
    const System system = build_case("case_B", "2e8", k_2);
    const RunSummary run = simulate(system, {.step = 1e-3, .t_end = 10.0});
    CHECK(!run.ok());
    CHECK(!run.reason.empty());
    CHECK(std::abs(run.energy.relative_error()) > 0.5);
    const Deviations damped = deviations("case_B", system, hht(0.3), 1e-3);
    CHECK(damped.run.t_end == 10.0);
    CHECK(damped.largest_position < 0.2);
  }
}
