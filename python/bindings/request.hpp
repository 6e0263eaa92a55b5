#pragma once
/// The request of Python to a command, and the link between both during the computation: the interpreter's
/// lock is released, Ctrl-C ends the computation in order, and progress is given to a callable.
#include <atomic>
#include <chrono>
#include <future>
#include <map>
#include <memory>
#include <nanobind/nanobind.h>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "app/base/interrupt.hpp"
#include "app/base/progress.hpp"
#include "app/cli/command_line.hpp"

namespace drev {
class System;
}

namespace drev::python {

namespace nb = nanobind;

/// Asks computations to end, from any thread.
class Stop {
 public:
  void set() { asked_ = true; }
  bool is_set() const { return asked_; }

 private:
  std::atomic<bool> asked_ = false;
};

struct Request {
  std::string command;              ///< name of the command as on the command line: "run"
  std::string model = {};           ///< name or file of the model; for a model made in Python its name
  std::optional<std::string> text;  ///< text of the model file of a model made in Python
  std::vector<std::pair<std::string, std::string>> parameters = {};
  std::map<std::string, std::vector<std::string>> options = {};
  nb::object told = nb::none();  ///< called with (part, seconds left); none: progress goes to the terminal
  std::shared_ptr<Stop> stop = {};

  app::CommandLine line() const;
};

/// During its lifetime, computations of this thread ask Python for signals and report their progress to it.
class Watch {
 public:
  explicit Watch(const Request& request);
  ~Watch();
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;
  /// Ended by Ctrl-C or by Stop. A signal handler of Python that raised something else has it raised here.
  bool stopped();
  /// Then KeyboardInterrupt.
  void raise_if_stopped();
  /// Ends what this thread computes, as Ctrl-C does; false: it computes nothing.
  static bool stop_current();

 private:
  bool asked();
  void tell(double part, double left);

  using Clock = std::chrono::steady_clock;
  nb::object told_;
  std::shared_ptr<Stop> stop_;
  std::optional<nb::python_error> raised_;
  bool stopped_ = false;
  Clock::time_point asked_at_ = {};
  Watch* before_;
  app::InterruptSource source_;
  std::optional<app::ProgressListener> listener_;
};

/// A computation of answered(), as long as it exists.
class Computing {
 public:
  Computing() { ++running_; }
  ~Computing() { --running_; }
  Computing(const Computing&) = delete;
  Computing& operator=(const Computing&) = delete;
  /// From now on the process ends at once, behind what it has written, where one still runs: leaving main() takes the memory of
  /// libraries that it computes with (OpenBLAS).
  static void end_process_at_once();

 private:
  static std::atomic<int> running_;
};

/// Runs compute() in a separate thread while this one asks for signals, for computations that cannot be
/// interrupted. On an interruption it throws app::Interruption at once; the thread continues to its end with
/// the objects that compute() holds, and its result is lost. To be called without Python's lock.
template <class Compute>
auto answered(Compute compute) {
  std::packaged_task<decltype(compute())()> task(std::move(compute));
  auto result = task.get_future();
  std::thread([own = std::make_unique<Computing>(), task = std::move(task)]() mutable { task(); }).detach();
  while (result.wait_for(std::chrono::milliseconds(20)) != std::future_status::ready)
    app::end_if_interrupted();
  return result.get();
}

/// The undamped modes of a model that was built.
nb::object modes_of(const System& system, std::optional<int> count, const std::string& contact);

/// Translates C++ exceptions to those of drev._errors.
void bind_errors(nb::module_& module);
void bind_commands(nb::module_& module);
void bind_run(nb::module_& module);
void bind_modes(nb::module_& module);
void bind_system(nb::module_& module);
void bind_callables(nb::module_& module);
void bind_study(nb::module_& module);

}  // namespace drev::python
