// The importer's side of FMI 2.0 and 3.0, declared from the standard's text (fmi-standard.org, versions 2.0.4 and 3.0).
#include "app/fmi/import/imported_instance.hpp"

#include <drev/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>

namespace drev::app {

namespace {

constexpr int kWarning = 1, kFatal = 4;  // status codes of FMI
constexpr int kCoSimulation = 1;         // value of fmi2Type
constexpr std::size_t kLinesKept = 8, kLongestLine = 2000;

/// The last messages of an FMU.
class Log {
 public:
  void add(const char* text) {
    if (text == nullptr) return;
    std::string line(text, strnlen(text, kLongestLine));
    while (!line.empty() && line.back() == '\n') line.pop_back();
    std::replace(line.begin(), line.end(), '\n', ' ');
    if (line.empty()) return;
    lines_.push_back(std::move(line));
    if (lines_.size() > kLinesKept) lines_.pop_front();
  }
  /// Returns "; it logged: ..." and clears the messages.
  std::string take() {
    std::string all;
    for (const std::string& line : lines_) all += (all.empty() ? "; the FMU logged: " : " | ") + line;
    lines_.clear();
    return all.empty() ? "; the FMU logged nothing" : all;
  }

 private:
  std::deque<std::string> lines_;
};

extern "C" {
void drev_log_2(void* log, const char* /*instance*/, int /*status*/, const char* /*category*/,
                const char* format, ...) {
  if (log == nullptr || format == nullptr) return;
  char text[kLongestLine];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  static_cast<Log*>(log)->add(text);
}
void drev_log_3(void* log, int /*status*/, const char* /*category*/, const char* text) {
  if (log != nullptr) static_cast<Log*>(log)->add(text);
}
}

struct Callbacks {
  void (*logger)(void*, const char*, int, const char*, const char*, ...) = drev_log_2;
  void* (*allocate)(std::size_t, std::size_t) = std::calloc;
  void (*release)(void*) = std::free;
  void (*step_finished)(void*, int) = nullptr;
  void* environment = nullptr;
};

using Reference = std::uint32_t;
using Type = ImportedVariable::Type;

/// The part that both versions share: the functions of the library, and the treatment of their status.
class Instance : public ImportedInstance {
 public:
  Instance(std::shared_ptr<const UnpackedFmu> fmu, int version)
      : fmu_(std::move(fmu)), prefix_("fmi" + std::to_string(version)) {}
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  void exit_initialization() override {
    call("ExitInitializationMode", {}, self_);
    running_ = true;
  }

  std::string warning() const override {
    if (warnings_ < 2) return warning_;
    return warning_ + "; it was the first of " + std::to_string(warnings_) + " warnings";
  }

 protected:
  /// Calls a function of the library by its name without prefix and judges its status. The arguments' types are those of
  /// the standard's prototype. about: the variable or time, for the message.
  template <class... Arguments>
  void call(const char* name, const std::string& about, Arguments... arguments) {
    const std::string full = prefix_ + name;
    judge(reinterpret_cast<int (*)(Arguments...)>(fmu_->function(full))(arguments...), full, about);
  }

  [[noreturn]] void fail(const std::string& why) {
    throw std::runtime_error(fmu_->name() + ": " + why + log_.take());
  }

  void judge(int status, const std::string& name, const std::string& about) {
    if (status <= kWarning) {
      if (status == kWarning && ++warnings_ == 1)
        warning_ = fmu_->name() + ": " + answer(name, about, "warning") + log_.take();
      return;
    }
    failed_ = true;
    if (status == kFatal) self_ = nullptr;  // nothing may be called any more
    const char* words[] = {"discard", "error", "fatal error", "pending"};
    fail(answer(name, about, status <= 5 ? words[status - 2] : std::to_string(status)));
  }

  static std::string answer(const std::string& name, const std::string& about, const std::string& word) {
    return name + (about.empty() ? "" : " (" + about + ")") + " answered '" + word + "'";
  }

  void end() {
    if (self_ == nullptr) return;
    if (running_ && !failed_) reinterpret_cast<int (*)(void*)>(fmu_->function(prefix_ + "Terminate"))(self_);
    reinterpret_cast<void (*)(void*)>(fmu_->function(prefix_ + "FreeInstance"))(self_);
    self_ = nullptr;
  }

  static std::string step_text(double t, double h) {
    return "t = " + to_text(t) + " s, step " + to_text(h) + " s";
  }

  std::shared_ptr<const UnpackedFmu> fmu_;
  std::string prefix_;
  Log log_;
  void* self_ = nullptr;
  bool running_ = false, failed_ = false;
  long warnings_ = 0;
  std::string warning_;  // the first
};

class Instance2 final : public Instance {
 public:
  Instance2(std::shared_ptr<const UnpackedFmu> fmu, const std::string& name) : Instance(std::move(fmu), 2) {
    callbacks_.environment = &log_;
    const std::string uri = "file://" + fmu_->resources().string();
    using Make = void*(const char*, int, const char*, const char*, const Callbacks*, int, int);
    self_ = reinterpret_cast<Make*>(fmu_->function("fmi2Instantiate"))(
        name.c_str(), kCoSimulation, fmu_->description().token.c_str(), uri.c_str(), &callbacks_, 0, 1);
    if (self_ == nullptr) fail("fmi2Instantiate made no instance");
  }
  ~Instance2() override { end(); }

