#include "solvers/peaks.hpp"

#include <cmath>

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
    if (value > p.max) p.max = value, p.max_time = to.state.t;
    if (value < p.min) p.min = value, p.min_time = to.state.t;
    if (inside_steps_ && (higher > p.max - near || lower < p.min + near))
      look_inside(c, assembler, from, to);
  }
}

void Peaks::look_inside(std::size_t c, const Assembler& assembler, const StepPoint& from,
                        const StepPoint& to) {
  const std::optional<double> rate_0 = channels_[c].rate(from.state);
  const std::optional<double> rate_1 = channels_[c].rate(to.state);
  if (!rate_0 || !rate_1 || *rate_0 * *rate_1 >= 0.0) return;
  // y(s) = y_0 + d_0 s + (3 D - 2 d_0 - d_1) s^2 + (d_0 + d_1 - 2 D) s^3 with d = rate h, D = y_1 - y_0.
  const double h = to.state.t - from.state.t;
  const double y_0 = channels_[c].evaluate(assembler, from.state);
  const double y_1 = channels_[c].evaluate(assembler, to.state);
  const double d_0 = *rate_0 * h, d_1 = *rate_1 * h, rise = y_1 - y_0;
  const double b = 3 * rise - 2 * d_0 - d_1, a = d_0 + d_1 - 2 * rise;
  // The root of d_0 + 2 b s + 3 a s^2 between 0 and 1, where the slope changes sign once.
  const double root = std::sqrt(std::max(b * b - 3 * a * d_0, 0.0));
  const double s = d_0 / (d_0 > 0.0 ? root - b : -root - b);
  if (!(s > 0.0 && s < 1.0)) return;
  const double y = y_0 + s * (d_0 + s * (b + s * a));
  Peak& p = peaks_[c];
  if (y > p.max) p.max = y, p.max_time = from.state.t + s * h;
  if (y < p.min) p.min = y, p.min_time = from.state.t + s * h;
}

std::size_t Peaks::largest() const {
  std::size_t best = 0;
  for (std::size_t c = 1; c < peaks_.size(); ++c)
    if (peaks_[c].amplitude() > peaks_[best].amplitude()) best = c;
  return best;
}

}  // namespace drev
