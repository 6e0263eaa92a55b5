// Sweeps of nonlinear models: branches, folds, stability, tongues, runs, free trains. Expected values come from
// programs that put closed-form pieces together (shooting, saltation), to 1e-10.
// Covers solvers/periodic/law_balance.hpp, mean_equilibrium.hpp, motion_sections.hpp, section_rows.hpp,
// branch_tracer.hpp, floquet.hpp and motion_figures.hpp through sweep_nonlinear(), and
// solvers/at_speed.hpp.
#include <drev/core/error.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/nonlinear_sweep.hpp>
#include <drev/solvers/strength/class_judgement.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <fstream>
#include <set>
#include <sstream>

#include "solvers/at_speed.hpp"
#include "tests/catch.hpp"

using namespace drev;

namespace {

/// x'' + c x' + k(t) dz(x) = mean + error w^2 cos w t, half gap 1, x = wheel - error cos w t.
struct Pair {
  double damping = 0.1, mean = 0.1, error = 0.05, backlash = 2.0;
  MeshStiffness stiffness = 1.0;

  GearMesh::Params mesh() const {
    GearMesh::Params p{.base_radius_1 = 1.0,
                       .base_radius_2 = 1.0,
                       .teeth_1 = 1,
                       .teeth_2 = 1,
                       .stiffness = stiffness,
                       .normal_backlash = backlash,
                       .damping = damping,
                       .damping_law = MeshDamping::always};
    if (error != 0.0) p.transmission_error = std::vector<Harmonic>{{1.0, error, 0.0}};
    return p;
  }
  System build() const {
    Model m("gear pair");
    m.add_node("pinion");
    m.add_node("wheel");
    m.add<Inertia>("J", {"wheel"}, {.inertia = 1.0});
    m.add<GearMesh>("mesh", {"pinion", "wheel"}, mesh());
    m.add<EngineOrderTorque>("torque", {"wheel"}, {.mean = mean, .twist_feedback = false});
    m.constant_speed("pinion", 1.0);
    return m.build();
  }
  /// The same relative motion of two free inertias 2, torques `driving` and `mean`.
  System free(double driving) const {
    Model m("free pair");
    m.add_node("pinion");
    m.add_node("wheel");
    m.add<Inertia>("J_1", {"pinion"}, {.inertia = 2.0});
    m.add<Inertia>("J_2", {"wheel"}, {.inertia = 2.0});
    m.add<GearMesh>("mesh", {"pinion", "wheel"}, mesh());
    m.add<EngineOrderTorque>("engine", {"pinion"}, {.mean = driving, .twist_feedback = false});
    m.add<EngineOrderTorque>("torque", {"wheel"}, {.mean = mean, .twist_feedback = false});
    m.set_reference("pinion", constant_speed(1.0));
    return m.build();
  }
};

std::vector<double> even(double low, double high, int count) {
  std::vector<double> all;
  for (int i = 0; i < count; ++i) all.push_back(low + (high - low) * i / (count - 1));
  return all;
}

std::vector<SweptChange> changes_of(const NonlinearSweep& sweep, BranchChange kind) {
  std::vector<SweptChange> found;
  for (const SweptChange& change : sweep.changes)
    if (change.kind == kind) found.push_back(change);
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.speed < b.speed; });
  return found;
}

/// A motion of a branch by another program: speed, deflection and its rate where phi = 0, largest |multiplier|, extremes of
/// samples of the deflection.
struct BranchRow {
  double speed, x, v, multiplier, low, high;
};

/// Rows of a table between two speeds: the first, and each that stands `every` rows after one.
std::vector<BranchRow> branch_rows(const std::string& name, int every, double from, double to) {
  std::vector<BranchRow> rows;
  std::ifstream file(DREV_SOURCE_DIR "/tests/published/data/" + name);
  std::string line;
  std::getline(file, line);
  for (int i = 0; std::getline(file, line); ++i) {
    if (i % every != 0) continue;
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    BranchRow row{};
    std::string contact;
    words >> row.speed >> row.x >> row.v >> row.multiplier >> contact >> row.low >> row.high;
    if (row.speed >= from && row.speed <= to) rows.push_back(row);
  }
  return rows;
}

