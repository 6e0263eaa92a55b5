// Cam, applied and engine order torques.
#include <drev/core/units.hpp>
#include <drev/elements/applied_torque.hpp>
#include <drev/elements/cam_torque.hpp>
#include <drev/elements/engine_order_torque.hpp>

#include <cmath>

#include "tests/catch.hpp"
#include "tests/unit/elements/checks.hpp"

using namespace drev;
using namespace drev::test;

TEST_CASE("loads are sound at random states") {
  const PeriodicTable table({0.0, 1.0, 1.5, 4.0}, {0.0, 30.0, -25.0, 0.0});
  for (const bool feedback : {true, false}) {
    CHECK(check_element(CamTorque({.angle_table = table, .phase = 0.7, .twist_feedback = feedback}), 1)
              .text() == "");
    CHECK(check_element(EngineOrderTorque({.harmonics = {{0.5, 10.0, 0.1}, {16, 3.0, -1.0}},
                                           .mean = 5.0,
                                           .twist_feedback = feedback}),
                        1)
              .text() == "");
  }
  CHECK(check_element(AppliedTorque({.torque = [](double t) { return std::sin(t); }}), 1).text() == "");
  CHECK(check_element(AppliedTorque({.table = TimeTable({0, 1, 1, 2}, {0, 1, 5, 3})}), 1).text() == "");
}

TEST_CASE("cam torque by hand") {
  const PeriodicTable table({0.0, 1.0, 2.0, 3.0}, {0.0, 10.0, 30.0, 0.0});
  const CamTorque cam({.angle_table = table, .phase = 0.25});
  // theta = 1.0 + 0.25 of phase + 0.5 of twist: 1.75, between 10 and 30.
  const LoadResponse r = cam.evaluate({.nominal_angle = 1.0, .deviation = 0.5});
  CHECK(r.torque == Approx(25.0));
  CHECK(r.dtorque_dangle == Approx(20.0));
  CHECK(cam.depends_on_motion());
  CHECK(cam.evaluate({.nominal_angle = 1.0 + 5 * kTwoPi, .deviation = 0.5}).torque == Approx(25.0));

  const CamTorque nominal({.angle_table = table, .phase = 0.25, .twist_feedback = false});
  const LoadResponse s = nominal.evaluate({.nominal_angle = 1.0, .deviation = 0.5});
  CHECK(s.torque == Approx(15.0));
  CHECK(s.dtorque_dangle == 0.0);
  CHECK_FALSE(nominal.depends_on_motion());
}

TEST_CASE("applied torque: function or table") {
  const AppliedTorque f({.torque = [](double t) { return 3.0 * t; }, .breakpoints = {2.0}});
  CHECK(f.evaluate({.t = 2.0}).torque == 6.0);
  CHECK(f.breakpoints() == std::vector<double>{2.0});
  const AppliedTorque table({.table = TimeTable({0, 1, 1}, {0, 4, 9})});
  CHECK(table.evaluate({.t = 0.5}).torque == Approx(2.0));
  CHECK(table.evaluate({.t = 1.0}).torque == 9.0);
  CHECK(table.breakpoints() == std::vector<double>{0.0, 1.0});
  CHECK_FALSE(f.depends_on_motion());
}

TEST_CASE("engine orders by hand") {
  // 100 + 10 cos(0.5 pi) + 4 cos(2 pi + pi/2) = 100; slope -0.5 * 10 - 2 * 4 = -13.
  const EngineOrderTorque e({.harmonics = {{0.5, 10.0, 0.0}, {2.0, 4.0, kPi / 2}}, .mean = 100.0});
  const LoadResponse r = e.evaluate({.nominal_angle = kPi - 0.1, .deviation = 0.1});
  CHECK(r.torque == Approx(100.0));
  CHECK(r.dtorque_dangle == Approx(-13.0));
}

TEST_CASE("loads: faults") {
  CHECK(contains(findings(AppliedTorque({})), "exactly one of torque, table and harmonics"));
  CHECK(
      contains(findings(AppliedTorque({.torque = [](double) { return 0.0; }, .table = TimeTable({0}, {1})})),
               "exactly one of torque, table and harmonics"));
  CHECK(contains(findings(AppliedTorque({.table = TimeTable({1, 0}, {1, 1})})), "table.times[1]"));
  CHECK(contains(findings(AppliedTorque({.torque = [](double) { return 0.0; }, .breakpoints = {NAN}})),
                 "breakpoints[0] = NaN s"));
  CHECK(contains(findings(CamTorque({})), "angle_table = 0 points"));
  CHECK(contains(findings(CamTorque({.angle_table = PeriodicTable({0, 1}, {0, 1}), .phase = NAN})),
                 "phase = NaN rad"));
  CHECK(contains(findings(EngineOrderTorque({.harmonics = {{0.0, 1.0, 0.0}}})),
                 "harmonics[0].order = 0, must be > 0"));
  CHECK(contains(findings(AppliedTorque({.harmonics = {{-40.0, 1.0, 0.0}}})),
                 "harmonics[0].frequency = -40 Hz, must be > 0"));
  CHECK(contains(findings(EngineOrderTorque({.mean = INFINITY})), "mean = infinity N m"));
}
