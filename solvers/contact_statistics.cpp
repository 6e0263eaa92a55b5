#include "solvers/contact_statistics.hpp"

#include <cmath>

#include "solvers/cubic_peak.hpp"

namespace drev {

namespace {

/// Part of a step from x0 to x1 (linear) that lies inside the gap [-].
double share_apart(double x0, double x1, const Gap& gap) {
  const double low = std::min(x0, x1), high = std::max(x0, x1);
  const double inside = std::min(high, gap.high) - std::max(low, gap.low);
  if (high == low) return low >= gap.low && low <= gap.high ? 1.0 : 0.0;
  return std::max(0.0, inside) / (high - low);
}

}  // namespace

ContactStatistics::ContactStatistics(const System& system, bool inside_steps)
    : inside_steps_(inside_steps) {
  for (std::size_t j = 0; j < system.scalars().size(); ++j)
    if (const auto gap = system.scalars()[j].force->gap()) {
      terms_.push_back(j);
      gaps_.push_back(*gap);
      records_.push_back(
          {.element = system.placements()[at(index(system.scalars()[j].element))].name});
    }
}

void ContactStatistics::start(const Assembler& /*assembler*/, const StepPoint& point) {
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    records_[i].largest_force = std::abs(point.responses[terms_[i]].y);
    records_[i].largest_force_time = point.state.t;
  }
}

void ContactStatistics::step(const Assembler& /*assembler*/, const StepPoint& from,
                             const StepPoint& to) {
  const double h = to.state.t - from.state.t;
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    const std::size_t j = terms_[i];
    const double x0 = from.inputs[j].x, x1 = to.inputs[j].x;
    ContactRecord& r = records_[i];
    const bool front = x0 <= gaps_[i].high && x1 > gaps_[i].high;
    const bool back = x0 >= gaps_[i].low && x1 < gaps_[i].low;
    r.front_impacts += front;
    r.back_impacts += back;
    if (front || back)
      r.largest_gap_speed = std::max(r.largest_gap_speed, std::abs(from.inputs[j].x_dot));
    r.time_apart += h * share_apart(x0, x1, gaps_[i]);
    const ScalarResponse &r0 = from.responses[j], &r1 = to.responses[j];
    note_force(r, r1.y, to.state.t);
    if (!inside_steps_) continue;
    if (const auto peak = cubic_peak(r0.y, r0.dy_dx * from.inputs[j].x_dot, r1.y,
                                     r1.dy_dx * to.inputs[j].x_dot, h))
      note_force(r, peak->value, from.state.t + peak->s * h);
  }
}

void ContactStatistics::note_force(ContactRecord& record, double y, double t) const {
  if (std::abs(y) <= record.largest_force) return;
  record.largest_force = std::abs(y);
  record.largest_force_time = t;
}

}  // namespace drev
