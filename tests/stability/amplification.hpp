#pragma once
/// One step of a method on z'' + 2 xi z' + z = 0 as a matrix, measured by running it:
///
///   (z, v/s, a)_1 = A (z, v/s, a)_0,   s = max(1, omega h)
///
/// Methods that carry no acceleration of their own from step to step (it follows from z and v) have a
/// 2 x 2 matrix over (z, v/s).
#include <Eigen/Dense>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "core/units.hpp"
#include "elements/ground_spring.hpp"
#include "elements/inertia.hpp"
#include "solvers/transient.hpp"

namespace drev::problems {

/// J = 1, k = 1: omega = 1, so that the step is omega h.
inline System unit_frequency(double xi) {
  Model m("unit frequency");
  m.add_node("disc");
  m.add<Inertia>("J", {"disc"}, {.inertia = 1.0});
  m.add<GroundSpring>("k", {"disc"}, {.stiffness = 1.0, .damping = 2.0 * xi});
  return m.build();
}

/// (z, v, a) after 0, 1 ... count steps of h.
inline std::vector<Eigen::Vector3d> run_steps(const System& system, const std::string& method,
                                              double h, double z, double v, int count) {
  class Keep final : public Observer {
   public:
    void start(const Assembler&, const StepPoint& p) override { keep(p); }
    void step(const Assembler&, const StepPoint&, const StepPoint& to) override { keep(to); }
    std::vector<Eigen::Vector3d> states;

   private:
    void keep(const StepPoint& p) { states.emplace_back(p.state.z[0], p.state.v[0], p.state.a[0]); }
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

/// omega h and xi -> A.
inline Eigen::MatrixXd amplification(const std::string& method, double omega_h, double xi = 0.0) {
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

inline double spectral_radius(const Eigen::MatrixXd& a) {
  return a.eigenvalues().cwiseAbs().maxCoeff();
}

/// Period elongation (T' - T)/T and amplitude decay per period T' of the principal pair of roots.
struct Distortion {
  double elongation, decay;
};
inline Distortion distortion(const std::string& method, double step_per_period) {
  const double omega_h = kTwoPi * step_per_period;
  std::complex<double> root = 0.0;
  for (const std::complex<double>& r : amplification(method, omega_h).eigenvalues())
    if (r.imag() > 0.0) root = r;
  const double phi = std::arg(root);
  return {omega_h / phi - 1.0, 1.0 - std::pow(std::abs(root), kTwoPi / phi)};
}

}  // namespace drev::problems
