#include <drev/core/assembler.hpp>
#include <drev/core/error.hpp>
#include <drev/solvers/run/evaluated_state.hpp>
#include <drev/solvers/run/recorder.hpp>

namespace drev {

namespace {
constexpr double kSameTime = 1e-9;  // relative to the interval
}

Recorder::Recorder(const System& system, const std::vector<std::string>& channels, double every)
    : values_(find_channels(system, channels, OverRun::taken)),
      every_(every),
      row_(values_.channels().size()),
      samples_(values_.channels().size()) {
  std::vector<Finding> findings;
  ParameterCheck(system.name(), findings).positive("recording interval", every, "s");
  if (!findings.empty()) throw ModelError(findings);
}

void Recorder::start(const Assembler& assembler, const EvaluatedState& point) {
  start_ = point.state.t;
  next_ = 0;
  values_.start(assembler, point);
  record(assembler, point);
}

void Recorder::step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) {
  values_.step(assembler, from, to);
  // A stop that differs from k * every by rounding (t_end, a breakpoint) is that time.
  if (to.state.t >= next_stop(0.0) - kSameTime * every_) record(assembler, to);
}

double Recorder::next_stop(double /*t*/) const { return start_ + static_cast<double>(next_) * every_; }

void Recorder::record(const Assembler& assembler, const EvaluatedState& point) {
  for (std::size_t c = 0; c < row_.size(); ++c) row_[c] = values_.value(c, assembler, point);
  ++next_;
  if (sink_) {
    sink_(point.state.t, row_);
    return;
  }
  times_.push_back(point.state.t);
  for (std::size_t c = 0; c < row_.size(); ++c) samples_[c].push_back(row_[c]);
}

}  // namespace drev