/// Motions at a speed that was asked for.
std::vector<SweptMotion> motions_at(const NonlinearSweep& sweep, double speed) {
  std::vector<SweptMotion> found;
  for (const SweptBranch& branch : sweep.branches)
    for (const SweptMotion& motion : branch.motions)
      if (motion.asked && std::abs(motion.speed - speed) < 1e-12) found.push_back(motion);
  return found;
}

}  // namespace

TEST_CASE("Gear pair with backlash: a whole branch, its folds to 8 digits, stability",
          "[nonlinear_sweep][once]") {
  const std::vector<BranchRow> rows = branch_rows("gear_pair_branch.csv", 6, 0.62, 1.58);
  std::set<double> speeds{0.62, 1.58};
  for (const BranchRow& row : rows) speeds.insert(row.speed);
  REQUIRE(rows.size() > 25);
  const NonlinearSweep sweep =
      sweep_nonlinear(Pair{}.build(), {.speeds = {speeds.begin(), speeds.end()}, .tolerance = 1e-5});
  CHECK(sweep.turns == 1.0);
  CHECK(sweep.unsolved.empty());
  REQUIRE(sweep.branches.size() == 1);
  CHECK(sweep.branches[0].whole);
  int unstable = 0;
  for (const BranchRow& row : rows) {
    INFO("w = " << row.speed << ", x = " << row.x);
    const SweptMotion* nearest = nullptr;
    const std::vector<SweptMotion> here = motions_at(sweep, row.speed);
    for (const SweptMotion& motion : here)
      if (nearest == nullptr || std::abs(motion.z[0] - 0.05 - row.x) < std::abs(nearest->z[0] - 0.05 - row.x))
        nearest = &motion;
    REQUIRE(nearest != nullptr);
    // Stated errors hold: of the mesh force, here as large as the penetration. The table has 11 digits.
    const double error = nearest->error * std::max(nearest->maximum[0], -nearest->minimum[0]) + 2e-10;
    CHECK(nearest->error < 1e-5);
    CHECK(std::abs(nearest->z[0] - 0.05 - row.x) <= error);
    CHECK(std::abs(nearest->v[0] - row.v) <= 10.0 * error);
    // The table's extremes are of samples, inside the true ones.
    CHECK(nearest->twist_maximum[0] >= row.high - error);
    CHECK(nearest->twist_minimum[0] <= row.low + error);
    CHECK(nearest->twist_maximum[0] - row.high < 5e-4);
    CHECK(row.low - nearest->twist_minimum[0] < 5e-4);
    CHECK(nearest->multiplier == Approx(row.multiplier).margin(1e-4));
    CHECK(nearest->stable == (row.multiplier < 1.0));
    CHECK(nearest->separates == (row.low < 1.0));
    unstable += nearest->stable ? 0 : 1;
  }
  CHECK(unstable > 3);
  const std::vector<SweptChange> folds = changes_of(sweep, BranchChange::fold);
  REQUIRE(folds.size() == 2);
  CHECK(folds[0].speed == Approx(0.7080316187).margin(1e-9));
  CHECK(folds[1].speed == Approx(0.8284639844).margin(1e-9));
  for (const SweptChange& fold : folds) CHECK(fold.error < 1e-8);
  // A train that speeds up jumps from a swing of .112 to .268, one that slows down from .321 to .050.
  REQUIRE(folds[1].jumps_to.size() == 1);
  const double swing = 0.5 * (folds[1].motion.twist_maximum[0] - folds[1].motion.twist_minimum[0]);
  CHECK(swing > 0.112);  // at .8280, below the fold
  CHECK(swing < 0.12);
  const std::vector<SweptChange> opens = changes_of(sweep, BranchChange::contact);
  REQUIRE(opens.size() == 2);
  // Where the linear amplitude is the mean deflection: 0.75 u^2 - 1.99 u + 1 = 0, u = w^2.
  const double root = std::sqrt(1.99 * 1.99 - 3.0);
  CHECK(opens[0].speed == Approx(std::sqrt((1.99 - root) / 1.5)).margin(1e-7));
  CHECK(opens[1].speed == Approx(std::sqrt((1.99 + root) / 1.5)).margin(1e-7));
}

