// Elements of one's own in a few lines: a coupling whose stiffness grows with its twist, and a fan.
// Shows: a law and a torque in one formula each, LawElement, LoadElement, check_element. The text is docs/adding_an_element.md.
// Run:   build/release/bin/example_custom_element
// Read first: two_inertia.
#include <drev/core/channel.hpp>
#include <drev/core/verify.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/elements/own_element.hpp>
#include <drev/solvers/run/peaks.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <cmath>
#include <cstdio>

// [law]
/// y = k x + k3 x^3 [N m], x = twist of end b against end a [rad].
struct CubicLaw {
  double k;   ///< N m/rad, > 0
  double k3;  ///< N m/rad^3, >= 0

  template <class T>
  T force(const T& x, const T& /*x_dot*/) const {
    return k * x + k3 * x * x * x;
  }
  double stored_energy(double x) const { return 0.5 * k * x * x + 0.25 * k3 * x * x * x * x; }  // J
  void check(drev::ParameterCheck& check) const {
    check.positive("k", k, "N m/rad");
    check.non_negative("k3", k3, "N m/rad^3");
  }
};
using CubicCoupling = drev::LawElement<CubicLaw>;
// [law]

// [torque]
/// tau = -c w |w| [N m], w = speed of the node.
struct FanTorque {
  double c;  ///< N m s^2/rad^2, > 0

  template <class T>
  T torque(double /*t*/, const T& /*angle*/, const T& speed) const {
    using std::abs;
    return -c * speed * abs(speed);
  }
  void check(drev::ParameterCheck& check) const { check.positive("c", c, "N m s^2/rad^2"); }
};
using Fan = drev::LoadElement<FanTorque>;
// [torque]

int main() {
  using namespace drev;
  // [check]
  const CheckReport report = check_element(CubicCoupling({.k = 2e4, .k3 = 5e6}), 2);
  for (const std::string& failure : report.failures) std::printf("%s\n", failure.c_str());
  if (!report.ok()) return 1;
  // [check]
  if (!check_element(Fan({.c = 0.05}), 1).ok()) return 1;

  // [use]
  Model m("engine and pump");
  m.add_node("engine");
  m.add_node("pump");
  m.add<Inertia>("J_engine", {"engine"}, {.inertia = 2.0});
  m.add<Inertia>("J_pump", {"pump"}, {.inertia = 3.0});
  m.add<CubicCoupling>("coupling", {"engine", "pump"}, {.k = 2e4, .k3 = 5e6});
  m.set_initial("engine", 0.1, 0.0);
  const System system = m.build();
  Peaks peaks({find_channel(system, "coupling.torque_Nm")});
  const RunSummary run = simulate(system, {.step = 1e-5, .t_end = 0.5}, {&peaks});
  // [use]
  std::printf("largest coupling torque %.1f N m; %s\n", peaks.peaks()[0].amplitude(),
              run.brief_report().c_str());
  return run.ok() ? 0 : 1;
}
