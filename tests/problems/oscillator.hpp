#pragma once
/// One inertia on a ground spring with damping, from rest under a constant torque:
///
///   J q'' + c q' + k q = tau,   q(0) = q_0, q'(0) = 0,   c < 2 sqrt(k J)
///   q = q_s + (q_0 - q_s) e^(-d t) (cos w t + d/w sin w t),   q_s = tau/k, d = c/(2 J), w^2 = k/J - d^2
#include <drev/core/system.hpp>
#include <drev/elements/catalogue.hpp>

#include <cmath>

namespace drev::problems {

struct Oscillator {
  double inertia = 2.0, damping = 3.0, stiffness = 800.0, torque = 5.0, start = 0.01;

  Model model() const {
    Model m("oscillator");
    m.add_node("disc");
    m.add<Inertia>("disc", {"disc"}, {.inertia = inertia});
    m.add<GroundSpring>("spring", {"disc"}, {.stiffness = stiffness, .damping = damping});
    const double tau = torque;
    m.add<AppliedTorque>("torque", {"disc"}, {.torque = [tau](double) { return tau; }});
    m.set_initial("disc", start, 0.0);
    return m;
  }
  double exact(double t) const {
    const double d = damping / (2.0 * inertia), w = std::sqrt(stiffness / inertia - d * d);
    const double rest = torque / stiffness;
    return rest + (start - rest) * std::exp(-d * t) * (std::cos(w * t) + d / w * std::sin(w * t));
  }
};

}  // namespace drev::problems
