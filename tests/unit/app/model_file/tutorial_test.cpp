// docs/tutorial.md: its commands, typed as they stand, print what it shows.
#include <cstdlib>
#include <sstream>

#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using drev::test::read_file;

TEST_CASE("The commands of the tutorial print what it says", "[once]") {
  const drev::test::TemporaryFolder folder;
  std::filesystem::copy_file(DREV_SOURCE_DIR "/models/tutorial/train.toml", folder / "train.toml");
  std::filesystem::copy(DREV_SOURCE_DIR "/models/genset", folder / "genset");
  const auto printed_by = [&](const std::string& command) {
    std::ofstream(folder / "command") << command << "\n";
    const std::string line = "cd '" + (folder / "").string() +
                             "' && PATH=\"$(dirname '" DREV_EXECUTABLE
                             "'):$PATH\" sh ./command > printed 2>&1";
    CHECK(std::system(line.c_str()) != -1);
    return read_file(folder / "printed");
  };
  std::istringstream page(read_file(DREV_SOURCE_DIR "/docs/tutorial.md"));
  int commands = 0, lines = 0;
  bool console = false;
  std::string printed;
  std::size_t at = 0;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("```")) {
      console = line == "```console";
    } else if (console && line.starts_with("$ ")) {
      printed = printed_by(line.substr(2));
      at = 0;
      ++commands;
    } else if (console) {  // the lines shown are some of those printed, in their order
      INFO("shown:\n" << line << "\nprinted:\n" << printed);
      const std::size_t found = printed.find(line, at);
      CHECK(found != std::string::npos);
      if (found != std::string::npos) at = found + line.size();
      ++lines;
    }
  }
  CHECK(commands >= 8);
  CHECK(lines >= 25);
  CHECK(read_file(folder / "train.html").size() > 100000);
}

TEST_CASE("The C++ example of the tutorial prints what the page shows", "[once]") {
  const drev::test::TemporaryFolder folder;
  const std::string file = (folder / "printed").string();
  REQUIRE(std::system(("\"$(dirname '" DREV_EXECUTABLE "')/example_tutorial\" >'" + file + "'").c_str()) ==
          0);
  const std::string printed = read_file(file);
  std::istringstream page(read_file(DREV_SOURCE_DIR "/docs/tutorial.md"));
  const std::string indent(4, ' ');
  bool code = false, any_code = false;  // what the example prints is indented, behind its first lines
  int lines = 0;
  std::size_t at = 0;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("```")) {
      code = !code;
      any_code |= line == "```cpp";
    } else if (any_code && !code && line.starts_with(indent) && line != indent + "...") {
      std::string shown = line.substr(indent.size());
      shown = shown.substr(0, shown.find(", energy error"));  // rounding, which differs between machines
      INFO("shown:\n" << shown << "\nprinted:\n" << printed);
      const std::size_t found = printed.find(shown, at);
      REQUIRE(found != std::string::npos);
      at = found + shown.size();
      ++lines;
    }
  }
  CHECK(lines >= 10);
}
