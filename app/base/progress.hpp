#pragma once
/// How far a computation is and how long it will take, on stderr, if that is a terminal and the
/// computation takes more than a second. One that will take long says so once, on any stderr.
#include <chrono>
#include <functional>
#include <string>

namespace drev::app {

/// "40 s", "3 min", "2.5 h", "more than 1000 h".
std::string rough_time(double seconds);

/// While it lives, computations of the thread that made it tell `told` how far they are in place of stderr: the
/// part that is done, 0..1, and the seconds that are left; not more often than every 0.1 s.
class ProgressListener {
 public:
  using Told = std::function<void(double part, double left)>;
  explicit ProgressListener(Told told);
  ~ProgressListener();
  ProgressListener(const ProgressListener&) = delete;
  ProgressListener& operator=(const ProgressListener&) = delete;

 private:
  Told told_;
  Told* before_;
};

class Progress {
 public:
  /// why_long: what makes a computation take long, a sentence without full stop; asked at most once.
  explicit Progress(std::function<std::string()> why_long = {});
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// part: 0..1.
  void update(double part);
  /// A text in its place, after the time elapsed; cut to one line.
  void show(const std::string& text);
  /// Takes it away, so that something else can be printed.
  void clear();

 private:
  bool due() const;
  void draw(const std::string& text);
  void announce(double left);

  using Clock = std::chrono::steady_clock;
  bool terminal_, shown_ = false;
  std::function<std::string()> why_long_;
  Clock::time_point start_, drawn_;
  double measured_ = 0.0, measured_part_ = 0.0;  // s since the start, and the part done then
};

}  // namespace drev::app
