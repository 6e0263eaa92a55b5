// README.md: the files that its commands name are there, and the quick ones work as they stand, from the project's root.
#include <cstdlib>
#include <sstream>

#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using drev::test::read_file;

TEST_CASE("The commands of the README work as they stand", "[once]") {
  const drev::test::TemporaryFolder folder;
  std::filesystem::create_directory_symlink(DREV_SOURCE_DIR "/models", folder / "models");
  std::istringstream page(read_file(DREV_SOURCE_DIR "/README.md"));
  int run = 0, files = 0;
  for (std::string line; std::getline(page, line);) {
    if (!line.starts_with("    drev ")) continue;
    const std::string command = line.substr(4, line.find("   ", 4) - 4);  // without what is said of it
    INFO(command);
    std::istringstream words(command);
    bool names_file = false;
    for (std::string word; words >> word;)
      if (word.starts_with("models/")) {
        CHECK(std::filesystem::exists(folder / word));
        names_file = true;
        ++files;
      }
    const bool quick =
        command.starts_with("drev list") || command.starts_with("drev modes") || command == "drev --help";
    if (!quick && !names_file) continue;
    std::ofstream(folder / "command") << command << "\n";
    const std::string typed = "cd '" + (folder / "").string() +
                              "' && PATH=\"$(dirname '" DREV_EXECUTABLE
                              "'):$PATH\" sh ./command > printed 2>&1";
    CHECK(std::system(typed.c_str()) == 0);
    ++run;
  }
  CHECK(run >= 7);
  CHECK(files >= 4);
}
