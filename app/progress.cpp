#include "app/progress.hpp"

#include <unistd.h>

#include <cstdio>

namespace drev::app {

Progress::Progress()
    : terminal_(::isatty(STDERR_FILENO) != 0), start_(Clock::now()), drawn_(start_) {}

Progress::~Progress() {
  if (!shown_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
}

void Progress::update(double part) {
  if (!terminal_) return;
  const Clock::time_point now = Clock::now();
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  if (elapsed < 1.0 || now - drawn_ < std::chrono::milliseconds(200) || !(part > 0.0)) return;
  drawn_ = now;
  shown_ = true;
  const double left = elapsed * (1.0 - part) / part;
  if (left < 90.0)
    std::fprintf(stderr, "\r\033[K%5.1f %%, %.0f s left", 100.0 * part, left);
  else if (left < 5400.0)
    std::fprintf(stderr, "\r\033[K%5.1f %%, %.0f min left", 100.0 * part, left / 60.0);
  else
    std::fprintf(stderr, "\r\033[K%5.1f %%, %.1f h left", 100.0 * part, left / 3600.0);
  std::fflush(stderr);
}

}  // namespace drev::app
