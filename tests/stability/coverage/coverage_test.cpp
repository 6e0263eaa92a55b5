// The short form of the coverage suite: the long form (build/release/bin/coverage_suite, docs/validation.md) with few
// models. Ahead of it, the suite's own reference against closed forms and independent programs.
#include <sstream>

#include "tests/catch.hpp"
#include "tests/stability/coverage/cover.hpp"
#include "tests/stability/coverage/random_spec.hpp"

namespace {

using namespace coverage;

const ReferencePeak& peak_of(const Spec& spec, const ReferenceResult& r, const std::string& channel) {
  const ReferenceModel model(spec);
  for (std::size_t c = 0; c < model.channels().size(); ++c)
    if (model.channels()[c].name == channel) return r.peaks[c];
  FAIL("no channel " << channel);
  return r.peaks.front();
}

void add_constant(Spec& spec, int node, double torque) {
  Load l;
  l.node = node;
  l.times = {0.0}, l.torques = {torque};
  spec.loads.push_back(l);
}

}  // namespace

TEST_CASE("Coverage reference: a cam at the nominal angle, closed form stretch by stretch") {
  Spec spec;
  spec.nodes = {{.inertia = 1.0, .prescribed = true}, {.inertia = 0.05}};
  spec.shafts = {{.a = 0, .b = 1, .stiffness = 1e5}};
  spec.nominal = {.node = 0, .omega_0 = 100 * M_PI, .omega_1 = 100 * M_PI};
  Load cam;
  cam.kind = Load::Kind::table_in_angle;
  cam.node = 1;
  for (const double degrees : {0.0, 20.0, 40.0, 60.0, 80.0})
    cam.table.arguments.push_back(degrees * M_PI / 180);
  cam.table.values = {0.0, 400.0, 400.0, -300.0, 0.0};
  cam.table.period = 2 * M_PI;
  spec.loads = {cam};
  spec.duration = 0.1;
  const ReferenceResult r = reference_result(spec, kFine, {});
  REQUIRE_FALSE(r.failed);
  CHECK(static_cast<double>(peak_of(spec, r, "shaft0.torque_Nm").amplitude()) ==
        Approx(1032.837164206).epsilon(1e-11));
}

TEST_CASE("Coverage reference: the torque of an ideal gear under a sine") {
  // Modelica Standard Library, Rotational.Examples.First: motor, ideal gear of ratio 10, spring, load with a
  // damper; the peak by another program.
  Spec spec;
  spec.nodes = {{.inertia = 0.1}, {.inertia = 2.0}, {.inertia = 2.0}};
  spec.gears = {{.a = 0, .b = 1, .ratio = 0.1}};
  spec.shafts = {{.a = 1, .b = 2, .stiffness = 1e4}};
  spec.dashpots = {{.a = 1, .b = -1, .damping = 10.0}};
  Load drive;
  drive.kind = Load::Kind::harmonics_in_time;
  drive.harmonics = {{5.0, 10.0, -M_PI / 2}};
  spec.loads = {drive};
  spec.duration = 1.0;
  const ReferenceResult r = reference_result(spec, kFine, {});
  REQUIRE_FALSE(r.failed);
  CHECK(static_cast<double>(peak_of(spec, r, "gear0.torque_Nm").amplitude()) ==
        Approx(37.709646914).epsilon(1e-10));
}

