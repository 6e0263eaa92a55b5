// Passage through resonance: x'' + 2 zeta x' + x = sin(alpha t^2/2) from rest. Expected: Duhamel's
// integral in 12 digits; in the limit of slow passage F. M. Lewis' formula, Vibration during
// acceleration through a critical speed, Trans. ASME 54, 1932.
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/run/peaks.hpp>
#include <drev/solvers/run/recorder.hpp>

#include <cmath>

#include "tests/catch.hpp"

using namespace drev;

namespace {

/// A disc on a shaft whose other end runs up at alpha, with a first-order torque on the disc. The mean torque
/// carries the disc's own inertia along.
System run_up_model(double alpha, double zeta, double t_end) {
  Model m("run-up");
  m.add_node("drive");
  m.add_node("disc");
  m.add<Inertia>("J", {"disc"}, {.inertia = 1.0});
  m.add<ShaftSpring>("shaft", {"drive", "disc"}, {.stiffness = 1.0, .damping = 2.0 * zeta});
  m.add<EngineOrderTorque>("torque", {"disc"},
                           {.harmonics = {{1.0, 1.0, -kPi / 2}}, .mean = alpha, .twist_feedback = false});
  m.set_reference("drive", run_up(0.0, alpha * t_end, 0.0, t_end));
  m.hold("drive");
  return m.build();
}

struct Row {
  double alpha, zeta, largest, time;
};
constexpr Row kRows[] = {{1e-2, 0.0, 14.4408716847, 121.50229085},
                         {1e-2, .01, 12.0583966355, 118.47355518},
                         {1e-3, 0.0, 46.1545367197, 1067.87568156},
                         {1e-3, .01, 28.3317154526, 1055.46624279},
                         {1e-3, .05, 9.5902870219, 1027.59622152}};

}  // namespace

TEST_CASE("Run-up through resonance by exact propagation: largest deflection and its time") {
  for (const Row& row : kRows) {
    const double t_end = row.time + 20.0;
    const System system = run_up_model(row.alpha, row.zeta, t_end);
    // Stops between, so that the peaks inside steps are exact to 1e-9.
    Recorder stops(system, {"disc.angle_rad"}, 0.05);
    Peaks peaks(stops.channels(), true);
    const RunSummary run =
        propagate(system, {.tolerance = 1e-13, .t_end = t_end, .energy_tolerance = 1e-9}, {&stops, &peaks});
    INFO("alpha = " << row.alpha << ", zeta = " << row.zeta << "; " << run.brief_report());
    CHECK(run.ok());
    CHECK(peaks.peaks()[0].amplitude() == Approx(row.largest).epsilon(1e-7));
    CHECK(peaks.peaks()[0].time() == Approx(row.time).margin(1e-4));
  }
}

TEST_CASE("Run-up through resonance, undamped: Lewis' 1.467/sqrt(alpha)") {
  // max|x| sqrt(alpha) -> 1.46720370240527 at omega = 1 + 2.15742772685 sqrt(alpha), as alpha -> 0.
  for (const double alpha : {1e-2, 1e-3, 1e-4}) {
    const double time = (1.0 + 2.15742772685 * std::sqrt(alpha)) / alpha, t_end = time + 20.0;
    const System system = run_up_model(alpha, 0.0, t_end);
    Recorder stops(system, {"disc.angle_rad"}, 0.2);
    Peaks peaks(stops.channels(), true);
    CHECK(propagate(system, {.t_end = t_end}, {&stops, &peaks}).ok());
    const double gap = 1.46720370240527 - peaks.peaks()[0].amplitude() * std::sqrt(alpha);
    INFO("alpha = " << alpha << ": " << gap);
    CHECK(gap > 0.0);
    CHECK(gap < 0.27 * std::sqrt(alpha));
    CHECK(peaks.peaks()[0].time() == Approx(time).margin(kPi));
  }
}

TEST_CASE("Run-up through resonance by average acceleration: second order in the peak") {
  const Row& row = kRows[3];
  const double t_end = row.time + 20.0;
  const System system = run_up_model(row.alpha, row.zeta, t_end);
  double last = 0.0;
  for (const double h : {0.04, 0.02}) {
    Peaks peaks({find_channel(system, "disc.angle_rad")}, true);
    CHECK(run_method(system, {.step = h}, {.t_end = t_end}, {&peaks}).ok());
    const double error = std::abs(peaks.peaks()[0].amplitude() - row.largest);
    INFO("h = " << h << ": " << error);
    CHECK(error < 0.05);
    if (last > 0.0) CHECK(std::log2(last / error) == Approx(2.0).margin(0.2));
    last = error;
  }
}
