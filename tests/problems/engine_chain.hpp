#pragma once
/// A crankshaft of six cylinders between pulley and flywheel, and its cylinders' torque by orders.
///
/// Data: openTorsion, example of a six-cylinder diesel (commit 88ab789, MIT), after doi 10.1243/14644193JMBD126.
/// Its torques and expected values: exact crank-slider kinematics and Fourier integrals, by separate programs in
/// Python and C++ that agree to 2e-8; tests/published/data/six_cylinder_orders.csv.
#include <drev/core/model.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/dashpot.hpp>
#include <drev/elements/engine_order_torque.hpp>
#include <drev/elements/inertia.hpp>
#include <drev/elements/shaft_spring.hpp>

#include <array>
#include <complex>
#include <string>
#include <vector>

namespace drev::test {

struct EngineChain {
  static constexpr std::array<double, 9> kInertias{0.0170, 0.0090, 0.0467, 0.0327, 0.0467,
                                                   0.0467, 0.0327, 0.0487, 2.0750};
  static constexpr std::array<double, 8> kStiffnesses{1.106e6, 1.631e6, 1.253e6, 1.253e6,
                                                      1.678e6, 1.253e6, 1.253e6, 1.976e6};
  static constexpr std::array<double, 6> kFiring{0.0, 240.0, 480.0, 120.0, 600.0, 360.0};  ///< deg

  double damping_over_stiffness = 0.0;  ///< of every shaft [s]
  double ground_damping = 2.0;          ///< at every cylinder [N m s/rad]
  double speed = 200.0;                 ///< rad/s
  std::vector<double> orders;
  std::vector<std::complex<double>> torque;  ///< of a cylinder that fires at 0 deg [N m], of each order
  double mean = 0.0;                         ///< N m of a cylinder

  static std::string shaft(std::size_t i) { return "shaft_" + std::to_string(i + 1); }

  Model model() const {
    Model m("six cylinders");
    for (std::size_t i = 0; i < kInertias.size(); ++i) {
      const std::string node = "n" + std::to_string(i);
      m.add_node(node);
      m.add<Inertia>("J_" + node, {node}, {.inertia = kInertias[i]});
      if (i > 0)
        m.add<ShaftSpring>(
            shaft(i - 1), {"n" + std::to_string(i - 1), node},
            {.stiffness = kStiffnesses[i - 1], .damping = damping_over_stiffness * kStiffnesses[i - 1]});
      if (i < 2 || i > 7) continue;
      if (ground_damping > 0.0) m.add<Dashpot>("drag_" + node, {node}, {.damping = ground_damping});
      std::vector<Harmonic> harmonics;
      for (std::size_t k = 0; k < orders.size(); ++k)
        harmonics.push_back(
            {orders[k], std::abs(torque[k]), std::arg(torque[k]) - orders[k] * deg(kFiring[i - 2])});
      m.add<EngineOrderTorque>("gas_" + node, {node},
                               {.harmonics = harmonics, .mean = mean, .twist_feedback = false});
    }
    m.set_reference("n8", constant_speed(speed));
    return m;
  }
};

}  // namespace drev::test
