#include "tests/stability/amplification.hpp"

#include <drev/core/assembler.hpp>
#include <drev/elements/ground_spring.hpp>
#include <drev/elements/inertia.hpp>
#include <drev/solvers/run/evaluated_state.hpp>
#include <drev/solvers/run/observer.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace drev::problems {

System unit_frequency(double xi) {
  Model m("unit frequency");
  m.add_node("disc");
  m.add<Inertia>("J", {"disc"}, {.inertia = 1.0});
  m.add<GroundSpring>("k", {"disc"}, {.stiffness = 1.0, .damping = 2.0 * xi});
  return m.build();
}

std::vector<Eigen::Vector3d> run_steps(const System& system, const std::string& method, double h, double z,
                                       double v, int count) {
  class Keep final : public Observer {
   public:
    void start(const Assembler&, const EvaluatedState& p) override { keep(p); }
    void step(const Assembler&, const EvaluatedState&, const EvaluatedState& to) override { keep(to); }
    std::vector<Eigen::Vector3d> states;

   private:
    void keep(const EvaluatedState& p) { states.emplace_back(p.state.z[0], p.state.v[0], p.state.a[0]); }
  } keep;
  State state = State::initial(system);
  state.z[0] = z;
  state.v[0] = v;
  simulate(system,
           {.scheme = step_scheme(method),
            .step = h,
            .t_end = count * h,
            .energy_tolerance = 1e300,
            .energy_growth_limit = 1e300},
           state, {&keep});
  return keep.states;
}

Eigen::MatrixXd amplification(const std::string& method, double omega_h, double xi) {
  const System system = unit_frequency(xi);
  // Of the order of one at every step: v over omega h where the steps are long.
  const double speed = std::max(1.0, omega_h);
  const auto a = run_steps(system, method, omega_h, 1.0, 0.0, 2);
  const auto b = run_steps(system, method, omega_h, 0.0, speed, 2);
  Eigen::Matrix<double, 3, 4> from, to;
  from << a[0], b[0], a[1], b[1];
  to << a[1], b[1], a[2], b[2];
  from.row(1) /= speed;
  to.row(1) /= speed;
  Eigen::CompleteOrthogonalDecomposition<Eigen::Matrix<double, 3, 4>> all(from);
  all.setThreshold(1e-7);
  if (all.rank() < 3) return to.topLeftCorner<2, 2>();
  return to * all.pseudoInverse();
}

std::vector<std::complex<double>> roots(const Eigen::MatrixXd& a) {
  const Eigen::VectorXcd values = general_eigen(a).values;
  return {values.begin(), values.end()};
}

Distortion distortion(const std::string& method, double step_per_period) {
  const double omega_h = kTwoPi * step_per_period;
  std::complex<double> root = 0.0;
  for (const std::complex<double>& r : roots(amplification(method, omega_h)))
    if (r.imag() > 0.0) root = r;
  const double phi = std::arg(root);
  return {omega_h / phi - 1.0, 1.0 - std::pow(std::abs(root), kTwoPi / phi)};
}

}  // namespace drev::problems
