#pragma once
/// A mass 1 kg on a spring with a dead zone. Its stiffness jumps at times that the steps are told of:
///
///   x'' + c x' + k(t) dz(x) = load,   k = k_double for `duty` of each period, then k_single
#include <drev/core/law_element.hpp>
#include <drev/core/system.hpp>
#include <drev/elements/catalogue.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace drev::problems {

struct SteppedSpring {
  double both = 1.2, single = 0.8;  ///< N/m
  double half_gap = 0.0;            ///< m
  std::vector<double> jumps = {};   ///< s, ascending; both before the first

  ScalarResponse operator()(const ScalarInput& in) const {
    const auto passed = std::upper_bound(jumps.begin(), jumps.end(), in.t) - jumps.begin();
    const double k = passed % 2 == 0 ? both : single;
    const double p = in.x - std::clamp(in.x, -half_gap, half_gap);
    return {.y = k * p, .dy_dx = p != 0.0 || half_gap == 0.0 ? k : 0.0, .stored_energy = 0.5 * k * p * p};
  }
};

struct SteppedOscillator {
  double both = 1.2, single = 0.8, half_gap = 0.0, duty = 0.5;
  double damping = 0.0, load = 0.0;
  double period = 1.0;
  int periods = 1;  ///< with jumps

  System build() const {
    std::vector<double> jumps;
    for (int i = 0; i < periods; ++i) jumps.push_back((i + duty) * period), jumps.push_back((i + 1) * period);
    Model m("stepped spring");
    m.add_node("m", NodeKind::translational);
    m.add<Inertia>("mass", {"m"}, {.inertia = 1.0});
    m.add<LawElement<SteppedSpring>>("k", {"m"}, {both, single, half_gap, jumps});
    m.add<Dashpot>("c", {"m"}, {.damping = damping});
    const double force = load;
    m.add<AppliedTorque>("load", {"m"}, {.torque = [force](double) { return force; }, .breakpoints = jumps});
    return m.build();
  }
};

}  // namespace drev::problems
