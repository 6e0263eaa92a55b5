#include "app/base/interrupt.hpp"

#include <csignal>

namespace drev::app {

namespace {

volatile std::sig_atomic_t caught = 0;

void remember(int /*signal*/) { caught = 1; }

}  // namespace

void watch_signals() {
  struct sigaction action {};
  action.sa_handler = remember;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  std::signal(SIGXFSZ, SIG_IGN);
}

bool interrupted() { return caught != 0; }

}  // namespace drev::app
