#include "app/report/report_pdf.hpp"

#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <spawn.h>
#include <sstream>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include "app/base/output_file.hpp"

extern char** environ;

namespace drev::app {

namespace {

/// A new folder that only this user can access, removed with its content.
class NewFolder {
 public:
  explicit NewFolder(const std::string& parent) : path_(parent + "/drev_print_XXXXXX") {
    if (::mkdtemp(path_.data()) == nullptr)
      throw OutputError("cannot create a folder in " + parent + ": " + std::strerror(errno));
  }
  ~NewFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// The folder for temporary files.
std::string temporary_folder() {
  std::error_code error;
  const std::filesystem::path path = std::filesystem::temp_directory_path(error);
  if (!error) return path.string();
  const char* named = std::getenv("TMPDIR");
  throw OutputError("cannot print a PDF: the folder for temporary files" +
                    (named != nullptr ? ", TMPDIR = " + std::string(named) + "," : std::string()) +
                    " is not there; set TMPDIR to a folder that is");
}

/// Runs a program without input or output, and waits for it. Returns the status of waitpid(); -1: not
/// started.
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

/// A file as text; empty if it is not a complete PDF, which ends with %%EOF.
std::string complete_pdf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  constexpr std::size_t kTail = 64;
  if (text.size() < kTail || text.find("%%EOF", text.size() - kTail) == text.npos) text.clear();
  return text;
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

std::string print_as_pdf(const std::string& page, const std::string& folder) {
  const std::string browser = find_browser();
  if (browser.empty()) throw OutputError("cannot print a PDF: it " + std::string(kNoBrowser));
  // The page and its print are in a folder of their own, to which no other user can write.
  const NewFolder profile(temporary_folder()), work(folder);
  write_file(work.path(), "page", "html", page);
  const std::string pdf = work.path() + "/page.pdf";
  std::vector<std::string> words{browser,
                                 "--headless",
                                 "--disable-gpu",
                                 "--no-first-run",
                                 "--user-data-dir=" + profile.path(),
                                 "--no-pdf-header-footer",
                                 "--virtual-time-budget=20000",
                                 "--print-to-pdf=" + pdf};
  // The browser refuses to run as root with its sandbox. The page's own policy still applies: only its own
  // program runs, and nothing is fetched.
  if (::geteuid() == 0) words.push_back("--no-sandbox");
  words.push_back(file_url(work.path() + "/page.html"));
  const int status = run_silently(std::move(words));
  std::string text = status == 0 ? complete_pdf(pdf) : "";
  if (text.empty())
    throw OutputError("cannot print a PDF in " + folder + ": " + browser +
                      " could not print the page (disk full?); --report FILE.html needs no browser");
  return text;
}

}  // namespace drev::app
