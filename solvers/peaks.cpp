#include "solvers/peaks.hpp"

#include "solvers/cubic_peak.hpp"

namespace drev {

namespace {
constexpr double kNear = 0.05;  // of the range so far: steps that may hold a new peak inside
}

void Peaks::start(const Assembler& assembler, const StepPoint& point) {
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    const double value = channels_[c].evaluate(assembler, point.state);
    peaks_[c] = {value, point.state.t, value, point.state.t};
    last_[c] = value;
  }
}

void Peaks::step(const Assembler& assembler, const StepPoint& from, const StepPoint& to) {
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    const double value = channels_[c].evaluate(assembler, to.state);
    Peak& p = peaks_[c];
    const double higher = std::max(value, last_[c]), lower = std::min(value, last_[c]);
    const double near = kNear * (p.max - p.min);
    last_[c] = value;
    p.note(value, to.state.t);
    if (inside_steps_ && (higher > p.max - near || lower < p.min + near))
      look_inside(c, assembler, from, to);
  }
}

void Peaks::look_inside(std::size_t c, const Assembler& assembler, const StepPoint& from,
                        const StepPoint& to) {
  const std::optional<double> rate_0 = channels_[c].rate(assembler, from.state);
  const std::optional<double> rate_1 = channels_[c].rate(assembler, to.state);
  if (!rate_0 || !rate_1) return;
  const double h = to.state.t - from.state.t;
  const auto inside = cubic_peak(channels_[c].evaluate(assembler, from.state), *rate_0,
                                 channels_[c].evaluate(assembler, to.state), *rate_1, h);
  if (inside) peaks_[c].note(inside->value, from.state.t + inside->s * h);
}

std::size_t Peaks::largest() const {
  std::size_t best = 0;
  for (std::size_t c = 1; c < peaks_.size(); ++c)
    if (peaks_[c].amplitude() > peaks_[best].amplitude()) best = c;
  return best;
}

}  // namespace drev
