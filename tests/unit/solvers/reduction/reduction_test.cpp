// Reduced systems: closed forms of uniform chains, and the full system.
// Covers solvers/reduction/residual_vectors.hpp and craig_bampton.hpp through reduce().
#include <drev/core/assembler.hpp>
#include <drev/core/channel.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/models/ready_made.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/modes/modes.hpp>
#include <drev/solvers/periodic/periodic_response.hpp>
#include <drev/solvers/reduction/reduction.hpp>
#include <drev/solvers/run/peaks.hpp>
#include <drev/solvers/statics.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <cmath>

#include "tests/catch.hpp"

using namespace drev;

namespace {

constexpr double kInertia = 0.3, kStiffness = 2e5, kTorque = 40.0;
constexpr int kCount = 30;

/// n0 - n1 - ... - n(kCount - 1); held: n0 at rest, so that n1 ... are the unknowns.
Model chain(bool held) {
  Model m("chain");
  for (int i = 0; i < kCount; ++i) {
    const std::string node = "n" + std::to_string(i);
    m.add_node(node);
    m.add<Inertia>("J" + node, {node}, {.inertia = kInertia});
    if (i > 0) m.add<ShaftSpring>("k" + node, {"n" + std::to_string(i - 1), node}, {.stiffness = kStiffness});
  }
  if (held) m.constant_speed("n0", 0.0);
  m.add<AppliedTorque>("load", {"n" + std::to_string(kCount - 1)},
                       {.torque = [](double) { return kTorque; }});
  return m;
}

System camshaft(const std::string& drive, const std::string& loads = "actual") {
  Parameters s("camshaft", camshaft_entry().parameters);
  s.set("drive", drive);
  s.set("loads", loads);
  return camshaft_entry().build(s).model.build();
}

std::vector<std::string> names(const System& system) {
  std::vector<std::string> all;
  for (const Channel& c : all_channels(system)) all.push_back(c.name() + " " + c.unit());
  return all;
}

}  // namespace

TEST_CASE("Modal reduction keeps the modes of a free chain") {
  const System full = chain(false).build();
  const Reduction r = reduce(full, {.modes = 5});
  CHECK(r.modes == 5);
  CHECK(r.static_shapes == 1);
  CHECK(r.system.size() == 1 + 5 + 1);
  CHECK(r.system.mass_is_diagonal());
  CHECK(names(r.system) == names(full));
  const auto closed_form = [](int j) {
    return std::sqrt(kStiffness / kInertia) * std::sin(j * kPi / (2.0 * kCount)) / kPi;
  };
  const ModeSet modes = solve_modes(r.system, {.count = 5});
  CHECK(modes.rigid_modes == 1);
  for (int j = 1; j <= 5; ++j) {
    CHECK(modes.frequency_Hz[static_cast<std::size_t>(j - 1)] == Approx(closed_form(j)).epsilon(1e-10));
    // cos(j pi (i + 1/2)/n) at node i.
    const double end = modes.shapes(0, j - 1), other = modes.shapes(6, j - 1);
    CHECK(other / end ==
          Approx(std::cos(j * kPi * 6.5 / kCount) / std::cos(j * kPi * 0.5 / kCount)).epsilon(1e-8));
  }
  CHECK(r.first_left_out_Hz == Approx(closed_form(6)).epsilon(1e-10));
  CHECK(reduce(full, {.up_to_Hz = 0.5 * (closed_form(8) + closed_form(9))}).modes == 8);
}

TEST_CASE("Static correction: the deflection under a constant torque is exact") {
  const System full = chain(true).build();
  const auto deflection = [](const System& s, int node) {
    const StaticResult r = solve_static(s);
    return find_channel(s, "n" + std::to_string(node) + ".angle_rad").evaluate(Assembler(s), r.state);
  };
  const System with = reduce(full, {.modes = 3}).system;
  for (const int node : {1, 12, kCount - 1})
    CHECK(deflection(with, node) == Approx(node * kTorque / kStiffness).epsilon(1e-10));
  // Without: the first three modes' share. Mode j is sin(i theta) at node i, theta = (2j - 1) pi/(2N + 1), of
  // N unknowns, with J (2N + 1)/4 as its mass and omega^2 = 4 k/J sin^2(theta/2).
  const System without = reduce(full, {.modes = 3, .static_correction = false}).system;
  CHECK(without.size() == 3);
  const double share = deflection(without, kCount - 1) / ((kCount - 1) * kTorque / kStiffness);
  const int n = kCount - 1;
  double expected = 0.0;
  for (int j = 1; j <= 3; ++j) {
    const double theta = (2 * j - 1) * kPi / (2 * n + 1);
    expected += std::pow(std::sin(n * theta) / std::sin(0.5 * theta), 2) / (n * (2 * n + 1));
  }
  CHECK(share == Approx(expected).epsilon(1e-10));
  CHECK(share < 0.97);
}

