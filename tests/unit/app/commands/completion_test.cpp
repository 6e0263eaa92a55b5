// What the shells are offered, and the script of bash itself where bash is there.
#include <cstdio>
#include <sstream>

#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using drev::test::drev_command;

namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> offered(std::vector<std::string> words) {
  words.insert(words.begin(), "__complete");
  const auto outcome = drev_command(words);
  CHECK(outcome.exit_code == 0);
  return lines_of(outcome.out);
}

using Words = std::vector<std::string>;

}  // namespace

TEST_CASE("Completion offers commands, models, options, parameters, choices and channels") {
  CHECK(offered({"mo"}) == Words{"modes"});
  CHECK(offered({"run", "cam"}) == Words{"camshaft"});
  CHECK(offered({"run", "camshaft", "--acc"}) == Words{"--accuracy"});
  CHECK(offered({"run", "camshaft", "--set", "cyl"}) == Words{"cylinders="});
  CHECK(offered({"run", "camshaft", "--set", "cylinders=6", "drive=h"}) == Words{"drive=held"});
  CHECK(offered({"run", "camshaft", "--method", "exa"}) == Words{"exact"});
  CHECK(offered({"modes", "camshaft", "--contact", ""}) == Words{"closed", "open"});
  CHECK(offered({"run", "camshaft", "--record", "end.angle_rad,mesh_1.f"}) ==
        Words{"end.angle_rad,mesh_1.force_N"});
  CHECK(offered({"run", "camshaft", "--out", ""}).empty());  // the shell's files
  CHECK(offered({"rum", ""}).empty());
  CHECK(offered({}).size() > 4);
}

TEST_CASE("bash completes words that it has split at =") {
  const drev::test::TemporaryFolder folder;
  const std::string script =
      std::string("PATH=$(dirname ") + DREV_EXECUTABLE + "):$PATH; source " + DREV_SOURCE_DIR +
      "/app/cli/completion/drev.bash; COMP_LINE='drev run camshaft --set drive=h'; COMP_POINT=${#COMP_LINE}; "
      "COMP_WORDS=(drev run camshaft --set drive = h); COMP_CWORD=6; _drev; echo \"${COMPREPLY[*]}\"; "
      "COMP_LINE='drev run camshaft --set drive='; COMP_POINT=${#COMP_LINE}; "
      "COMP_WORDS=(drev run camshaft --set drive =); COMP_CWORD=5; _drev; echo \"${COMPREPLY[*]}\"";
  const std::string out = (folder / "out").string();
  const int status = std::system(("bash -c '" +
                                  [&] {
                                    std::string quoted;
                                    for (const char c : script)
                                      quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
                                    return quoted;
                                  }() +
                                  "' >" + out + " 2>&1")
                                     .c_str());
  CHECK(status == 0);
  CHECK(lines_of(drev::test::read_file(out)) == Words{"held", "gears held free"});
}

TEST_CASE("Option --quiet prints nothing, and what is wrong is still said") {
  const auto good = drev_command({"run", "two_inertia", "--set", "duration_s=0.01", "--quiet"});
  CHECK(good.exit_code == 0);
  CHECK(good.out.empty());
  CHECK(good.err.empty());
  const auto bad = drev_command({"run", "two_inertias", "--quiet"});
  CHECK(bad.exit_code == 2);
  CHECK_FALSE(bad.err.empty());
}