TEST_CASE("Gear pair with a stepped stiffness: four folds and both period doublings to 8 digits",
          "[nonlinear_sweep][once]") {
  const Pair pair{.damping = 0.06,
                  .mean = 1.0,
                  .error = 0.0,
                  .stiffness = MeshStiffness::step(1.0 / 1.3, 1.5 / 1.3, 1.6)};
  const std::vector<BranchRow> rows = branch_rows("gear_pair_parametric_branch.csv", 1, 0.62, 2.2);
  REQUIRE(rows.size() > 20);
  std::set<double> speeds{0.62, 2.2};
  for (const BranchRow& row : rows) speeds.insert(row.speed);
  const NonlinearSweep sweep = sweep_nonlinear(
      pair.build(), {.speeds = {speeds.begin(), speeds.end()}, .tolerance = 1e-3, .runs = false});
  for (const BranchRow& row : rows) {
    INFO("w = " << row.speed << ", x = " << row.x);
    const SweptMotion* nearest = nullptr;
    const std::vector<SweptMotion> here = motions_at(sweep, row.speed);
    for (const SweptMotion& motion : here)
      if (nearest == nullptr || std::abs(motion.z[0] - row.x) < std::abs(nearest->z[0] - row.x))
        nearest = &motion;
    REQUIRE(nearest != nullptr);
    const double error = nearest->error * std::max(row.high, -row.low) + 2e-10;
    CHECK(std::abs(nearest->z[0] - row.x) <= error);
    CHECK(nearest->stable == (row.multiplier < 1.0));
    CHECK(nearest->separates == (row.low < 1.0));
  }
  // Shooting over closed-form pieces, to 10 digits and more.
  const double doublings[] = {1.8995014585153895, 2.096347210241158};
  const std::vector<SweptChange> doubled = changes_of(sweep, BranchChange::period_doubling);
  for (const double speed : doublings)
    CHECK(std::any_of(doubled.begin(), doubled.end(),
                      [&](const SweptChange& c) { return std::abs(c.speed - speed) < 1e-8; }));
  const double folds[] = {0.7191966624, 0.8019014568, 0.8552207151, 0.9525330678};
  const std::vector<SweptChange> turned = changes_of(sweep, BranchChange::fold);
  REQUIRE(turned.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) CHECK(turned[i].speed == Approx(folds[i]).margin(8e-9));
}

TEST_CASE("Gear pair, 60 speeds: every one is solved", "[nonlinear_sweep]") {
  const NonlinearSweep sweep =
      sweep_nonlinear(Pair{.damping = 0.06, .mean = 0.2, .error = 0.08}.build(),
                      {.speeds = even(0.7, 1.1, 60), .tolerance = 1e-3, .runs = false});
  CHECK(sweep.unsolved.empty());
  for (const double speed : sweep.speeds) CHECK_FALSE(motions_at(sweep, speed).empty());
}

TEST_CASE("Meissner's equation: tongues are located", "[nonlinear_sweep]") {
  struct Row {
    double damping, low, high;
  };
  for (const Row& row :
       {Row{0.0, 1.8710541957855, 2.1252722146407}, {0.04, 1.8770879929279, 2.1184359568012}}) {
    const Pair pair{.damping = row.damping,
                    .mean = 1.0,
                    .error = 0.0,
                    .backlash = 0.0,
                    .stiffness = MeshStiffness::step(0.8, 1.2, 1.5)};
    const NonlinearSweep sweep =
        sweep_nonlinear(pair.build(), {.speeds = {1.8, 2.0, 2.2}, .tolerance = 1e-3, .runs = false});
    const std::vector<SweptChange> ends = changes_of(sweep, BranchChange::period_doubling);
    INFO("damping " << row.damping);
    REQUIRE(ends.size() == 2);
    CHECK(ends[0].speed == Approx(row.low).margin(1e-9));
    CHECK(ends[1].speed == Approx(row.high).margin(1e-9));
    REQUIRE(motions_at(sweep, 2.0).size() == 1);
    CHECK_FALSE(motions_at(sweep, 2.0)[0].stable);
    // The product of exponentials, by a separate program.
    if (row.damping == 0.0)
      CHECK(motions_at(sweep, 2.0)[0].multiplier == Approx(1.22089514416751).epsilon(1e-9));
  }
}