TEST_CASE("Coverage reference: transmission error that stands still, with backlash") {
  // Three gears, law `always`; 91 contact changes and a peak of 21.2206 N m in the dashpot by four other
  // methods.
  Spec spec;
  spec.nodes = {{.inertia = 0.005392377219520271, .speed = 1.9787184101615862},
                {.inertia = 0.05035750329485766},
                {.inertia = 0.03179320799245008}};
  Mesh first{.a = 0, .b = 1};
  first.radius_a = 0.044543651863395275, first.radius_b = 0.06883098259369531;
  first.backlash = 1.0328250757753547e-05, first.damping = 322.54672612454334, first.law = Law::always;
  first.stiffness = 379607362.0942271, first.teeth = 23, first.phase = 0.7894224036811955;
  first.error_harmonics = {{1.0, 1.3137244600295432e-05, 5.442420881252174},
                           {2.0, 7.803193348761848e-07, 2.131188625433891}};
  Mesh second{.a = 1, .b = 2};
  second.radius_a = 0.10764807745114466, second.radius_b = 0.137419261949762;
  second.internal = true, second.stiffness = 48958317.576525405;
  spec.meshes = {first, second};
  add_constant(spec, 2, 213.0191101576902);
  add_constant(spec, 2, -21.25656915888902);
  spec.dashpots = {{.a = 0, .b = -1, .damping = 0.2841546676578719}};
  spec.duration = 0.03;
  const ReferenceResult r = reference_result(spec, kFine, {}), check = reference_result(spec, kCheck, {});
  REQUIRE_FALSE(r.failed);
  CHECK(r.edges.size() == 91);
  CHECK(check.edges.size() == 91);
  const double force = static_cast<double>(peak_of(spec, r, "mesh0.force_N").amplitude());
  const double other = static_cast<double>(peak_of(spec, check, "mesh0.force_N").amplitude());
  CHECK(force == Approx(other).epsilon(1e-12));
  CHECK(static_cast<double>(peak_of(spec, r, "dashpot0.torque_Nm").amplitude()) ==
        Approx(21.2206).epsilon(3e-6));
}

TEST_CASE("Coverage reference: a run with every kind of event keeps what it lost to no damper") {
  // Two runs with other steps agree, of every family: each is its own witness for where events stand.
  for (unsigned seed = 2; seed <= 10; ++seed) {
    const Spec spec = random_spec(seed);
    const Case c = make_case(spec);
    INFO(spec.name << " (" << spec.family << "), growth " << c.growth << " " << c.problem);
    REQUIRE(c.usable);
    CHECK(c.fine.edges.size() == c.check.edges.size());
    for (std::size_t i = 0; i < c.fine.peaks.size(); ++i)
      CHECK(c.truth_error(i) <= 1e-13 * c.growth * static_cast<double>(c.fine.peaks[i].amplitude()) + 1e-16);
  }
}

namespace {

std::string text_of(const Table& table) {
  std::ostringstream text;
  table.print(text, true, true);
  return text.str();
}

}  // namespace

TEST_CASE("Coverage: modes and damped modes of 60 random models") {
  Table table;
  for (unsigned seed = 1; seed <= 60; ++seed) cover_modes(random_spec(seed), table);
  INFO(text_of(table));
  CHECK(table.all().tried > 700);
  CHECK(table.all().share() >= 0.999);
}

TEST_CASE("Coverage: histories of linear models and of gears with backlash") {
  Table table;
  for (const unsigned seed : {1u, 2u, 3u, 5u, 10u, 11u, 13u, 20u}) {
    const Case c = make_case(random_spec(seed));
    REQUIRE(c.usable);
    cover_runs(c, table);
  }
  INFO(text_of(table));
  long tried = 0, held = 0;
  for (const auto& [kind, row] : table.errors())
    if (kind.starts_with("history")) tried += row.tried, held += row.held;
  CHECK(tried > 400);
  CHECK(static_cast<double>(held) >= 0.999 * static_cast<double>(tried));
}

// The whole of it: every kind of figure.
TEST_CASE("Coverage: every stated error of twelve random models and four periodic ones", "[coverage]") {
  Table table;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    if (seed == 7) continue;  // large, and of the kind of 8
    const Case c = make_case(random_spec(seed));
    REQUIRE(c.usable);
    cover_runs(c, table);
    cover_contacts(c, table);
    cover_accuracy(c, {.accuracy = seed % 2 ? 1e-10 : 1e-6, .which = seed, .pairs = 1}, table);
  }
  constexpr int kHarmonics[] = {8, 32, 128, 0};
  for (unsigned i = 0; i < 4; ++i) cover_periodic(random_periodic_spec(3 * i + 6), kHarmonics[i], table);
  INFO(text_of(table));
  for (const auto& [kind, row] : table.errors()) {
    INFO(kind << ": " << row.held << " of " << row.tried);
    CHECK(static_cast<double>(row.held) >= 0.999 * static_cast<double>(row.tried));
  }
}

TEST_CASE("Coverage: 95 % intervals of a chaotic model") {
  Table table;
  cover_statistics(10, 1, table);
  INFO(text_of(table));
  long tried = 0, held = 0;
  for (const auto& [kind, row] : table.intervals()) tried += row.tried, held += row.held;
  CHECK(tried >= 7);
  // Few and correlated: the long form counts whether it is 93 to 97 of 100.
  CHECK(held >= 6 * tried / 10);
}
