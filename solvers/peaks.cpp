#include "solvers/peaks.hpp"

namespace drev {

void Peaks::start(const Assembler& assembler, const StepPoint& point) {
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    const double value = channels_[c].evaluate(assembler, point.state);
    peaks_[c] = {value, point.state.t, value, point.state.t};
  }
}

void Peaks::step(const Assembler& assembler, const StepPoint& /*from*/, const StepPoint& to) {
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    const double value = channels_[c].evaluate(assembler, to.state);
    Peak& p = peaks_[c];
    if (value > p.max) p.max = value, p.max_time = to.state.t;
    if (value < p.min) p.min = value, p.min_time = to.state.t;
  }
}

std::size_t Peaks::largest() const {
  std::size_t best = 0;
  for (std::size_t c = 1; c < peaks_.size(); ++c)
    if (peaks_[c].amplitude() > peaks_[best].amplitude()) best = c;
  return best;
}

}  // namespace drev
