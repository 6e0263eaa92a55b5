#include "python/bindings/request.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "app/commands/commands.hpp"

namespace drev::python {

namespace {

thread_local Watch* current = nullptr;

constexpr auto kBetweenQuestions = std::chrono::milliseconds(20);  // shortest time between lockings

}  // namespace

app::CommandLine Request::line() const {
  const std::vector<app::CommandEntry>& all = app::commands();
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const app::CommandEntry& entry) { return entry.name == command; });
  if (found == all.end()) throw nb::value_error(("drev has no command " + command).c_str());
  app::CommandLine line;
  line.command = &*found;
  line.model = model;
  line.text = text;
  line.parameters = parameters;
  line.options = options;
  line.json = true;
  return line;
}

Watch::Watch(const Request& request)
    : told_(request.told), stop_(request.stop), before_(current), source_([this] { return asked(); }) {
  current = this;
  if (!told_.is_none()) listener_.emplace([this](double part, double left) { tell(part, left); });
}

Watch::~Watch() { current = before_; }

bool Watch::stop_current() {
  if (current != nullptr) current->stopped_ = true;
  return current != nullptr;
}

bool Watch::asked() {
  if (stopped_ || (stop_ && stop_->is_set())) return stopped_ = true;
  if (Clock::now() - asked_at_ < kBetweenQuestions) return false;
  asked_at_ = Clock::now();
  const nb::gil_scoped_acquire locked;
  if (PyErr_CheckSignals() == 0) return false;
  nb::python_error raised;
  if (!raised.matches(PyExc_KeyboardInterrupt)) raised_.emplace(std::move(raised));
  return stopped_ = true;
}

void Watch::tell(double part, double left) {
  if (stopped_) return;
  const nb::gil_scoped_acquire locked;
  try {
    told_(part, left);
  } catch (nb::python_error& error) {
    if (!error.matches(PyExc_KeyboardInterrupt)) raised_.emplace(std::move(error));
    stopped_ = true;
  }
}

void Watch::raise_if_stopped() {
  if (!stopped()) return;
  PyErr_SetNone(PyExc_KeyboardInterrupt);
  throw nb::python_error();
}

std::atomic<int> Computing::running_ = 0;

void Computing::end_process_at_once() {
  ::on_exit(
      [](int status, void*) {
        if (running_ == 0) return;
        std::fflush(nullptr);
        std::_Exit(status);
      },
      nullptr);
}

bool Watch::stopped() {
  if (raised_) throw nb::python_error(std::move(*raised_));
  return stopped_;
}

}  // namespace drev::python