  void set(const ImportedVariable& v, double value) override {
    const std::string about = v.name + " = " + to_text(value);
    const auto whole = static_cast<int>(std::lround(value));
    if (v.type == Type::real)
      set_one("SetReal", v, value, about);
    else
      set_one(v.type == Type::boolean ? "SetBoolean" : "SetInteger", v, whole, about);
  }
  void set_text(const ImportedVariable& v, const std::string& value) override {
    set_one("SetString", v, value.c_str(), v.name + " = " + value);
  }
  void set_slope(const ImportedVariable& v, double slope) override {
    const Reference reference = v.reference;
    const int order = 1;
    call("SetRealInputDerivatives", v.name, self_, &reference, std::size_t{1}, &order, &slope);
  }
  double get(const ImportedVariable& v) override {
    const Reference reference = v.reference;
    double value = 0.0;
    call("GetReal", v.name, self_, &reference, std::size_t{1}, &value);
    return value;
  }
  void enter_initialization(double t_start, double t_end) override {
    call("SetupExperiment", {}, self_, 0, 0.0, t_start, 1, t_end);
    call("EnterInitializationMode", {}, self_);
  }
  void step(double t, double h) override { call("DoStep", step_text(t, h), self_, t, h, 1); }

 private:
  template <class Value>
  void set_one(const char* name, const ImportedVariable& v, Value value, const std::string& about) {
    const Reference reference = v.reference;
    call(name, about, self_, &reference, std::size_t{1}, &value);
  }

  Callbacks callbacks_;
};

class Instance3 final : public Instance {
 public:
  Instance3(std::shared_ptr<const UnpackedFmu> fmu, const std::string& name) : Instance(std::move(fmu), 3) {
    const std::string folder = fmu_->resources().string() + "/";
    using Make = void*(const char*, const char*, const char*, bool, bool, bool, bool, const Reference*,
                       std::size_t, void*, void (*)(void*, int, const char*, const char*), void*);
    self_ = reinterpret_cast<Make*>(fmu_->function("fmi3InstantiateCoSimulation"))(
        name.c_str(), fmu_->description().token.c_str(), folder.c_str(), false, true, false, false, nullptr,
        0, &log_, drev_log_3, nullptr);
    if (self_ == nullptr) fail("fmi3InstantiateCoSimulation made no instance");
  }
  ~Instance3() override { end(); }

  void set(const ImportedVariable& v, double value) override {
    const std::string about = v.name + " = " + to_text(value);
    if (v.type == Type::real)
      set_one("SetFloat64", v, value, about);
    else if (v.type == Type::boolean)
      set_one("SetBoolean", v, value != 0.0, about);
    else
      set_one("SetInt32", v, static_cast<std::int32_t>(std::lround(value)), about);
  }
  void set_text(const ImportedVariable& v, const std::string& value) override {
    set_one("SetString", v, value.c_str(), v.name + " = " + value);
  }
  void set_slope(const ImportedVariable& v, double /*slope*/) override {
    fail("input " + v.name + ": FMI 3 has no derivatives of inputs");
  }
  double get(const ImportedVariable& v) override {
    const Reference reference = v.reference;
    double value = 0.0;
    call("GetFloat64", v.name, self_, &reference, std::size_t{1}, &value, std::size_t{1});
    return value;
  }
  void enter_initialization(double t_start, double t_end) override {
    call("EnterInitializationMode", {}, self_, false, 0.0, t_start, true, t_end);
  }
  void step(double t, double h) override {
    bool event = false, ends = false, early = false;
    double reached = t + h;
    const std::string about = step_text(t, h);
    call("DoStep", about, self_, t, h, true, &event, &ends, &early, &reached);
    if (early)
      fail("fmi3DoStep (" + about + ") ended early, at " + to_text(reached) +
           " s, though that is not allowed");
    if (ends) fail("it asked for the simulation to end at " + to_text(reached) + " s");
  }

 private:
  template <class Value>
  void set_one(const char* name, const ImportedVariable& v, Value value, const std::string& about) {
    const Reference reference = v.reference;
    call(name, about, self_, &reference, std::size_t{1}, &value, std::size_t{1});
  }
};

}  // namespace

std::unique_ptr<ImportedInstance> instantiate(std::shared_ptr<const UnpackedFmu> fmu,
                                              const std::string& name) {
  if (fmu->description().fmi == 3) return std::make_unique<Instance3>(std::move(fmu), name);
  return std::make_unique<Instance2>(std::move(fmu), name);
}

}  // namespace drev::app
