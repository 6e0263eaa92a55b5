#include "app/base/progress.hpp"

#include <algorithm>
#include <cstdio>
#include <unistd.h>
#include <utility>

namespace drev::app {

namespace {

constexpr double kAnnounced = 120.0;  // s left: said before
constexpr double kMeasured = 1.5;     // s, after which the rate is measured, and over which

thread_local ProgressListener::Told* listener = nullptr;

}  // namespace

std::string rough_time(double seconds) {
  if (!(seconds < 3.6e6)) return "more than 1000 h";
  char text[32];
  if (seconds < 90.0)
    std::snprintf(text, sizeof text, "%.0f s", seconds);
  else if (seconds < 5400.0)
    std::snprintf(text, sizeof text, "%.0f min", seconds / 60.0);
  else
    std::snprintf(text, sizeof text, "%.1f h", seconds / 3600.0);
  return text;
}

ProgressListener::ProgressListener(Told told) : told_(std::move(told)), before_(listener) {
  listener = &told_;
}
ProgressListener::~ProgressListener() { listener = before_; }

Progress::Progress(std::function<std::string()> why_long)
    : terminal_(::isatty(STDERR_FILENO) != 0),
      why_long_(std::move(why_long)),
      start_(Clock::now()),
      drawn_(start_) {}

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
  const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
  const double left = elapsed * (1.0 - part) / part;
  if (listener != nullptr) {
    if (!(part > 0.0) || Clock::now() - drawn_ < std::chrono::milliseconds(100)) return;
    drawn_ = Clock::now();
    (*listener)(part, left);
    return;
  }
  if (why_long_ && part > 0.0 && elapsed >= kMeasured) {
    // A start in small steps tells nothing of the rest: the rate since then counts, if it is faster.
    if (!(measured_part_ > 0.0))
      measured_ = elapsed, measured_part_ = part;
    else if (elapsed >= measured_ + kMeasured && part > measured_part_)
      announce(std::min(left, (1.0 - part) * (elapsed - measured_) / (part - measured_part_)));
  }
  if (!due() || !(part > 0.0)) return;
  char text[32];
  std::snprintf(text, sizeof text, "%5.1f %%, ", 100.0 * part);
  draw(text + rough_time(left) + " left");
}

/// Once: whether the computation will take long, and why.
void Progress::announce(double left) {
  const std::function<std::string()> why_long = std::exchange(why_long_, nullptr);
  if (left < kAnnounced) return;
  clear();
  std::fprintf(stderr, "drev: this will take %s more: %s\n", rough_time(left).c_str(), why_long().c_str());
}

void Progress::show(const std::string& text) {
  constexpr std::size_t kColumns = 79;
  if (!due() || listener != nullptr) return;
  const auto elapsed = std::chrono::duration_cast<std::chrono::seconds>(Clock::now() - start_);
  const std::string line = std::to_string(elapsed.count()) + " s: " + text;
  draw(line.size() <= kColumns ? line : line.substr(0, kColumns - 3) + "...");
}

}  // namespace drev::app
