#pragma once
/// How far a computation is and how long it will take, on stderr, if that is a terminal and the
/// computation takes more than a second.
#include <chrono>
#include <string>

namespace drev::app {

class Progress {
 public:
  Progress();
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

  using Clock = std::chrono::steady_clock;
  bool terminal_, shown_ = false;
  Clock::time_point start_, drawn_;
};

}  // namespace drev::app