TEST_CASE("Mathieu's equation: multipliers of a stiffness that varies smoothly, and its tongue",
          "[nonlinear_sweep]") {
  struct Row {  // x'' + c x' + (1 + 0.2 cos wt) x = 0 by SciPy's DOP853, relative tolerance 3e-14
    double damping, multiplier, low, high;
  };
  for (const Row& row : {Row{0.0, 1.1698740226269, 1.8988481104967, 2.0986875605265},
                         {0.04, 1.0986547255031, 1.9067865699180, 2.0899477434205}}) {
    const Pair pair{.damping = row.damping,
                    .mean = 1.0,
                    .error = 0.0,
                    .backlash = 0.0,
                    .stiffness = MeshStiffness::fourier(1.0, {{1.0, 0.2, 0.0}})};
    const NonlinearSweep sweep =
        sweep_nonlinear(pair.build(), {.speeds = {1.85, 2.0, 2.15}, .tolerance = 1e-3, .runs = false});
    INFO("damping " << row.damping);
    REQUIRE(motions_at(sweep, 2.0).size() == 1);
    CHECK(motions_at(sweep, 2.0)[0].multiplier == Approx(row.multiplier).epsilon(1e-11));
    const std::vector<SweptChange> ends = changes_of(sweep, BranchChange::period_doubling);
    REQUIRE(ends.size() == 2);
    CHECK(ends[0].speed == Approx(row.low).margin(1e-10));
    CHECK(ends[1].speed == Approx(row.high).margin(1e-10));
  }
}

TEST_CASE("A train of 24 meshes: each is the closed form while its contact holds, of 51 it is refused",
          "[nonlinear_sweep][once]") {
  // x'' + c x' + k x = mean + error w^2 cos wt, each of a wheel of its own on one pinion.
  const auto train = [](int meshes) {
    Model m("wheels");
    m.add_node("pinion");
    m.constant_speed("pinion", 1.0);
    for (int i = 0; i < meshes; ++i) {
      const std::string number = std::to_string(i), wheel = "wheel_" + number;
      m.add_node(wheel);
      m.add<Inertia>("J_" + number, {wheel}, {.inertia = 1.0});
      m.add<GearMesh>("mesh_" + number, {"pinion", wheel}, Pair{.stiffness = 1.0 + 0.1 * i}.mesh());
      m.add<EngineOrderTorque>("torque_" + number, {wheel}, {.mean = 0.1, .twist_feedback = false});
    }
    return m.build();
  };
  const NonlinearSweep sweep =
      sweep_nonlinear(train(24), {.speeds = {0.40, 0.401}, .tolerance = 1e-3, .runs = false});
  const std::vector<SweptMotion> found = motions_at(sweep, 0.40);
  REQUIRE(found.size() == 1);
  CHECK(found[0].stable);
  REQUIRE(sweep.sections.size() == 24);
  for (int i = 0; i < 24; ++i) {
    const double w = 0.40;
    const std::complex<double> stiffness(1.0 + 0.1 * i - w * w, 0.1 * w);
    CHECK(0.5 * (found[0].twist_maximum[i] - found[0].twist_minimum[i]) ==
          Approx(0.05 * w * w / std::abs(stiffness)).epsilon(1e-9));
  }
  try {
    sweep_nonlinear(train(51), {.speeds = {0.40, 0.401}});
    FAIL("no error");
  } catch (const ModelError& error) {
    const std::string what = error.what();
    CHECK(what.find("laws = 51") != std::string::npos);
    CHECK(what.find("at most 50") != std::string::npos);
  }
}

