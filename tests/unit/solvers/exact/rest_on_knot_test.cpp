// Runs that begin at rest with a table's knot exactly at the angle of the start.
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>

#include <cmath>

#include "core/dense/eigenvalues.hpp"
#include "tests/catch.hpp"

using namespace drev;

TEST_CASE("Exact propagation leaves a table's knot from rest on the side to which the motion goes") {
  // Three cams at one node, each with its knot at 0: behind it the torque falls with another slope than ahead, where
  // the cams are springs to ground. The shaft brings the torque to their node, so that its angle grows with t^4.
  const double flywheel = 2.0, crank = 0.5, shaft = 1000.0, torque = 10.0;
  const double slopes[] = {30.0, 70.0, 400.0};
  Model m("rest on a knot");
  for (const char* node : {"flywheel", "crank"}) m.add_node(node);
  m.add<Inertia>("J1", {"flywheel"}, {.inertia = flywheel});
  m.add<Inertia>("J2", {"crank"}, {.inertia = crank});
  m.add<ShaftSpring>("shaft", {"flywheel", "crank"}, {.stiffness = shaft});
  m.add<AppliedTorque>("starter", {"flywheel"}, {.table = TimeTable({0.0}, {torque})});
  for (const double slope : slopes)
    m.add<CamTorque>("cam_" + std::to_string(static_cast<int>(slope)), {"crank"},
                     {.angle_table = PeriodicTable({0.0, 1.0, 5.0}, {0.0, -slope, 3.0 * slope}, kTwoPi)});
  const System system = m.build();
  State state = State::initial(system);
  const double end = 0.05;
  const RunSummary run = propagate(system, {.tolerance = 1e-12, .t_end = end}, state);
  INFO(run.brief_report());
  REQUIRE(run.ok());

  // Modal superposition: z = sum phi (phi' f)/omega^2 (1 - cos omega t).
  const double ground = slopes[0] + slopes[1] + slopes[2];
  const Eigen::MatrixXd k{{shaft, -shaft}, {-shaft, shaft + ground}}, mass{{flywheel, 0.0}, {0.0, crank}};
  const SymmetricEigen modes = symmetric_eigen(k, mass);
  Eigen::Vector2d expected = Eigen::Vector2d::Zero();
  for (int i = 0; i < 2; ++i) {
    const Eigen::Vector2d shape = modes.vectors.col(i);
    const double square = modes.values[i];
    expected += shape * shape[0] * torque / square * (1.0 - std::cos(std::sqrt(square) * end));
  }
  CHECK(state.z[0] == Approx(expected[0]).epsilon(1e-11));
  CHECK(state.z[1] == Approx(expected[1]).epsilon(1e-11));
}
