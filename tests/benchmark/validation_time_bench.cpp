// The tables of docs/validation.md on integration in time.
//   build/release/bin/bench_validation_time [name of one table, e.g. "Two masses*"]
#include <drev/core/law_element.hpp>
#include <drev/core/system.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/models/ready_made.hpp>
#include <drev/solvers/run/contact_statistics.hpp>
#include <drev/solvers/run/peaks.hpp>
#include <drev/solvers/run/recorder.hpp>
#include <drev/solvers/statics.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <cmath>
#include <cstdio>
#include <map>

#include "tests/catch.hpp"
#include "tests/problems/backlash_oscillator.hpp"
#include "tests/published/read_csv.hpp"

using namespace drev;

namespace {

struct TwoMasses {
  double k_1 = 2000, k_2 = 2000, half_gap_1 = 0.05, half_gap_2 = 0.05;
  double release = 2.0, released = 2.0;  // the force falls from one time to the other
};
const std::map<std::string, TwoMasses> kCases = {
    {"A", {2000, 2000, 0, 0}}, {"A2", {2000, 2000, 0.05, 0.05}}, {"B", {2000, 1000, 0.05, 0.03}}};

/// models/two_mass_backlash, with the time of the release free.
System two_masses(const TwoMasses& c) {
  Model m("two_mass_backlash");
  for (const char* name : {"mass_1", "mass_2"}) {
    m.add_node(name, NodeKind::translational);
    m.add<Inertia>(std::string("m_") + name, {name}, {.inertia = 10.0});
  }
  m.add<PolylineSpring>("spring_1", {"mass_1"}, PolylineSpring::dead_band(c.k_1, c.half_gap_1));
  m.add<PolylineSpring>("spring_2", {"mass_1", "mass_2"}, PolylineSpring::dead_band(c.k_2, c.half_gap_2));
  m.add<AppliedTorque>("force", {"mass_2"},
                       {.table = TimeTable({0.0, 1.0, c.release, c.released}, {0, 100, 100, 0})});
  return m.build();
}

struct Deviations {
  RunSummary run;
  std::map<double, double> up_to, at;  // time -> largest deviation so far, and there [m]
  double largest_position = 0.0;
};

Deviations deviations(const std::string& name, const TwoMasses& c, const StepScheme& scheme, double step) {
  const System system = two_masses(c);
  Recorder r(system, {"mass_1.position_m", "mass_2.position_m"}, 0.5);
  Deviations d;
  d.run = simulate(system, {.scheme = scheme, .step = step, .t_end = 10.0, .energy_tolerance = 10}, {&r});
  double worst = 0.0;
  for (const auto& row : read_csv("case_" + name + "_100N.csv")) {
    const double t = std::stod(row[0]);
    const auto i = static_cast<std::size_t>(std::lround(t / 0.5));
    if (i >= r.times().size()) break;
    d.at[t] = std::max(std::abs(r.samples(0)[i] - std::stod(row[1])),
                       std::abs(r.samples(1)[i] - std::stod(row[2])));
    d.up_to[t] = worst = std::max(worst, d.at[t]);
  }
  for (const std::size_t c_i : {0u, 1u})
    for (const double x : r.samples(c_i)) d.largest_position = std::max(d.largest_position, std::abs(x));
  return d;
}

}  // namespace

TEST_CASE("Published cases 7 to 9") {
  const System gap = backlash_oscillator(50.0, kPi / 4);
  std::printf("case 7: | t [s] | phi published | drev, h = 5e-6 s | w published | drev |\n");
  Recorder r(gap, {"disc.angle_rad", "disc.speed_rad_per_s"}, 0.05);
  simulate(gap, {.step = 5e-6, .t_end = 1.0}, {&r});
  for (const auto& [t, phi, w] : {std::tuple{0.1, 0.2498358550, 52.8937186},
                                  {0.25, 0.5808155699, 30.0804578},
                                  {0.5, -0.3099580355, -17.2284257},
                                  {1.0, -0.1555814136, -7.0229373}}) {
    const auto i = static_cast<std::size_t>(std::lround(t / 0.05));
    std::printf("| %.2f | %.10f | %.10f | %.7f | %.7f |\n", t, phi, r.samples(0)[i], w, r.samples(1)[i]);
  }
  const System no_gap = backlash_oscillator(50.0, 0.0);
  Recorder n(no_gap, {"disc.angle_rad", "disc.speed_rad_per_s"}, 0.1);
  simulate(no_gap, {.step = 1e-6, .t_end = 0.1}, {&n});
  std::printf("without a gap: | 0.10 | 0.9541444033 | %.10f | -1.3039986217 | %.10f |\n", n.samples(0)[1],
              n.samples(1)[1]);

  const System undamped = backlash_oscillator(0.0, kPi / 4);
  Reversals reversals;
  simulate(undamped, {.step = 1e-6, .t_end = 0.5}, {&reversals});
  std::printf("case 8: period 0.1204277338 s, drev %.10f s (three periods, h = 1e-6 s)\n",
              reversals.times.at(5) / 3.0);

  Model m("ideal gear");
  m.add_node("first");
  m.add_node("second");
  m.add<Inertia>("J_1", {"first"}, {.inertia = 10.0});
  m.add<Inertia>("J_2", {"second"}, {.inertia = 100.0});
  m.add<IdealGear>("gear", {"first", "second"}, {.ratio = -0.1});
  m.add<AppliedTorque>("drive", {"first"}, {.torque = [](double) { return 6.0; }});
  const System geared = m.build();
  Recorder g(geared,
             {"first.acceleration_rad_per_s2", "second.acceleration_rad_per_s2", "first.angle_rad",
              "first.speed_rad_per_s"},
             0.5);
  simulate(geared, {.step = 1e-3, .t_end = 0.5}, {&g});
  std::printf("case 9: 0.5454545455 %.10f | -0.0545454545 %.10f | 0.0681818 %.10f | 0.2727273 %.10f\n",
              g.samples(0)[1], g.samples(1)[1], g.samples(2)[1], g.samples(3)[1]);
}

