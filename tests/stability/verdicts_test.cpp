// What a run says of itself beside its status (solvers/stepping/coarse_steps.hpp, solvers/run/stiff_twists.hpp):
// coarse steps and shafts too stiff for their angles are told, runs that are right are not.
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/run/observer.hpp>
#include <drev/solvers/run/peaks.hpp>

#include <algorithm>
#include <cmath>

#include "solvers/run/stiff_twists.hpp"
#include "tests/catch.hpp"
#include "tests/problems/driven_gear.hpp"

using namespace drev;
using namespace drev::problems;

namespace {

/// Motor and load on a shaft under 20 sin(2 pi 40 t) N m; the shaft's mode is at 155 Hz for 8500 N m/rad.
System two_inertias(double stiffness, double damping = 0.5) {
  Model m("two inertias");
  for (const char* node : {"motor", "load"}) m.add_node(node);
  m.add<Inertia>("J_motor", {"motor"}, {.inertia = 0.012});
  m.add<Inertia>("J_load", {"load"}, {.inertia = 0.035});
  m.add<ShaftSpring>("shaft", {"motor", "load"}, {.stiffness = stiffness, .damping = damping});
  m.add<AppliedTorque>("drive", {"motor"},
                       {.torque = [](double t) { return 20.0 * std::sin(kTwoPi * 40.0 * t); }});
  return m.build();
}

bool warns(const RunSummary& run, const std::string& of) {
  for (const std::string& warning : run.warnings)
    if (warning.find(of) != std::string::npos) return true;
  return false;
}

}  // namespace

TEST_CASE("Steps that cannot see a load or the mode that moves say so, steps that can do not", "[verdict]") {
  const System system = two_inertias(8500.0);
  for (const char* method : {"average_acceleration", "generalized_alpha:0.9", "bathe", "sdirk4"}) {
    for (const double step : {0.05, 0.025, 0.01, 0.007, 0.004, 0.002}) {
      INFO(method << ", " << step << " s");
      CHECK(warns(run_method(system, {.name = method, .step = step}, {.t_end = 0.5}), "too long"));
    }
    for (const double step : {1e-3, 3e-4, 1e-4, 1e-5}) {
      INFO(method << ", " << step << " s");
      CHECK(run_method(system, {.name = method, .step = step}, {.t_end = 0.5}).warnings.empty());
    }
  }
  CHECK(run_method(system, {.name = "dormand_prince", .tolerance = 1e-6}, {.t_end = 0.5}).warnings.empty());
}

TEST_CASE("A mode that carries no motion may be stepped over without a warning", "[verdict]") {
  // The mode is at 15.5 kHz, and the damper has it settle at once.
  const System system = two_inertias(8.5e7, 100.0);
  const RunSummary run = run_method(system, {.name = "generalized_alpha:0.5", .step = 2e-4}, {.t_end = 0.5});
  CHECK(run.ok());
  CHECK(run.warnings.empty());
}

TEST_CASE("A shaft too stiff for its angles: the run says what rounding leaves, and as much is off",
          "[verdict]") {
  // Rigid: the load's share of the torque.
  const double peak = 20.0 * 0.035 / 0.047;
  for (const double stiffness : {1e13, 1e14, 1e16, 1e18, 1e20}) {
    const System system = two_inertias(stiffness);
    Peaks peaks(find_channels(system, {"shaft.torque_Nm"}));
    const Method method{.name = "sdirk4", .tolerance = 1e-4};
    const RunSummary run = run_method(system, method, {.t_end = 0.05}, {&peaks});
    INFO(stiffness << " N m/rad: " << run.brief_report());
    const double off = std::abs(peaks.peaks()[0].amplitude() - peak) / peak;
    CHECK((warns(run, "shaft is so stiff") || off < 1e-3 || !run.ok()));
    if (stiffness >= 1e16) CHECK(warns(run, "shaft is so stiff"));
    REQUIRE(run.rounding.size() == (warns(run, "shaft is so stiff") ? 1u : 0u));
    for (const auto& [channel, error] : run.rounding) {
      CHECK(channel == "shaft.torque_Nm");
      CHECK(error > off * peak);
    }
  }
  const RunSummary soft =
      run_method(two_inertias(1e7), {.name = "exact", .tolerance = 1e-10}, {.t_end = 0.2});
  CHECK(soft.warnings.empty());
  CHECK(soft.rounding.empty());
}

