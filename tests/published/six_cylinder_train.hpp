#pragma once
/// The six-cylinder diesel of tests/problems/engine_chain.hpp with its cylinders as elements: gas pressure over the
/// crank angle, scaled by the peak pressure over speed (models/six_cylinder, openTorsion's example data, MIT).
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/periodic/linear_sweep.hpp>

#include <memory>
#include <optional>
#include <stdexcept>

#include "tests/problems/engine_chain.hpp"
#include "tests/published/read_csv.hpp"

namespace drev::test {

using Chain = EngineChain;

inline GasPressure::Params measured_pressure() {
  GasPressure::Params gas{.reference_pressure = 15.2e6, .firing_tdc = deg(360)};
  for (const auto& row : read_csv("../../../models/six_cylinder/pressure.csv")) {
    gas.angle.push_back(deg(std::stod(row[0])));
    gas.pressure.push_back(1e6 * std::stod(row[1]));
  }
  for (const auto& row : read_csv("../../../models/six_cylinder/peak_pressure.csv")) {
    gas.peak_speed.push_back(rpm(std::stod(row[0])));
    gas.peak_pressure.push_back(1e6 * std::stod(row[1]));
  }
  return gas;
}

inline EngineCylinders::Params diesel(const std::string& order, int misfiring = 0) {
  return {.bore = 0.105,
          .stroke = 0.137,
          .rod = 0.207,
          .oscillating_mass = 2.521,
          .firing_angles = EngineCylinders::even_firing(order, 4, deg(360)),
          .gas = measured_pressure(),
          .misfiring_cylinder = misfiring};
}

/// eta: loss factor of the shafts; with 0 they are viscous, c = viscous k/(2 pi 216.6 Hz). engine: none leaves the
/// cylinders' torque out.
inline Model train(double eta, double speed, std::optional<EngineCylinders::Params> engine,
                   double viscous = 0.035) {
  Model m("six cylinders");
  std::vector<NodeRef> throws;
  for (std::size_t i = 0; i < Chain::kInertias.size(); ++i) {
    const std::string node = "n" + std::to_string(i);
    m.add_node(node);
    m.add<Inertia>("J_" + node, {node}, {.inertia = Chain::kInertias[i]});
    const std::string before = "n" + std::to_string(i - 1);
    if (i > 0 && eta > 0.0)
      m.add<ElasticCoupling>(Chain::shaft(i - 1), {before, node},
                             {.material = {.stiffness = Chain::kStiffnesses[i - 1],
                                           .loss_factor = eta,
                                           .lowest_frequency = 150,
                                           .highest_frequency = 300}});
    if (i > 0 && eta == 0.0)
      m.add<ShaftSpring>(Chain::shaft(i - 1), {before, node},
                         {.stiffness = Chain::kStiffnesses[i - 1],
                          .damping = viscous / (kTwoPi * 216.58360524) * Chain::kStiffnesses[i - 1]});
    if (i < 2 || i > 7) continue;
    m.add<AbsoluteDamper>("drag_" + node, {node}, {.damping = 2.0});
    throws.emplace_back(node);
  }
  if (engine) m.add("engine", throws, std::make_shared<const EngineCylinders>(std::move(*engine)));
  m.set_reference("n8", constant_speed(speed));
  return m;
}

inline const SweepSection& shaft_of(const LinearSweep& sweep, int number) {
  for (const SweepSection& s : sweep.sections)
    if (s.name == Chain::shaft(std::size_t(number - 1)) + ".torque_Nm") return s;
  throw std::runtime_error("no such shaft");
}

}  // namespace drev::test
