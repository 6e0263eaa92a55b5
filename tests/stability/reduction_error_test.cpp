// The estimate of a reduced run's error against the full system, by exact propagation of both.
#include <drev/core/channel.hpp>
#include <drev/models/ready_made.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/reduction/reduction_choice.hpp>
#include <drev/solvers/run/recorder.hpp>

#include <cmath>

#include "solvers/reduction/truncation_error.hpp"
#include "tests/catch.hpp"
#include "tests/problems/long_shafts.hpp"
#include "tests/stability/random_model.hpp"

using namespace drev;

namespace {

struct Drive {
  System system;
  double t_end;
};

/// A chain of 25 to 84 inertias with loads that swing slowly beside its fastest modes; with gaps: stops to
/// ground that it runs into.
Drive make_drive(unsigned seed, bool gaps) {
  Random random(seed);
  Model m("drive " + std::to_string(seed));
  const int n = 25 + random.below(60);
  const auto node = [](int i) { return "n" + std::to_string(i); };
  const double k = 1e5, j = 0.1;
  for (int i = 0; i < n; ++i) {
    m.add_node(node(i));
    m.add<Inertia>("J" + std::to_string(i), {node(i)}, {.inertia = j * random(0.5, 2.0)});
    if (i > 0)
      m.add<ShaftSpring>("k" + std::to_string(i), {node(i - 1), node(i)},
                         {.stiffness = k * random(0.5, 2.0), .damping = random(0.0, 1.0)});
  }
  if (random.below(2)) m.add<GroundSpring>("ground", {node(0)}, {.stiffness = k});
  const double slow = std::sqrt(k / j) / n;  // about the first mode's
  for (int l = 0; l < 3; ++l) {
    const double torque = random(-100.0, 100.0), rate = slow * random(0.3, 3.0), phase = random(0.0, 6.0);
    m.add<AppliedTorque>("load" + std::to_string(l), {node(random.below(n))},
                         {.torque = [=](double t) { return torque * std::sin(rate * t + phase); }});
  }
  if (gaps)
    for (int g = 0; g < 2; ++g)
      m.add<PolylineSpring>("stop" + std::to_string(g), {node(random.below(n))},
                            PolylineSpring::dead_band(0.3 * k, 1e-3));
  return {m.build(), 12.0 / slow};
}

}  // namespace

TEST_CASE("Estimate of a reduced run's error: above the true one, and of its size") {
  for (const bool gaps : {false, true}) {
    double least = 1e300, most = 0.0;
    for (unsigned seed = 1; seed <= 25; ++seed) {
      const Drive d = make_drive(seed, gaps);
      const std::vector<std::string> channels{"n0.angle_rad", "k3.torque_Nm", "k12.torque_Nm",
                                              "n20.speed_rad_per_s"};
      const Reduction r = reduce(d.system, {.modes = 8});
      TruncationError watch(d.system, r, channels);
      Recorder full(d.system, channels, d.t_end / 4000), reduced(r.system, channels, d.t_end / 4000);
      const ExactOptions options{.tolerance = 1e-10, .t_end = d.t_end};
      const RunSummary run_full = propagate(d.system, options, {&full});
      const RunSummary run = propagate(r.system, options, {&reduced, &watch});
      INFO("seed " << seed << (gaps ? " with stops: " : ": ") << r.what << "\n" << run.brief_report());
      CHECK(run_full.ok());
      CHECK(run.ok());
      const auto estimates = watch.estimates();
      for (std::size_t c = 0; c < channels.size(); ++c) {
        double error = 0.0;
        for (std::size_t i = 0; i < full.times().size(); ++i)
          error = std::max(error, std::abs(full.samples(c)[i] - reduced.samples(c)[i]));
        const double ratio = estimates[c].error / error;
        least = std::min(least, ratio);
        most = std::max(most, ratio);
        INFO(channels[c] << ": true " << error << ", estimate " << estimates[c].error << " of "
                         << estimates[c].value);
        CHECK(ratio >= 1.0);
      }
    }
    // Measured: 1.3 to 2.6 linear, 1.5 to 21 with stops, where one that is hardly touched speaks for all.
    INFO((gaps ? "with stops: " : "linear: ") << "estimate over true error " << least << " to " << most);
    CHECK(most < (gaps ? 30.0 : 5.0));
  }
}

TEST_CASE("A reduction is chosen where it pays, with the accuracy asked for") {
  // Two shafts in 50 segments each: the fastest of 102 unknowns at 10 kHz, loads below 100 Hz.
  for (const bool mesh : {false, true}) {
    const System full = problems::long_shafts(50, mesh, 200.0);
    const std::vector<std::string> channels{mesh ? "mesh.force_N" : "mesh.torque_Nm", "s1_20.torque_Nm"};
    const double end = 0.1, within = 0.02;
    const ReductionChoice choice = choose_reduction(full, within, channels, end);
    INFO(choice.reason);
    REQUIRE(choice.reduction);
    CHECK(choice.gain > 3.0);
    CHECK(choice.error <= 1.5 * within);
    Recorder exact(full, channels, 1e-4), reduced(choice.reduction->system, channels, 1e-4);
    const RunSummary run_full = propagate(full, {.t_end = end}, {&exact});
    const RunSummary run = propagate(choice.reduction->system, {.t_end = end}, {&reduced});
    CHECK(run_full.ok());
    CHECK(run.ok());
    // Steps go with the fastest mode.
    CHECK(run.steps < run_full.steps / 3);
    for (std::size_t c = 0; c < channels.size(); ++c) {
      double error = 0.0, peak = 0.0;
      for (std::size_t i = 0; i < exact.times().size(); ++i) {
        error = std::max(error, std::abs(exact.samples(c)[i] - reduced.samples(c)[i]));
        peak = std::max(peak, std::abs(exact.samples(c)[i]));
      }
      INFO(channels[c] << ": " << error / peak);
      CHECK(error <= within * peak);
    }
  }
  // 39 unknowns, loads on 27 of them, and stiff meshes: nothing to gain.
  Parameters s("camshaft", camshaft_entry().parameters);
  s.set("drive", "gears");
  const ReductionChoice none =
      choose_reduction(camshaft_entry().build(s).model.build(), 0.01, {"mesh_1.force_N"}, 1.0);
  INFO(none.reason);
  CHECK(!none.reduction);
  CHECK(none.reason.starts_with("not reduced: "));
}