TEST_CASE("Where single periods are unstable a run finds the motion of two", "[nonlinear_sweep][once]") {
  const Pair pair{.damping = 0.06,
                  .mean = 1.0,
                  .error = 0.0,
                  .stiffness = MeshStiffness::step(1.0 / 1.3, 1.5 / 1.3, 1.6)};
  const NonlinearSweep sweep =
      sweep_nonlinear(pair.build(), {.speeds = {1.98, 2.0, 2.15}, .tolerance = 1e-4});
  REQUIRE(sweep.branches.size() == 2);
  CHECK(sweep.branches[1].turns == 2.0);
  CHECK(sweep.runs.empty());
  const std::vector<SweptMotion> here = motions_at(sweep, 2.0);
  REQUIRE(here.size() >= 2);
  CHECK_FALSE(here[0].stable);
  CHECK(here[1].stable);
  // At the start of either of the two periods.
  CHECK(here[1].twist_maximum[0] == Approx(3.3878499575).margin(4e-4));
  const std::vector<SweptChange> doubles = changes_of(sweep, BranchChange::period_doubling);
  REQUIRE_FALSE(doubles.empty());
  CHECK(doubles.back().speed == Approx(2.096347210241158).margin(1e-9));
}

TEST_CASE("Where nothing periodic is stable a run's statistics are given", "[nonlinear_sweep]") {
  // Lyapunov exponent 0.109; mean of the deflection .3926 +- .0039, of the load .1 exactly.
  const NonlinearSweep sweep = sweep_nonlinear(
      Pair{.error = 0.5}.build(),
      {.speeds = {1.0, 1.001}, .sections = {"mesh.force_N", "wheel.angle_rad"}, .tolerance = 1e-2});
  REQUIRE(sweep.runs.size() == 2);
  const SweptRun& run = sweep.runs.front();
  CHECK(run.reason.empty());
  CHECK(run.cycles == 200);
  CHECK(run.repeats == 0);
  CHECK(std::abs(run.mean[0] - 0.1) <= 2.0 * run.mean_error[0]);
  CHECK(std::abs(run.mean[1] - 0.3926) <= 2.0 * run.mean_error[1] + 0.0039);
  CHECK(run.mean_error[1] < 0.2);
  CHECK(run.highest[0] > 0.5);
}

TEST_CASE("Free pair: the same folds, torque that does not balance is told", "[nonlinear_sweep]") {
  const Pair pair;
  const std::vector<double> speeds{0.80, 0.84};
  const NonlinearSweep balanced = sweep_nonlinear(pair.free(0.1), {.speeds = speeds, .tolerance = 1e-3});
  const std::vector<SweptChange> folds = changes_of(balanced, BranchChange::fold);
  REQUIRE(folds.size() == 1);
  CHECK(folds[0].speed == Approx(0.8284639844).margin(1e-9));
  REQUIRE(motions_at(balanced, 0.80).size() >= 2);
  CHECK(std::abs(motions_at(balanced, 0.80)[0].left_over[0]) < 1e-12);
  CHECK(motions_at(balanced, 0.80)[0].mean[0] == Approx(0.1).margin(1e-9));
  // 0.3 against 0.1: 0.2 is left over, and half of it goes through the mesh.
  const NonlinearSweep off = sweep_nonlinear(pair.free(0.3), {.speeds = {1.5, 1.6}, .tolerance = 1e-3});
  REQUIRE_FALSE(motions_at(off, 1.5).empty());
  CHECK(motions_at(off, 1.5)[0].left_over[0] == Approx(0.2).epsilon(1e-9));
  CHECK(motions_at(off, 1.5)[0].mean[0] == Approx(0.2).epsilon(1e-9));
  const NonlinearSweep held =
      sweep_nonlinear(pair.free(0.3), {.speeds = {1.5, 1.6}, .balance = "wheel", .tolerance = 1e-3});
  CHECK(motions_at(held, 1.5)[0].mean[0] == Approx(0.3).epsilon(1e-9));
}

