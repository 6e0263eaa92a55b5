#pragma once
/// SIGINT and SIGTERM, remembered until the computation asks; or what a program that has signals of its own says.
#include <functional>
#include <stdexcept>

namespace drev::app {

/// From here on the first SIGINT or SIGTERM is remembered; a second one of its kind ends the process, and so does
/// the first where no one asks for 10 s: exit code 130, files as they are when a process is killed. A
/// file that outgrows its limit is a failed write, not a signal. Where an InterruptSource lives, nothing: the
/// program has signals of its own.
void watch_signals();
bool interrupted();
/// Until watch_signals(): either signal ends the process at once, with a sentence and exit code 130. One that is ignored
/// already (nohup) stays so.
void end_on_signals();

/// A computation that was ended so.
class Interruption : public std::runtime_error {
 public:
  Interruption() : std::runtime_error("interrupted") {}
};
/// Throws Interruption where interrupted() says so: for computations that pause() now and then.
void end_if_interrupted();

/// While it lives, interrupted() asks `asked` too in the thread that made it.
class InterruptSource {
 public:
  explicit InterruptSource(std::function<bool()> asked);
  ~InterruptSource();
  InterruptSource(const InterruptSource&) = delete;
  InterruptSource& operator=(const InterruptSource&) = delete;

 private:
  std::function<bool()> asked_;
  std::function<bool()>* before_;
};

}  // namespace drev::app
