#pragma once
/// How far a computation is and how long it will take, on stderr, if that is a terminal and the
/// computation takes more than a second.
#include <chrono>

namespace drev::app {

class Progress {
 public:
  Progress();
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// part: 0..1.
  void update(double part);

 private:
  using Clock = std::chrono::steady_clock;
  bool terminal_, shown_ = false;
  Clock::time_point start_, drawn_;
};

}  // namespace drev::app
