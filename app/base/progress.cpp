#include "app/base/progress.hpp"

#include <cstdio>
#include <unistd.h>

namespace drev::app {

Progress::Progress() : terminal_(::isatty(STDERR_FILENO) != 0), start_(Clock::now()), drawn_(start_) {}

Progress::~Progress() { clear(); }

void Progress::clear() {
  if (!shown_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
  shown_ = false;
}

bool Progress::due() const {
  const Clock::time_point now = Clock::now();
  return terminal_ && now - start_ >= std::chrono::seconds(1) &&
         now - drawn_ >= std::chrono::milliseconds(200);
}

void Progress::draw(const std::string& text) {
  drawn_ = Clock::now();
  shown_ = true;
  std::fprintf(stderr, "\r\033[K%s", text.c_str());
  std::fflush(stderr);
}

void Progress::update(double part) {
  if (!due() || !(part > 0.0)) return;
  const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
  const double left = elapsed * (1.0 - part) / part;
  char text[64];
  if (left < 90.0)
    std::snprintf(text, sizeof text, "%5.1f %%, %.0f s left", 100.0 * part, left);
  else if (left < 5400.0)
    std::snprintf(text, sizeof text, "%5.1f %%, %.0f min left", 100.0 * part, left / 60.0);
  else
    std::snprintf(text, sizeof text, "%5.1f %%, %.1f h left", 100.0 * part, left / 3600.0);
  draw(text);
}

void Progress::show(const std::string& text) {
  constexpr std::size_t kColumns = 79;
  if (!due()) return;
  const auto elapsed = std::chrono::duration_cast<std::chrono::seconds>(Clock::now() - start_);
  const std::string line = std::to_string(elapsed.count()) + " s: " + text;
  draw(line.size() <= kColumns ? line : line.substr(0, kColumns - 3) + "...");
}

}  // namespace drev::app
