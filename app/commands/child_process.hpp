#pragma once
/// Another drev, with what it prints kept; what becomes of it does not touch this one.
#include <string>
#include <sys/types.h>
#include <vector>

namespace drev::app {

class ChildProcess {
 public:
  /// Starts this program with the arguments. It has a process group of its own, so that a Ctrl-C is this
  /// one's to pass on, and gets SIGTERM when this one dies. Throws std::system_error.
  explicit ChildProcess(const std::vector<std::string>& arguments);
  /// Stops it and waits for it, if it has not ended.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Whether it has ended; does not wait.
  bool ended();
  /// Asks it to come to an end (SIGTERM).
  void stop() const;

  /// When it has ended: its exit code, or -1 with the signal that ended it.
  int exit_code() const;
  int signal() const;
  std::string out() const;
  std::string err() const;

 private:
  /// A file without a name.
  struct InMemory {
    InMemory();
    ~InMemory();
    InMemory(const InMemory&) = delete;
    InMemory& operator=(const InMemory&) = delete;
    const int descriptor;
  };
  pid_t id_ = -1;
  bool ended_ = false;
  int status_ = 0;
  InMemory out_, err_;
};

}  // namespace drev::app
