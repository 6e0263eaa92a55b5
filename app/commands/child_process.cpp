#include "app/commands/child_process.hpp"

#include <cerrno>
#include <csignal>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

namespace drev::app {

namespace {

std::string text_of(int descriptor) {
  std::string text;
  char part[4096];
  while (true) {
    const ssize_t count = ::pread(descriptor, part, sizeof part, static_cast<off_t>(text.size()));
    if (count <= 0) return text;
    text.append(part, static_cast<std::size_t>(count));
  }
}

}  // namespace

ChildProcess::InMemory::InMemory() : descriptor(::memfd_create("drev", MFD_CLOEXEC)) {
  if (descriptor < 0) throw std::system_error(errno, std::generic_category(), "cannot keep a run's output");
}

ChildProcess::InMemory::~InMemory() { ::close(descriptor); }

ChildProcess::ChildProcess(const std::vector<std::string>& arguments) {
  std::vector<std::string> words{"drev"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const pid_t parent = ::getpid();
  std::signal(SIGCHLD, SIG_DFL);  // ignored by whoever started drev, its end would not be told
  id_ = ::fork();
  if (id_ < 0) throw std::system_error(errno, std::generic_category(), "cannot start a run");
  if (id_ > 0) return;
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (::getppid() != parent) ::_exit(127);  // it died before
  ::setpgid(0, 0);
  const int nothing = ::open("/dev/null", O_RDONLY);
  if (nothing >= 0 && ::dup2(nothing, STDIN_FILENO) >= 0 && ::dup2(out_.descriptor, STDOUT_FILENO) >= 0 &&
      ::dup2(err_.descriptor, STDERR_FILENO) >= 0)
    ::execv("/proc/self/exe", argv.data());
  ::_exit(127);
}

ChildProcess::~ChildProcess() {
  if (!ended_) {
    stop();
    while (::waitpid(id_, &status_, 0) < 0 && errno == EINTR) {
    }
  }
}

bool ChildProcess::ended() {
  if (!ended_) ended_ = ::waitpid(id_, &status_, WNOHANG) == id_;
  return ended_;
}

void ChildProcess::stop() const { ::kill(id_, SIGTERM); }

int ChildProcess::exit_code() const { return WIFEXITED(status_) ? WEXITSTATUS(status_) : -1; }
int ChildProcess::signal() const { return WIFSIGNALED(status_) ? WTERMSIG(status_) : 0; }
std::string ChildProcess::out() const { return text_of(out_.descriptor); }
std::string ChildProcess::err() const { return text_of(err_.descriptor); }

}  // namespace drev::app
