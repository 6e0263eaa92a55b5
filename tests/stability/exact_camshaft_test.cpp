// Exact propagation of the camshaft against an independent integration that knows nothing of knots
// and pieces (Runge-Kutta, small steps), and against itself at a tighter tolerance.
#include <drev/core/system.hpp>
#include <drev/models/ready_made.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/run/contact_statistics.hpp>
#include <drev/solvers/run/peaks.hpp>

#include <cmath>

#include "tests/catch.hpp"
#include "tests/stability/runge_kutta.hpp"

using namespace drev;

namespace {

System camshaft(const std::string& drive, const std::string& loads, const std::string& damping) {
  Parameters s("camshaft", camshaft_entry().parameters);
  s.set("drive", drive);
  s.set("loads", loads);
  s.set("damping", damping);
  return camshaft_entry().build(s).model.build();
}

double largest_difference(const Vector& a, const Vector& b) { return (a - b).lpNorm<Eigen::Infinity>(); }

}  // namespace

TEST_CASE("Exact propagation, camshaft held: 1e-7 of the peak and better") {
  // Runge-Kutta at 1e-6 s: (omega h)^4/120 a step for the fastest mode at 1.9 kHz; a knot unseen by
  // a step leaves some 1e-12 of the motion.
  for (const std::string loads : {"source", "actual"})
    for (const std::string damping : {"case_1", "case_2"}) {
      INFO(loads << ", " << damping);
      const System system = camshaft("held", loads, damping);
      State exact = State::initial(system), tight = exact, fine = exact, coarse = exact;
      const double end = 0.2;
      const RunSummary run = propagate(system, {.t_end = end, .energy_tolerance = 1e-10}, exact);
      INFO(run.brief_report());
      CHECK(run.ok());
      CHECK(propagate(system, {.tolerance = 1e-14, .t_end = end}, tight).ok());
      runge_kutta(system, end, 1e-6, fine);
      runge_kutta(system, end, 2e-6, coarse);
      const double peak = exact.z.lpNorm<Eigen::Infinity>();
      INFO(loads << " " << damping << ": Runge-Kutta 2e-6, 1e-6, tolerance 1e-14 differ by "
                 << largest_difference(exact.z, coarse.z) / peak << ", "
                 << largest_difference(exact.z, fine.z) / peak << ", "
                 << largest_difference(exact.z, tight.z) / peak);
      CHECK(largest_difference(exact.z, fine.z) < 1e-8 * peak);
      CHECK(largest_difference(exact.z, tight.z) < 1e-10 * peak);
      // The independent integration approaches the exact one.
      CHECK(largest_difference(exact.z, fine.z) < largest_difference(exact.z, coarse.z));
    }
}

TEST_CASE("Exact propagation, camshaft with gear drive: as far as the trajectory is comparable") {
  const System system = camshaft("gears", "actual", "case_1");
  const double end = 0.05;
  State exact = State::initial(system), tight = exact, fine = exact, stepped = exact;
  ContactStatistics contacts(system), stepped_contacts(system);
  const RunSummary run = propagate(system, {.t_end = end, .energy_tolerance = 1e-10}, exact, {&contacts});
  INFO(run.brief_report());
  CHECK(run.ok());
  CHECK(run.contact_changes > 10);
  CHECK(propagate(system, {.tolerance = 1e-14, .t_end = end}, tight).ok());
  runge_kutta(system, end, 2.5e-7, fine);
  CHECK(run_method(system, {.step = 1e-6}, {.t_end = end}, stepped, {&stepped_contacts}).ok());
  const double peak = exact.z.lpNorm<Eigen::Infinity>();
  INFO("gears: Runge-Kutta 2.5e-7, average acceleration 1e-6, tolerance 1e-14 differ by "
       << largest_difference(exact.z, fine.z) / peak << ", " << largest_difference(exact.z, stepped.z) / peak
       << ", " << largest_difference(exact.z, tight.z) / peak);
  CHECK(largest_difference(exact.z, tight.z) < 1e-8 * peak);
  CHECK(largest_difference(exact.z, fine.z) < 1e-6 * peak);
  CHECK(largest_difference(exact.z, stepped.z) < 1e-3 * peak);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(contacts.records()[i].front_impacts == stepped_contacts.records()[i].front_impacts);
    CHECK(contacts.records()[i].back_impacts == stepped_contacts.records()[i].back_impacts);
  }
}
