// The held camshaft's transient against a separate program: average acceleration at three steps, the
// source's loads (no feedback of the twist), from rest with consistent acceleration, 0 to 5 s at 375 rpm.
// Tolerance 0.2 %: the targets are printed to 5 to 6 digits; undamped runs amplify rounding.
#include <drev/core/system.hpp>
#include <drev/core/units.hpp>
#include <drev/models/ready_made.hpp>
#include <drev/solvers/run/peaks.hpp>
#include <drev/solvers/statics.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include "tests/catch.hpp"
#include "tests/published/read_csv.hpp"

using namespace drev;

TEST_CASE("Held camshaft, transient: all 36 targets of a separate program to 0.2 %") {
  const auto rows = read_csv("camshaft_transient_targets.csv");
  REQUIRE(rows.size() == 36);
  for (const auto& row : rows) {
    Parameters parameters("camshaft", camshaft_entry().parameters);
    parameters.set("cylinders", row[0]);
    parameters.set("damping", row[1]);
    parameters.set("drive", "held");
    parameters.set("loads", "source");
    const ModelCase model_case = camshaft_entry().build(parameters);
    const System system = model_case.model.build();
    Peaks deflection(find_channels(system, {model_case.deflection}), false);
    Peaks torque(find_channels(system, model_case.torques), false);
    const RunSummary run =
        simulate(system, {.step = std::stod(row[2]), .t_end = model_case.duration}, {&deflection, &torque});
    INFO(row[0] << " cylinders, " << row[1] << ", h = " << row[2]);
    CHECK(run.status != RunStatus::unstable);
    CHECK(to_deg(deflection.peaks()[0].amplitude()) == Approx(std::stod(row[3])).epsilon(2e-3));
    const double largest = torque.peaks()[torque.largest()].amplitude();
    CHECK(largest == Approx(std::stod(row[4])).epsilon(2e-3));
    double static_torque = 0.0;
    for (const Peak& p : static_sweep(system, find_channels(system, model_case.torques), 0.0, kTwoPi, 1440))
      static_torque = std::max(static_torque, p.amplitude());
    CHECK(static_torque == Approx(std::stod(row[6])).epsilon(2e-3));
    CHECK(largest / static_torque == Approx(std::stod(row[5])).epsilon(4e-3));
  }
}