TEST_CASE("Two masses: deviations from the exact curves") {
  std::printf("| case | h [s] | release | up to 2 s | 5 s | 10 s |\n");
  const auto print = [](const std::string& name, TwoMasses c, double h, const char* how) {
    const Deviations d = deviations(name, c, average_acceleration(), h);
    std::printf("| %s | %g | %s | %.2e | %.2e | %.2e |\n", name.c_str(), h, how, d.up_to.at(2), d.up_to.at(5),
                d.up_to.at(10));
  };
  for (const auto& [name, c] : kCases) print(name, c, 1e-3, "exact");
  for (auto [name, c] : kCases) {
    c.released = 2.001;
    print(name, c, 1e-3, "over one step");
  }
  for (const double h : {5e-4, 2.5e-4, 1e-4}) print("A2", kCases.at("A2"), h, "exact");
  for (const char* name : {"A", "B"}) print(name, kCases.at(name), 1e-4, "exact");
}

TEST_CASE("Two masses: observed orders, from h = 0.5 ms and 0.25 ms") {
  std::printf("| method | A at 2.5 s | B at 2 s |\n");
  for (const std::string method :
       {"average_acceleration", "linear_acceleration", "newmark:0.3,0.5", "hht:0.05", "hht:0.1", "hht:0.3",
        "generalized_alpha:0.9", "generalized_alpha:0.8", "generalized_alpha:0.5", "generalized_alpha:0"}) {
    std::printf("| %s |", method.c_str());
    for (const auto& [name, time] : {std::pair<std::string, double>{"A", 2.5}, {"B", 2.0}}) {
      const double coarse = deviations(name, kCases.at(name), step_scheme(method), 5e-4).at.at(time);
      const double fine = deviations(name, kCases.at(name), step_scheme(method), 2.5e-4).at.at(time);
      std::printf(" %.4f |", std::log2(coarse / fine));
    }
    std::printf("\n");
  }
}

TEST_CASE("Two masses: energy") {
  std::printf(
      "| case | method | h [s] | status | input [J] | worst imbalance [J] | relative | largest position [m] "
      "|\n");
  const auto print = [](const char* name, const TwoMasses& c, const std::string& method, double h) {
    Deviations d = deviations("B", c, step_scheme(method), h);
    const RunSummary judged =
        simulate(two_masses(c), {.scheme = step_scheme(method), .step = h, .t_end = 10.0});
    const EnergyBalance& e = judged.energy;
    std::printf("| %s | %s | %g | %s | %.6g | %.2e | %.2e | %.3g |\n", name, method.c_str(), h,
                to_text(judged.status), e.input, e.worst_imbalance, e.relative_error(), d.largest_position);
    std::printf("    kinetic + stored at the end %.14g J; %s\n", e.kinetic + e.stored, judged.reason.c_str());
  };
  const TwoMasses b = kCases.at("B");
  for (const double h : {1e-3, 1e-4}) print("B", b, "average_acceleration", h);
  for (const double k_2 : {1000.0, 2e8})
    for (const char* method : {"average_acceleration", "hht:0.3"})
      print(k_2 == 2e8 ? "B, both k = 2e8" : "B, k_1 = 2e8", {2e8, k_2, 0.05, 0.03}, method, 1e-3);
}

TEST_CASE("Held camshaft: 36 targets") {
  std::printf(
      "| cylinders | damping | h [ms] | deflection [deg] | target | torque [N m] | target | "
      "static [N m] | target | amplification | target |\n");
  double worst[4] = {};
  for (const auto& row : read_csv("camshaft_transient_targets.csv")) {
    Parameters s("camshaft", camshaft_entry().parameters);
    s.set("cylinders", row[0]);
    s.set("damping", row[1]);
    s.set("drive", "held");
    s.set("loads", "source");
    const ModelCase model_case = camshaft_entry().build(s);
    const System system = model_case.model.build();
    Peaks deflection(find_channels(system, {model_case.deflection}));
    Peaks torque(find_channels(system, model_case.torques));
    simulate(system, {.step = std::stod(row[2]), .t_end = model_case.duration}, {&deflection, &torque});
    double static_torque = 0.0;
    for (const Peak& p : static_sweep(system, find_channels(system, model_case.torques), 0.0, kTwoPi, 1440))
      static_torque = std::max(static_torque, p.amplitude());
    const double largest = torque.peaks()[torque.largest()].amplitude();
    const double found[4] = {to_deg(deflection.peaks()[0].amplitude()), largest, static_torque,
                             largest / static_torque};
    const double target[4] = {std::stod(row[3]), std::stod(row[4]), std::stod(row[6]), std::stod(row[5])};
    std::printf("| %s | %s | %g |", row[0].c_str(), row[1].c_str(), 1e3 * std::stod(row[2]));
    const int decimals[4] = {5, 1, 1, 4};
    for (std::size_t i = 0; i < 4; ++i) {
      std::printf(" %.*f | %.*f |", decimals[i], found[i], decimals[i], target[i]);
      worst[i] = std::max(worst[i], std::abs(found[i] / target[i] - 1.0));
    }
    std::printf("\n");
  }
  std::printf("largest differences: deflection %.1e, torque %.1e, static %.1e, amplification %.1e\n",
              worst[0], worst[1], worst[2], worst[3]);
}
