// A reduction that is tried before it is used: its channels beside the full model's by another method, and
// what is refused.
#include <drev/solvers/reduction/reduction_choice.hpp>
#include <drev/solvers/run/recorder.hpp>

#include <algorithm>
#include <cmath>

#include "tests/catch.hpp"
#include "tests/problems/long_shafts.hpp"

using namespace drev;

namespace {

constexpr double kEnd = 0.1;  // s

System train(bool mesh, double omega) { return problems::long_shafts(40, mesh, omega); }

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Torque of every segment and some motions.
std::vector<std::string> channels(const System& system) {
  std::vector<std::string> names{"a.angle_rad", "d.speed_rad_per_s", "a-d.twist_rad"};
  for (const Channel& c : all_channels(system))
    if (c.name().starts_with("s1_") && c.name().ends_with(".torque_Nm")) names.push_back(c.name());
  return names;
}

TrialOptions options(const System& system, double within) {
  return {.within = within,
          .channels = channels(system),
          .duration = kEnd,
          .method = {.name = "exact", .tolerance = 1e-10}};
}

}  // namespace

TEST_CASE("Reduction trial: every channel is within its error of the full model by implicit steps") {
  const System full = train(false, 200.0);
  for (const double within : {2e-2, 1e-2}) {
    const ReductionTrial trial = try_reduction(full, options(full, within));
    INFO(within << ": " << trial.reason);
    REQUIRE(trial.reduction);
    CHECK(trial.reduction->system.size() < full.size() / 2);
    REQUIRE(trial.error);
    CHECK(*trial.error <= within);
    const std::vector<std::string> names = channels(full);
    REQUIRE(names.size() > 40);
    Recorder exact(full, names, 1e-4), reduced(trial.reduction->system, names, 1e-4);
    CHECK(run_method(full, {.name = "average_acceleration", .step = 2e-6}, {.t_end = kEnd}, {&exact}).ok());
    CHECK(run_method(trial.reduction->system, trial.method, {.t_end = kEnd}, {&reduced}).ok());
    for (std::size_t c = 0; c < names.size(); ++c) {
      double error = 0.0, peak = 0.0;
      for (std::size_t i = 0; i < exact.times().size(); ++i) {
        error = std::max(error, std::abs(exact.samples(c)[i] - reduced.samples(c)[i]));
        peak = std::max(peak, std::abs(exact.samples(c)[i]));
      }
      INFO(names[c] << ": " << error / peak);
      CHECK(error <= *trial.error * peak);
    }
  }
}

TEST_CASE("Reduction trial: refused are loads at high modes, contacts that part, and what has no estimate") {
  const auto reason = [](const System& system, const TrialOptions& o) {
    const ReductionTrial trial = try_reduction(system, o);
    CHECK(!trial.reduction);
    CHECK(trial.reason.starts_with("not reduced: "));
    return trial.reason;
  };
  // 24 kHz: above half of the modes.
  const System shrill = train(false, 1.5e5);
  CHECK(contains(reason(shrill, options(shrill, 1e-3)), "modes would be needed"));
  // The mesh rattles at once: differences grow.
  const System rattle = train(true, 200.0);
  CHECK(contains(reason(rattle, options(rattle, 1e-2)), "grows"));
  const System calm = train(false, 200.0);
  TrialOptions o = options(calm, 1e-2);
  o.channels = {"a.acceleration_rad_per_s2"};
  CHECK(contains(reason(calm, o), "a.acceleration_rad_per_s2"));
}
