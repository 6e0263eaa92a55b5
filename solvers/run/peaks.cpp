#include <drev/core/assembler.hpp>
#include <drev/solvers/run/evaluated_state.hpp>
#include <drev/solvers/run/peaks.hpp>

#include <algorithm>

#include "solvers/run/cubic_peak.hpp"
#include "solvers/run/peak_search.hpp"

namespace drev {

namespace {
constexpr double kNear = 0.05;   // of the range so far: steps that may hold a new peak inside
constexpr double kShort = 1e-6;  // of the longest step: nothing moves in shorter ones
}  // namespace

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

double Peaks::value(std::size_t c, const Assembler& assembler, const EvaluatedState& point) const {
  return watched_[c].two_entries ? watched_[c].sum(point.state.z)
                                 : channels_[c].evaluate(assembler, point.state);
}

std::optional<double> Peaks::rate(std::size_t c, const Assembler& assembler,
                                  const EvaluatedState& point) const {
  if (watched_[c].two_entries) return watched_[c].sum(point.state.v);
  if (const int law = channels_[c].deflection_of(); law >= 0) return point.inputs[idx(law)].x_dot;
  // Known motions are those of the assembler's time, which may be another than the point's.
  if (!channels_[c].is_linear() && assembler.system().any_prescribed_moves()) return std::nullopt;
  return channels_[c].rate(assembler, point.state);
}

bool Peaks::watches_loads() const {
  return std::any_of(channels_.begin(), channels_.end(), [](const Channel& c) { return c.follows_loads(); });
}

void Peaks::start(const Assembler& assembler, const EvaluatedState& point) {
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    const double y = value(c, assembler, point);
    peaks_[c] = {{y, point.state.t, y, point.state.t}};
    watched_[c].last = y;
    set_bounds(c);
  }
}

void Peaks::restart(const Assembler& assembler, const EvaluatedState& point) {
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    if (watched_[c].two_entries) continue;  // angles do not jump
    watched_[c].last = value(c, assembler, point);
    peaks_[c].note(watched_[c].last, point.state.t);
    set_bounds(c);
  }
}

void Peaks::step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) {
  const double length = to.state.t - from.state.t;
  longest_ = std::max(longest_, length);
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    Watched& w = watched_[c];
    const double y = value(c, assembler, to), before = w.last;
    const double higher = std::max(y, before), lower = std::min(y, before);
    w.last = y;
    if (higher <= w.high && lower >= w.low) continue;
    Peak& p = peaks_[c];
    p.note(y, to.state.t);
    const double near = kNear * (p.max - p.min);
    if (inside_steps_ && length > kShort * longest_ && (higher > p.max - near || lower < p.min + near))
      look_inside(c, assembler, from, to, before, y);
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
                        const EvaluatedState& to, double y_0, double y_1) {
  Peak& p = peaks_[c];
  const PeakSample a{from.state.t, y_0, rate(c, assembler, from)};
  const PeakSample b{to.state.t, y_1, rate(c, assembler, to)};
  const auto look = [&](double t) -> PeakSample {
    const StepMotion::Point inside = motion_->at(t);
    return {t, value(c, inside.assembler, inside.at), rate(c, inside.assembler, inside.at)};
  };
  if (motion_) return search_peak(a, b, look, p.max - p.min, p);
  // Shown by a caller that has no motion: the cubic itself.
  if (!a.rate || !b.rate) return;
  const double h = b.t - a.t;
  if (const auto inside = cubic_peak(a.y, *a.rate, b.y, *b.rate, h))
    p.note(inside->value, a.t + inside->s * h);
}

std::size_t Peaks::largest() const {
  std::size_t best = 0;
  for (std::size_t c = 1; c < peaks_.size(); ++c)
    if (peaks_[c].amplitude() > peaks_[best].amplitude()) best = c;
  return best;
}

}  // namespace drev
