// `drev study`: the report, its figures that are cheap, and the superposition behind its firing orders.
#include <drev/core/units.hpp>
#include <drev/solvers/accuracy/error_growth.hpp>
#include <drev/solvers/periodic/periodic_response.hpp>
#include <drev/solvers/run/recorder.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "app/study/study_runs.hpp"
#include "models/camshaft/steady_shaft.hpp"
#include "solvers/periodic/floquet.hpp"
#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using namespace drev;
using namespace drev::app;
using drev::test::contains;
using drev::test::drev_command;
using drev::test::read_file;

namespace {

/// Number of cells of a row of a Markdown table; escaped bars are no ends of cells.
int cells(const std::string& line) {
  int bars = 0;
  for (std::size_t i = 0; i < line.size(); ++i)
    bars += line[i] == '|' && (i == 0 || line[i - 1] != '\\') ? 1 : 0;
  return bars - 1;
}

/// Rows of tables; each must have as many cells as the head of its table.
int check_tables(const std::string& markdown) {
  std::istringstream lines(markdown);
  std::string line;
  int width = 0, rows = 0;
  while (std::getline(lines, line)) {
    if (!line.starts_with('|')) {
      width = 0;
      continue;
    }
    if (width == 0) width = cells(line);
    INFO(line);
    CHECK(cells(line) == width);
    CHECK(line.ends_with('|'));
    ++rows;
  }
  return rows;
}

/// A table by its number: 5.1 is not 5.10.
bool names(const std::string& report, const std::string& table) {
  for (std::size_t at = 0; (at = report.find(table, at)) != std::string::npos; ++at)
    if (std::string(" ,:").find(report[at + table.size()]) != std::string::npos) return true;
  return false;
}

}  // namespace

TEST_CASE("Study: free frequencies within 0.005 Hz of an independent solver's") {
  const double targets[5][5] = {{166.73, 409.78, 657.55, 889.17, 1085.45},  // 6 to 10 cylinders
                                {149.96, 363.66, 584.89, 798.01, 992.34},
                                {138.56, 332.52, 535.25, 733.76, 920.90},
                                {122.27, 288.06, 462.59, 635.15, 801.02},
                                {111.61, 259.43, 415.83, 571.50, 722.78}};
  const StudyGroup group = study_frequencies();
  REQUIRE(group.tables.size() == 1);
  const std::vector<StudyRow>& rows = group.tables[0].rows;
  REQUIRE(rows.size() == 25);
  for (std::size_t i = 0; i < rows.size(); ++i)
    CHECK(std::abs(rows[i].converged->value - targets[i / 5][i % 5]) <= 0.00501);
  CHECK(rows[0].published == "167.10");
  CHECK(rows[19].published == "788.97");
}

TEST_CASE("Study: the report of the cheap groups", "[once]") {
  const drev::test::TemporaryFolder folder;
  const auto run = drev_command(
      {"study", "--only", "data,frequencies,held_frequencies,benchmark", "--out", (folder / "out").string()});
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  CHECK(contains(run.out, "stands"));
  const std::string report = read_file(folder / "out/study.md");
  CHECK(check_tables(report) > 60);
  for (const char* source : {"Table 3.2", "Table 3.3", "Table 4.1", "Table 4.2", "Table 4.3", "Table 4.5",
                             "Table 5.1", "Table 5.2", "Table 5.3", "Table 5.4", "Figure 5.10"})
    CHECK(contains(report, source));
  // The two halves of the first mode's story: 106.576 Hz (independent solver), shown as 102.84 Hz by
  // average acceleration, tan(w' h/2) = w h/2.
  CHECK(contains(report, "106.576"));
  CHECK(contains(report, "102.84"));
  CHECK(read_file(folder / "out/pictures/study_modes_9.svg").starts_with("<svg"));
}

TEST_CASE("Study: every table of the source is in docs/study.md") {
  const std::string report = read_file(std::string(DREV_SOURCE_DIR) + "/docs/study.md");
  CHECK(check_tables(report) > 150);
  for (const char* name :
       {"3.1", "3.2", "3.3", "4.1", "4.2", "4.3", "4.4",  "4.5",  "5.1",  "5.2",  "5.3",
        "5.4", "5.5", "5.6", "5.7", "5.8", "5.9", "5.10", "5.11", "5.12", "5.13", "5.14"}) {
    INFO("Table " << name);
    CHECK(names(report, std::string("Table ") + name));
  }
  for (const char* question :
       {"Is the gear drive needed", "Is backlash?", "Is varying stiffness?", "Is it with the true curve?"})
    CHECK(contains(report, question));
}

