#include "solvers/stepping/stepper.hpp"

#include <array>
#include <cmath>

#include "solvers/stepping/generalized_alpha.hpp"
#include "solvers/stepping/runge_kutta.hpp"
#include "solvers/stepping/step_polynomial.hpp"

namespace drev {

void Stepper::start(EvaluatedState& point) {
  equation_.assembler().set_time(point.state.t);
  equation_.evaluate(point.state.history, point);
  equation_.acceleration(point.total, point.state.a);
  point.a_step = 0.0;
  equation_.start_from(point);
  equation_.update_scale(point);
}

void Stepper::estimate_by_quadrature(const EvaluatedState& from, const EvaluatedState& to, double h,
                                     Vector& e_z, Vector& e_v) {
  struct Node {
    double s, weight;
  };
  static const std::array<Node, 1> simpson{{{0.5, 4.0 / 6}}};
  static const std::array<Node, 2> lobatto{
      {{0.5 - 0.5 / std::sqrt(5.0), 5.0 / 12}, {0.5 + 0.5 / std::sqrt(5.0), 5.0 / 12}}};
  const bool high = equation_.scheme().order() > 2;
  const double end_weight = high ? 1.0 / 12 : 1.0 / 6;
  // Accelerations that satisfy the equation of motion; those of generalized-alpha are of another time.
  const StepScheme& scheme = equation_.scheme();
  const bool own = scheme.alpha_m == 0.0 && scheme.alpha_f == 0.0;
  const auto acceleration = [&](const EvaluatedState& point) -> const Vector& {
    if (own) return point.state.a;
    equation_.acceleration(point.total, a_);
    return a_;
  };
  const Vector& a_0 = acceleration(from);
  e_v = to.state.v - from.state.v - (h * end_weight) * a_0;
  e_z = to.state.z - from.state.z - h * from.state.v - (h * h * end_weight) * a_0;
  e_v -= (h * end_weight) * acceleration(to);
  const StepPolynomial motion(from.state, to.state, h, StepPolynomial::degree_for(equation_.scheme()));
  const auto add = [&](const Node& node) {
    motion.at(node.s, inside_.state);
    equation_.assembler().set_time(inside_.state.t);
    equation_.evaluate(from.state.history, inside_);
    equation_.acceleration(inside_.total, a_);
    e_v -= (h * node.weight) * a_;
    e_z -= (h * h * node.weight * (1.0 - node.s)) * a_;
  };
  if (high)
    for (const Node& node : lobatto) add(node);
  else
    for (const Node& node : simpson) add(node);
}

std::unique_ptr<Stepper> make_stepper(const System& system, const StepScheme& scheme,
                                      const StepOptions& options) {
  if (scheme.tableau) return std::make_unique<RungeKutta>(system, scheme, options);
  return std::make_unique<GeneralizedAlpha>(system, scheme, options);
}

}  // namespace drev
