// A run that will take long says so soon after its start, with the time left and what makes it so.
#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using drev::test::contains;
using drev::test::drev_command;
using drev::test::Process;
using drev::test::TemporaryFolder;

TEST_CASE("A run that cannot end in reasonable time says so, with what makes it so") {
  const TemporaryFolder folder;
  const std::string path = (folder / "stiff.toml").string();
  std::ofstream(path) << "format = 1\n[nodes]\na = {}\nb = {}\n[elements]\n"
                         "J1 = { type = \"inertia\", node = \"a\", inertia_kg_m2 = 1 }\n"
                         "J2 = { type = \"inertia\", node = \"b\", inertia_kg_m2 = 1 }\n"
                         "shaft = { type = \"shaft_spring\", nodes = [\"a\", \"b\"], stiffness_Nm_per_rad = "
                         "1e15 }\nload = { type = \"applied_torque\", node = \"a\", torque_Nm = 1 }\n[run]\n"
                         "duration_s = 1000\n";
  const Process process({"run", path, "--method", "exact"});
  std::this_thread::sleep_for(std::chrono::seconds(7));
  process.send(SIGINT);
  const auto run = process.wait();
  CAPTURE(run.err);
  CHECK(contains(run.err, "drev: this will take "));
  CHECK(contains(run.err, "with a fastest mode of 7.12e+06 Hz"));
  // One that ends soon says nothing of it.
  CHECK(!contains(drev_command({"run", "two_inertia"}).err, "this will take"));
}