TEST_CASE("Runs with jumps of stiffness are right and say so, whatever the method and where they end",
          "[verdict]") {
  for (const double speed : {0.37, 0.9, 2.3, 7.1})
    for (const double periods : {1.0, 3.5, 6.0}) {
      const double period = kTwoPi / speed;
      const System system =
          DrivenGear{
              .speed = speed, .stiffness = MeshStiffness::step(0.8, 1.2, 1.5), .damping = 0.05, .x = 1.0}
              .build();
      State right = State::initial(system);
      run_method(system, {.name = "dormand_prince", .tolerance = 1e-9}, {.t_end = periods * period}, right);
      for (const Method& method : {Method{.name = "exact", .tolerance = 1e-10},
                                   {.name = "sdirk4", .tolerance = 1e-6},
                                   {.name = "average_acceleration", .tolerance = 1e-5},
                                   {.name = "average_acceleration", .step = std::min(period / 500, 0.02)}}) {
        State state = State::initial(system);
        const RunSummary run = run_method(system, method, {.t_end = periods * period}, state);
        INFO(to_text(method) << ", speed " << speed << ", " << periods << " periods: " << run.brief_report());
        CHECK(run.ok());
        CHECK(run.warnings.empty());
        CHECK(std::abs(state.z[0] - right.z[0]) < 1e-2);
      }
    }
}

namespace {

/// Per mesh period, of x'' + k(t) x = 0 with k = single and double in turn, double for the contact ratio less 1 of
/// the period: the larger root of its characteristic equation, 1 where nothing grows (Meissner's equation).
double meissner_multiplier(double single, double twice, double contact_ratio, double speed) {
  const double period = kTwoPi / speed, w_1 = std::sqrt(twice), w_2 = std::sqrt(single);
  const double a = w_1 * (contact_ratio - 1.0) * period, b = w_2 * (2.0 - contact_ratio) * period;
  const double half =
      std::abs(std::cos(a) * std::cos(b) - 0.5 * (w_1 / w_2 + w_2 / w_1) * std::sin(a) * std::sin(b));
  return half > 1.0 ? half + std::sqrt(half * half - 1.0) : 1.0;
}

/// What a run makes of it: growth a period over the second half of the periods, from the energy; and its verdict.
struct Grown {
  double multiplier = 0.0;
  RunSummary run;
};
Grown grown(const System& system, const Method& method, double period, int periods) {
  State state = State::initial(system);
  Grown g;
  double before = 0.0;
  for (const int until : {periods / 2, periods}) {
    state = State::initial(system);
    g.run = run_method(system, method, {.t_end = until * period}, state);
    const double energy = state.z.squaredNorm() + state.v.squaredNorm();
    if (until == periods) g.multiplier = std::pow(energy / before, 0.5 / (periods - periods / 2));
    before = energy;
  }
  return g;
}

}  // namespace

TEST_CASE("Parametric growth is a success where it is the model's own, and none where it is the method's",
          "[verdict]") {
  constexpr double kSingle = 0.8, kDouble = 1.2, kContactRatio = 1.5;
  constexpr int kPeriods = 40;
  int growing = 0, wrong = 0;
  for (const double speed : {0.66, 1.0, 1.4, 1.7, 1.95, 2.0, 2.08, 2.6, 3.5}) {
    const double period = kTwoPi / speed;
    const double closed = meissner_multiplier(kSingle, kDouble, kContactRatio, speed);
    const System system =
        DrivenGear{
            .speed = speed, .stiffness = MeshStiffness::step(kSingle, kDouble, kContactRatio), .x = 1.0}
            .build();
    growing += std::pow(closed, kPeriods) > 1e3;
    for (const Method& method : {Method{.name = "exact", .tolerance = 1e-10},
                                 {.name = "sdirk4", .tolerance = 1e-7},
                                 {.name = "average_acceleration", .step = period / 2000}}) {
      const Grown g = grown(system, method, period, kPeriods);
      INFO(to_text(method) << ", speed " << speed << ": " << g.run.brief_report());
      CHECK(g.run.ok());
      CHECK(g.run.warnings.empty());
      CHECK(g.multiplier == Approx(closed).margin(0.02));
    }
    for (const char* name : {"average_acceleration", "hht:0.1", "generalized_alpha:0.8", "newmark:0.25,0.6",
                             "bathe", "sdirk4", "linear_acceleration"})
      for (const int steps : {2, 3, 4, 5, 6, 8, 10, 13}) {
        Grown g;
        try {
          g = grown(system, {.name = name, .step = period / steps}, period, kPeriods);
        } catch (const std::exception&) {  // refused: the step is above the method's limit
          continue;
        }
        if (std::abs(g.multiplier - closed) < 0.05 * closed) continue;
        ++wrong;
        INFO(name << ", " << steps << " steps a period, speed " << speed << ", grows " << g.multiplier
                  << " a period in place of " << closed << ": " << g.run.brief_report());
        CHECK((!g.run.ok() || !g.run.warnings.empty()));
      }
  }
  CHECK(growing >= 3);
  CHECK(wrong > 50);
}
