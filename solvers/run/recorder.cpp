#include <drev/core/assembler.hpp>
#include <drev/core/error.hpp>
#include <drev/solvers/run/evaluated_state.hpp>
#include <drev/solvers/run/recorder.hpp>

#include <algorithm>

namespace drev {

namespace {
constexpr double kSameTime = 1e-9;  // relative to the interval
}

Recorder::Recorder(const System& system, const std::vector<std::string>& channels, double every)
    : channels_(find_channels(system, channels)),
      every_(every),
      row_(channels.size()),
      samples_(channels.size()) {
  std::vector<Finding> findings;
  ParameterCheck(system.name(), findings).positive("recording interval", every, "s");
  if (!findings.empty()) throw ModelError(findings);
}

void Recorder::start(const Assembler& assembler, const EvaluatedState& point) {
  start_ = point.state.t;
  next_ = 0;
  record(assembler, point);
}

void Recorder::step(const Assembler& assembler, const EvaluatedState& /*from*/, const EvaluatedState& to) {
  // A stop that differs from k * every by rounding (t_end, a breakpoint) is that time.
  if (to.state.t >= next_stop(0.0) - kSameTime * every_) record(assembler, to);
}

double Recorder::next_stop(double /*t*/) const { return start_ + static_cast<double>(next_) * every_; }

bool Recorder::needs_acceleration() const {
  return std::any_of(channels_.begin(), channels_.end(),
                     [](const Channel& c) { return c.value_needs_acceleration(); });
}

void Recorder::record(const Assembler& assembler, const EvaluatedState& point) {
  for (std::size_t c = 0; c < channels_.size(); ++c) row_[c] = channels_[c].evaluate(assembler, point.state);
  ++next_;
  if (sink_) {
    sink_(point.state.t, row_);
    return;
  }
  times_.push_back(point.state.t);
  for (std::size_t c = 0; c < channels_.size(); ++c) samples_[c].push_back(row_[c]);
}

}  // namespace drev