TEST_CASE("A motion of the sweep is a start from which a run repeats", "[nonlinear_sweep]") {
  const System system = Pair{}.build();
  const NonlinearSweep sweep = sweep_nonlinear(system, {.speeds = {0.8, 0.85}, .tolerance = 1e-8});
  for (const SweptMotion& motion : motions_at(sweep, 0.8)) {
    const System here = at_speed(system, 0.8);
    State state = State::initial(here);
    state.z = motion.z;
    state.v = motion.v;
    REQUIRE(propagate(here, {.tolerance = 1e-12, .t_end = kTwoPi / 0.8}, state).ok());
    CHECK(state.z[0] == Approx(motion.z[0]).margin(5e-8));
    CHECK(state.v[0] == Approx(motion.v[0]).margin(5e-8));
  }
}

TEST_CASE("Faults of a nonlinear sweep are listed at once", "[nonlinear_sweep]") {
  try {
    sweep_nonlinear(Pair{}.build(), {.speeds = {2.0}, .sections = {"mess.force_N"}, .tolerance = 2.0});
    FAIL("was taken");
  } catch (const ModelError& error) {
    CHECK(error.findings().size() == 3);
  }
  Model m("linear");
  m.add_node("a");
  m.add<Inertia>("J", {"a"}, {.inertia = 1.0});
  m.add<GroundSpring>("k", {"a"}, {.stiffness = 1.0});
  m.set_reference("a", constant_speed(1.0));
  CHECK_THROWS_AS(sweep_nonlinear(m.build(), {.speeds = {1.0, 2.0}}), ModelError);
  CHECK_THROWS_AS(at_speed(m.build(), 0.0), ModelError);
  CHECK(cycle_turns(Pair{}.build()) == 1.0);
}

TEST_CASE("What a sweep of contacts comes to at each speed: the worst of its stable motions",
          "[nonlinear_sweep][once]") {
  const NonlinearSweep sweep =
      sweep_nonlinear(Pair{}.build(), {.speeds = {0.60, 0.72, 0.80, 0.84, 1.0}, .tolerance = 1e-4});
  const WorstMotions worst = worst_motions(sweep);
  CHECK(worst.missing.empty());
  CHECK(worst.by_runs.empty());
  REQUIRE(worst.sweep.speeds == sweep.speeds);
  REQUIRE(worst.sweep.sections.size() == sweep.sections.size());
  const SweepSection& mesh = worst.sweep.sections[0];
  for (std::size_t i = 0; i < sweep.speeds.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    double expected = 0.0;
    int stable = 0;
    for (const SweptMotion& motion : motions_at(sweep, sweep.speeds[i])) {
      if (motion.stable) expected = std::max(expected, motion.half_range()[0]), ++stable;
      if (motion.stable && motion.separates) CHECK(mesh.separates(at));
    }
    INFO(sweep.speeds[i]);
    CHECK(stable == (sweep.speeds[i] > 0.708 && sweep.speeds[i] < 0.828 ? 2 : 1));
    CHECK(mesh.half_range()[at] == Approx(expected).epsilon(1e-14));
    CHECK(mesh.mean[at] == Approx(0.1).margin(1e-3));
  }
  // Between 0.60 and 0.72 the upper branch begins, at its fold, above both of them.
  const double fold = 0.7080316187;
  REQUIRE_FALSE(worst.sweep.peaks.empty());
  CHECK(std::any_of(worst.sweep.peaks.begin(), worst.sweep.peaks.end(), [&](const SweepPeak& p) {
    return p.section == 0 && p.speed > fold - 1e-3 && p.speed < 0.72 && p.half_range > mesh.half_range()[1];
  }));

  // Two speeds far outside show as much: the curves' own points are judged. Teeth hammer from the fold on.
  const WorstMotions ends =
      worst_motions(sweep_nonlinear(Pair{}.build(), {.speeds = {0.60, 1.0}, .tolerance = 1e-4}));
  const auto chatter = judge_sweep(ends.sweep, {}).chatter;
  REQUIRE(chatter.size() == 1);
  CHECK(chatter[0].range.from == Approx(fold).margin(5e-3));
  CHECK(chatter[0].range.kept_below == Approx(fold).margin(2e-2));

  // Chaos: the run's lowest and highest value.
  const NonlinearSweep chaos = sweep_nonlinear(
      Pair{.error = 0.5}.build(), {.speeds = {1.0, 1.001}, .sections = {"mesh.force_N"}, .tolerance = 1e-2});
  const WorstMotions run = worst_motions(chaos);
  CHECK(run.by_runs == chaos.speeds);
  CHECK(run.sweep.sections[0].heat.array().isNaN().all());
  CHECK(run.sweep.sections[0].half_range()[0] ==
        Approx(0.5 * (chaos.runs[0].highest[0] - chaos.runs[0].lowest[0])).epsilon(1e-14));

  NonlinearSweep none = sweep;
  none.branches.clear();
  none.runs.clear();
  CHECK(worst_motions(none).missing == none.speeds);
}

