#include "app/report/report_pdf.hpp"

#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <spawn.h>
#include <sstream>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include "app/base/output_file.hpp"

extern char** environ;

namespace drev::app {

namespace {

/// A directory for the browser's profile, removed with all that is in it.
class ProfileFolder {
 public:
  ProfileFolder() : path_((std::filesystem::temp_directory_path() / "drev_print_XXXXXX").string()) {
    if (::mkdtemp(path_.data()) == nullptr)
      throw OutputError("cannot create " + path_ + ": " + std::strerror(errno));
  }
  ~ProfileFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ProfileFolder(const ProfileFolder&) = delete;
  ProfileFolder& operator=(const ProfileFolder&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// Runs a program without input or output, and waits. Returns what waitpid() says, -1: not started.
int run_silently(std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_RDWR, 0);
  pid_t id = -1;
  const int error = ::posix_spawn(&id, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) return -1;
  int status = 0;
  while (::waitpid(id, &status, 0) < 0)
    if (errno != EINTR) return -1;
  return status;
}

std::string file_url(const std::string& path) {
  std::string url = "file://";
  for (const char c : std::filesystem::absolute(path).string()) {
    char code[4];
    std::snprintf(code, sizeof code, "%%%02X", static_cast<unsigned>(static_cast<unsigned char>(c)));
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || std::strchr("/-._~", c) != nullptr;
    url += plain ? std::string(1, c) : code;
  }
  return url;
}

/// A PDF says at its end that it is complete.
bool is_complete_pdf(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = file ? static_cast<std::streamoff>(file.tellg()) : 0;
  if (size < 64) return false;
  std::string tail(64, '\0');
  file.seekg(size - 64);
  file.read(tail.data(), 64);
  return file && tail.find("%%EOF") != tail.npos;
}

}  // namespace

std::string find_browser() {
  const char* path = std::getenv("PATH");
  for (const char* name : {"chromium", "chromium-browser", "google-chrome"}) {
    std::istringstream folders(path != nullptr ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');) {
      const std::string file = folder + "/" + name;
      if (!folder.empty() && ::access(file.c_str(), X_OK) == 0) return file;
    }
  }
  return {};
}

void print_as_pdf(const std::string& html, const std::string& pdf) {
  const std::string browser = find_browser();
  if (browser.empty()) throw OutputError("cannot write " + pdf + ": it " + kNoBrowser);
  const ProfileFolder profile;
  std::vector<std::string> words{browser,
                                 "--headless",
                                 "--disable-gpu",
                                 "--no-first-run",
                                 "--user-data-dir=" + profile.path(),
                                 "--no-pdf-header-footer",
                                 "--virtual-time-budget=20000",
                                 "--print-to-pdf=" + pdf};
  if (::geteuid() == 0) words.push_back("--no-sandbox");  // it refuses to run as root otherwise
  words.push_back(file_url(html));
  const int status = run_silently(std::move(words));
  if (status != 0 || !is_complete_pdf(pdf))
    throw OutputError("cannot write " + pdf + ": " + browser +
                      " could not print the page (disk full?); --report FILE.html needs no browser");
}

}  // namespace drev::app
