#include "app/base/interrupt.hpp"

#include <csignal>
#include <unistd.h>
#include <utility>

namespace drev::app {

namespace {

volatile std::sig_atomic_t caught = 0;
thread_local std::function<bool()>* source = nullptr;

constexpr unsigned kPatience = 10;  // s

void remember(int /*signal*/) {
  caught = 1;
  ::alarm(kPatience);
}

template <std::size_t kSize>
[[noreturn]] void end_saying(const char (&text)[kSize]) {
  const ssize_t ignored = ::write(STDERR_FILENO, text, kSize - 1);
  static_cast<void>(ignored);
  ::_exit(130);
}

/// No one has asked for so long: what goes on does not, and must not go on for ever.
void give_up(int /*signal*/) {
  end_saying("drev: interrupted in the midst of a computation that cannot be ended in order\n");
}

void end_at_once(int /*signal*/) { end_saying("drev: interrupted; nothing is written\n"); }

}  // namespace

void end_on_signals() {
  for (const int signal : {SIGINT, SIGTERM}) {
    struct sigaction action {};
    sigaction(signal, nullptr, &action);
    if (action.sa_handler == SIG_IGN) continue;
    action.sa_handler = end_at_once;
    sigaction(signal, &action, nullptr);
  }
}

void watch_signals() {
  if (source != nullptr) return;
  struct sigaction action {};
  action.sa_handler = remember;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  action.sa_handler = give_up;
  sigaction(SIGALRM, &action, nullptr);
}

bool interrupted() {
  if (caught != 0) ::alarm(kPatience);
  return caught != 0 || (source != nullptr && (*source)());
}

void end_if_interrupted() {
  if (interrupted()) throw Interruption();
}

InterruptSource::InterruptSource(std::function<bool()> asked) : asked_(std::move(asked)), before_(source) {
  source = &asked_;
}
InterruptSource::~InterruptSource() { source = before_; }

}  // namespace drev::app