TEST_CASE("Study: a group that is none lists those that are") {
  const auto run = drev_command({"study", "--only", "gear_drives"});
  CHECK(run.exit_code == 2);
  for (const char* part : {"gear_drives", "did you mean 'gear_drive'?", "held", "run_up", "firing_order"})
    CHECK(contains(run.err, part));
}

TEST_CASE("Study: superposed cylinders are the steady state of a run in time", "[once]") {
  const int cylinders = 6;
  const ParameterValues parameters{{"cylinders", "6"},    {"drive", "held"},
                                   {"damping", "case_1"}, {"loads", "source"},
                                   {"duration_s", "3.2"}, {"firing_order", "1-4-3-6-2-5"}};
  const ModelCase model_case = build_case("camshaft", parameters);
  const System system = model_case.model.build();
  // 20 revolutions at 750 rpm: the start has died out to exp(-10.6 * 3) = 2e-14.
  const double revolution = 0.16;
  const int points = 60;
  std::vector<std::string> names{model_case.deflection};
  names.insert(names.end(), model_case.torques.begin(), model_case.torques.end());
  Recorder recorder(system, names, revolution / points);
  run_watched(system, exact_method(1e-12), model_case.duration, {&recorder});

  const SteadyShaft shaft(cylinders);
  const auto waves = in_order(shaft.cylinder_waves(rpm(375.0), rayleigh_case("case_1", cylinders)),
                              {1, 4, 3, 6, 2, 5}, 0, static_cast<Eigen::Index>(names.size()));
  const double largest = waves.rightCols(waves.cols() - 1).cwiseAbs().maxCoeff();
  for (Eigen::Index c = 0; c < waves.cols(); ++c) {
    const std::vector<double>& samples = recorder.samples(static_cast<std::size_t>(c));
    double worst = 0.0;
    for (int i = 0; i < points; ++i)
      worst = std::max(worst, std::abs(samples[samples.size() - 1 - points + static_cast<std::size_t>(i)] -
                                       waves(i * SteadyShaft::kSamples / points, c)));
    INFO(names[static_cast<std::size_t>(c)]);
    // Harmonics above 1440 (9 kHz; the fastest mode is at 5 kHz) are left out: kinks of the tables.
    CHECK(worst <= (c == 0 ? 1e-5 * waves.col(0).cwiseAbs().maxCoeff() : 1e-4 * largest));
  }
  const PeriodicResponse balance = solve_periodic(system, {.channels = {model_case.deflection}});
  REQUIRE(balance.found);
  CHECK(peak_of(waves.col(0)) == Approx(balance.peaks[0].amplitude()).epsilon(1e-5));
}

TEST_CASE("Study: growth under stepped mesh stiffness is that of a run, and -a/2 without steps") {
  const auto train = [](const char* stiffness, const char* damping) {
    return build_case("camshaft", {{"backlash_mm", "0"},
                                   {"loads", "source"},
                                   {"damping", damping},
                                   {"mesh_stiffness", stiffness},
                                   {"duration_s", "0.5"}})
        .model.build();
  };
  const double period = 60.0 / 750.0 * 68.0 / 59.0 / 34.0;  // of mesh 2
  // Every mode of C = a M decays with a/2.
  CHECK(largest_floquet_exponent(train("mean", "case_1"), period, 8) == Approx(-0.5 * 15.38).epsilon(1e-6));
  // Nor does the curve from the gears' geometry make any of them grow.
  CHECK(largest_floquet_exponent(train("drawing", "case_1"), period, 200) ==
        Approx(-0.5 * 15.38).epsilon(1e-5));
  const System unstable = train("step", "case_1");
  const ErrorGrowth growth = measure_error_growth(
      unstable, {.method = {.name = "average_acceleration", .step = 1e-5}, .t_end = 0.5, .pieces = 50});
  const double rate = largest_floquet_exponent(unstable, period, 8);
  CHECK(rate > 10.0);
  CHECK(std::abs(growth.rate - rate) <= growth.rate_error + 0.03 * rate);
}