TEST_CASE("Craig-Bampton: frequencies from above, the closer the more modes") {
  const System full = chain(true).build();
  const ModeSet exact = solve_modes(full, {.count = 3});
  double last[3] = {1e9, 1e9, 1e9};
  for (const int modes : {4, 8, 16}) {
    const Reduction r = reduce(full, {.kind = ReductionOptions::Kind::craig_bampton,
                                      .modes = modes,
                                      .keep = {"n15", "n" + std::to_string(kCount - 1)}});
    CHECK(r.system.size() == 2 + modes);
    CHECK(names(r.system) == names(full));
    CHECK(r.system.node_map(r.system.node("n15")).unknown >= 0);
    const ModeSet found = solve_modes(r.system, {.count = 3});
    for (std::size_t j = 0; j < 3; ++j) {
      const double error = found.frequency_Hz[j] / exact.frequency_Hz[j] - 1.0;
      INFO(modes << " modes, frequency " << j << ": " << error);
      CHECK(error > -1e-12);
      CHECK(error < 0.25 * last[j]);
      last[j] = error;
    }
  }
  CHECK(last[0] < 1e-5);
}

TEST_CASE("All modes kept: the same motion in other coordinates") {
  for (const std::string drive : {"held", "gears", "free"}) {
    const System full = camshaft(drive);
    const Reduction r = reduce(full, {.modes = full.size()});
    CHECK(r.system.size() == full.size());
    const double end = 0.02;
    State a = State::initial(full), b = State::initial(r.system);
    const RunSummary run_full = propagate(full, {.t_end = end}, a);
    const RunSummary run = propagate(r.system, {.t_end = end}, b);
    INFO(drive << "\n" << run_full.brief_report() << "\n" << run.brief_report());
    CHECK(run.ok());
    CHECK(run.contact_changes == run_full.contact_changes);
    CHECK(((r.basis * b.z) - a.z).lpNorm<Eigen::Infinity>() < 1e-8 * a.z.lpNorm<Eigen::Infinity>());
    CHECK(run.energy.input == Approx(run_full.energy.input).epsilon(1e-7));
    // A stepping method, with the same steps in both.
    State c = State::initial(full), d = State::initial(r.system);
    const TransientOptions steps{.step = 1e-5, .t_end = end};
    CHECK(simulate(full, steps, c).ok());
    CHECK(simulate(r.system, steps, d).ok());
    CHECK(((r.basis * d.z) - c.z).lpNorm<Eigen::Infinity>() < 1e-6 * c.z.lpNorm<Eigen::Infinity>());
  }
}

TEST_CASE("All modes kept: the same periodic response", "[once]") {
  const System full = camshaft("held");
  const PeriodicOptions options{.tolerance = 1e-5, .channels = {"inlet_9-fuel_1.twist_rad"}};
  const PeriodicResponse a = solve_periodic(full, options);
  const PeriodicResponse b = solve_periodic(reduce(full, {.modes = full.size()}).system, options);
  INFO(a.reason << b.reason);
  REQUIRE(a.found);
  REQUIRE(b.found);
  CHECK(b.peaks[0].max == Approx(a.peaks[0].max).epsilon(1e-6));
  CHECK(b.peaks[0].min == Approx(a.peaks[0].min).epsilon(1e-6));
}

TEST_CASE("Camshaft with gear drive, reduced: mesh forces and torques of the full model") {
  const System full = camshaft("gears");
  const std::vector<std::string> channels{"mesh_1.force_N", "mesh_2.force_N", "inlet_9-fuel_1.twist_rad"};
  const auto peaks = [&](const System& s) {
    Peaks watch(find_channels(s, channels), true);
    const RunSummary run = propagate(s, {.t_end = 0.05}, {&watch});
    INFO(run.brief_report());
    CHECK(run.ok());
    return watch.peaks();
  };
  const std::vector<Peak> exact = peaks(full);
  for (const auto kind : {ReductionOptions::Kind::modal, ReductionOptions::Kind::craig_bampton}) {
    const Reduction r = reduce(full, {.kind = kind, .modes = 12});
    INFO(r.what);
    CHECK(r.system.size() < full.size());
    const std::vector<Peak> reduced = peaks(r.system);
    for (std::size_t c = 0; c < channels.size(); ++c) {
      INFO(channels[c] << ": " << reduced[c].amplitude() << ", full " << exact[c].amplitude());
      CHECK(reduced[c].amplitude() == Approx(exact[c].amplitude()).epsilon(0.02));
    }
  }
}

TEST_CASE("Reduction refuses what it cannot do") {
  const System full = chain(false).build();
  CHECK_THROWS_AS(reduce(full, {}), ModelError);
  CHECK_THROWS_AS(reduce(full, {.modes = 3, .up_to_Hz = 100.0}), ModelError);
  CHECK_THROWS_AS(reduce(full, {.modes = 3, .keep = {"n1"}}), ModelError);
  CHECK_THROWS_AS(reduce(full, {.kind = ReductionOptions::Kind::craig_bampton, .modes = 3}), SolverError);
  CHECK_THROWS_AS(reduce(full, {.kind = ReductionOptions::Kind::craig_bampton, .keep = {"n99"}}), ModelError);
  const Reduction r = reduce(full, {.modes = 3});
  CHECK_THROWS_AS(reduce(r.system, {.modes = 2}), ModelError);
}
