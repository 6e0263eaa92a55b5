#pragma once
/// ElementEnergy: what one element stores, loses and gives at a state; the law behind the channels of energy and
/// power (channel.hpp). With the element's own terms over its nodes, q the deviations, w = n phi' + q' the actual
/// rates, f the forces on the left side of the equation of motion, p its loads:
///
///   power        P = (p - f)' w                                    W, > 0: it drives the train
///   dissipation  D = w' C w + q'' C_d q' + the laws' own           W, >= 0 for a passive element
///   stored       V = 1/2 q' K q + the laws' energies               J
///   kinetic      T = 1/2 w' M w                                    J
///
/// C with the element's part of Rayleigh damping a M + b K. For an element whose law does not vary by itself
/// dV/dt = -P - D; a damper on deviations (C_d) takes P = -(C_d q')' w, of which q'' C_d q' is heat: its mean torque
/// is part of the load. Internal to core: users take channels.
#include <drev/core/element.hpp>
#include <drev/core/state.hpp>

#include <optional>
#include <vector>

namespace drev {

class Assembler;

class ElementEnergy {
 public:
  /// Of every element, in the order of System::element_instances().
  static std::vector<ElementEnergy> of_all(const System& system);

  bool exchanges() const { return stores() || dissipates() || has_loads(); }
  bool stores() const { return stiff_ || !scalars_.empty() || !generals_.empty(); }
  bool dissipates() const { return damped_ || !scalars_.empty() || !generals_.empty() || has_friction(); }
  bool moves() const { return heavy_; }
  bool has_friction() const { return !frictions_.empty(); }
  bool has_loads() const { return !loads_.empty(); }
  /// Place of a friction contact's own heat in State::history; -1: none.
  int friction_heat() const { return friction_heat_; }

  /// The assembler stands at the state's time.
  double power(const Assembler& assembler, const State& state) const;
  double dissipation(const Assembler& assembler, const State& state) const;
  double stored(const Assembler& assembler, const State& state) const;
  double kinetic(const Assembler& assembler, const State& state) const;
  /// dV/dt = q' K q' + the laws' y x' - their dissipated power [W]; none: a law varies by itself, or terms are general.
  std::optional<double> stored_rate(const Assembler& assembler, const State& state) const;

 private:
  struct Part {
    std::vector<int> nodes;
    Eigen::MatrixXd mass, damping, deviation_damping, stiffness;  // empty: none
  };
  struct Motion;  // q, q', w of a part's nodes
  const Motion& motion(const Part& part, const Assembler& assembler, const State& state) const;
  double actual_rate(int node, const Assembler& assembler, const State& state) const;
  double along(const std::vector<Entry>& nodes, const Assembler& assembler, const State& state) const;

  std::vector<Part> parts_;
  std::vector<int> scalars_, loads_, generals_, frictions_;  // places in the system's lists
  int friction_heat_ = -1;
  bool stiff_ = false, damped_ = false, heavy_ = false;
};

}  // namespace drev
