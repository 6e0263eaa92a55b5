#pragma once
/// Runs the drev executable as a user would.
#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <signal.h>
#include <string>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

namespace drev::test {

inline std::string read_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A directory of its own, removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "drev_test_XXXXXX").string();
    if (::mkdtemp(name.data()) != nullptr) path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

struct Outcome {
  int exit_code = -1;  ///< -1: ended by a signal
  std::string out, err;
};

/// What a drev may use; all there is unless said.
struct Limits {
  rlim_t file = RLIM_INFINITY;    ///< bytes of each file that it writes: a full disk's stand-in
  rlim_t memory = RLIM_INFINITY;  ///< bytes of its addresses
};

/// A running drev.
class Process {
 public:
  /// Its standard output goes to out_path, if one is given, and is not read back.
  explicit Process(const std::vector<std::string>& arguments, const std::string& out_path = {},
                   const Limits& limits = {})
      : kept_(out_path.empty()),
        out_(kept_ ? (folder_ / "out").string() : out_path),
        err_((folder_ / "err").string()) {
    std::vector<std::string> words{DREV_EXECUTABLE};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    id_ = ::fork();
    if (id_ != 0) return;
    const int out = ::open(out_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    const int err = ::open(err_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    ::dup2(out, STDOUT_FILENO);
    ::dup2(err, STDERR_FILENO);
    const rlimit file{limits.file, limits.file}, memory{limits.memory, limits.memory};
    ::setrlimit(RLIMIT_FSIZE, &file);
    ::setrlimit(RLIMIT_AS, &memory);
    // Where LAPACK is OpenBLAS, it takes memory for every processor, and waits for ever if it gets none.
    if (limits.memory != RLIM_INFINITY) ::setenv("OPENBLAS_NUM_THREADS", "1", 1);
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }

  void send(int signal) const { ::kill(id_, signal); }
  /// From now on, what it writes fits into files of so many bytes.
  void limit_files(rlim_t bytes) const {
    const rlimit file{bytes, bytes};
    ::prlimit(id_, RLIMIT_FSIZE, &file, nullptr);
  }

  Outcome wait() const {
    int status = 0;
    ::waitpid(id_, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, kept_ ? read_file(out_) : std::string(),
            read_file(err_)};
  }

 private:
  TemporaryFolder folder_;
  bool kept_;
  std::string out_, err_;
  pid_t id_ = -1;
};

inline Outcome drev_command(const std::vector<std::string>& arguments, const Limits& limits = {}) {
  return Process(arguments, {}, limits).wait();
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace drev::test