TEST_CASE("The cycle of a train of several shafts is found by the turns of each", "[nonlinear_sweep]") {
  Model m("two stages");
  for (const char* node : {"motor", "middle", "output"}) m.add_node(node);
  m.constant_speed("motor", 100.0);
  m.add<IdealGear>("one", {"motor", "middle"}, {.ratio = -21.0 / 83.0});
  m.add<IdealGear>("two", {"middle", "output"}, {.ratio = -19.0 / 77.0});
  m.add_node("load");
  m.add<Inertia>("J", {"load"}, {.inertia = 1.0});
  m.add<ShaftSpring>("shaft", {"output", "load"}, {.stiffness = 1e4, .damping = 1.0});
  m.add<EngineOrderTorque>("gas", {"load"}, {.harmonics = {{2.0, 10.0, 0.0}}, .twist_feedback = false});
  // Half a turn of the load's shaft.
  CHECK(cycle_turns(m.build()) == Approx(0.5 * 83.0 * 77.0 / (21.0 * 19.0)).epsilon(1e-12));
}

TEST_CASE("Two meshes of one train: their forces satisfy the equation of motion over the cycle",
          "[nonlinear_sweep][once]") {
  // Pinion held - mesh 1 - wheel - mesh 2 - second wheel, both with backlash and a transmission error of their own.
  Model m("two meshes");
  for (const char* node : {"pinion", "wheel", "second"}) m.add_node(node);
  m.constant_speed("pinion", 1.0);
  m.add<Inertia>("J_1", {"wheel"}, {.inertia = 1.0});
  m.add<Inertia>("J_2", {"second"}, {.inertia = 0.4});
  GearMesh::Params mesh = Pair{}.mesh();
  m.add<GearMesh>("mesh_1", {"pinion", "wheel"}, mesh);
  mesh.transmission_error = std::vector<Harmonic>{{1.0, 0.03, 1.0}};
  m.add<GearMesh>("mesh_2", {"wheel", "second"}, mesh);
  m.add<EngineOrderTorque>("torque", {"second"}, {.mean = 0.1, .twist_feedback = false});
  const System system = m.build();
  const NonlinearSweep sweep = sweep_nonlinear(system, {.speeds = {0.5, 0.8, 1.1, 1.6}, .tolerance = 1e-4});
  CHECK(sweep.unsolved.empty());
  int checked = 0, separated = 0;
  for (const SweptBranch& branch : sweep.branches)
    for (const SweptMotion& motion : branch.motions) {
      if (!motion.asked || !motion.stable) continue;
      INFO(motion.speed);
      ++checked;
      separated += motion.separates ? 1 : 0;
      // From its state a run comes back to it, within the stated error.
      const System here = at_speed(system, motion.speed);
      State state = State::initial(here);
      state.z = motion.z;
      state.v = motion.v;
      REQUIRE(
          propagate(here, {.tolerance = 1e-11, .t_end = kTwoPi * branch.turns / motion.speed}, state).ok());
      CHECK((state.z - motion.z).cwiseAbs().maxCoeff() < 1e-3 * motion.z.cwiseAbs().maxCoeff());
      // Either mesh carries the load's mean torque.
      for (Eigen::Index c = 0; c < motion.mean.size(); ++c)
        CHECK(std::abs(motion.mean[c]) == Approx(0.1).margin(1e-6));
    }
  CHECK(checked >= 4);
  CHECK(separated > 0);
}
