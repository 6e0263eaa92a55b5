#include <drev/core/assembler.hpp>
#include <drev/solvers/run/evaluated_state.hpp>
#include <drev/solvers/run/peaks.hpp>

#include <algorithm>

#include "solvers/run/cubic_peak.hpp"

namespace drev {

namespace {
constexpr double kNear = 0.05;  // of the range so far: steps that may hold a new peak inside
}

Peaks::Peaks(std::vector<Channel> channels, bool inside_steps)
    : channels_(std::move(channels)),
      peaks_(channels_.size()),
      watched_(channels_.size()),
      inside_steps_(inside_steps) {
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    const std::vector<Entry>& row = channels_[c].z_row();
    if (!channels_[c].is_linear() || row.size() > 2 || !channels_[c].v_row().empty()) continue;
    watched_[c].two_entries = true;
    if (!row.empty()) watched_[c].first = row[0];
    if (row.size() == 2) watched_[c].second = row[1];
  }
}

void Peaks::start(const Assembler& assembler, const EvaluatedState& point) {
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    const double value = channels_[c].evaluate(assembler, point.state);
    peaks_[c] = {{value, point.state.t, value, point.state.t}};
    watched_[c].last = value;
    set_bounds(c);
  }
}

void Peaks::step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) {
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    Watched& w = watched_[c];
    const double value = w.two_entries ? w.sum(to.state.z) : channels_[c].evaluate(assembler, to.state);
    const double higher = std::max(value, w.last), lower = std::min(value, w.last);
    w.last = value;
    if (higher <= w.high && lower >= w.low) continue;
    Peak& p = peaks_[c];
    const double near = kNear * (p.max - p.min);
    p.note(value, to.state.t);
    if (inside_steps_ && (higher > p.max - near || lower < p.min + near)) look_inside(c, assembler, from, to);
    set_bounds(c);
  }
}

void Peaks::set_bounds(std::size_t c) {
  const Peak& p = peaks_[c];
  const double near = inside_steps_ ? kNear * (p.max - p.min) : 0.0;
  watched_[c].low = p.min + near;
  watched_[c].high = p.max - near;
}

bool Peaks::needs_acceleration() const {
  return std::any_of(channels_.begin(), channels_.end(), [this](const Channel& c) {
    return c.value_needs_acceleration() || (inside_steps_ && c.rate_needs_acceleration());
  });
}

void Peaks::look_inside(std::size_t c, const Assembler& assembler, const EvaluatedState& from,
                        const EvaluatedState& to) {
  const auto rate = [&](const State& s) {
    return watched_[c].two_entries ? watched_[c].sum(s.v) : channels_[c].rate(assembler, s);
  };
  const std::optional<double> rate_0 = rate(from.state), rate_1 = rate(to.state);
  if (!rate_0 || !rate_1 || !(*rate_0 * *rate_1 < 0.0)) return;
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
