#include <drev/core/assembler.hpp>
#include <drev/solvers/run/contact_statistics.hpp>
#include <drev/solvers/run/evaluated_state.hpp>
#include <drev/solvers/run/peaks.hpp>

#include <cmath>

#include "solvers/linear/sparse_cholesky.hpp"
#include "solvers/run/cubic_peak.hpp"

namespace drev {

// Of the largest force of one contact: what it may be off by.
static constexpr double kLargestOfContact = 1e-4;
// Of a force, what kinks may leave open of it where its turn is read off the series.
static constexpr double kMostOpen = 0.03;

std::vector<double> equivalent_masses(const System& system) {
  std::vector<double> all(system.scalars().size(), 0.0);
  SparseCholesky mass;
  Vector b, x;
  for (std::size_t j = 0; j < all.size(); ++j) {
    const ScalarTerm& term = system.scalars()[j];
    if (linear_pieces(term).size() == 1) continue;
    double flexibility = 0.0;
    if (system.mass_is_diagonal()) {
      for (const Entry& e : term.z)
        flexibility += e.coeff * e.coeff / system.mass_values()[system.diagonal_slots()[idx(e.index)]];
    } else {
      if (mass.status() == FactorStatus::not_computed) mass.factorize(system.pattern(), system.mass_values());
      if (!mass.ok()) return all;
      b.setZero(system.size());
      for (const Entry& e : term.z) b[e.index] += e.coeff;
      mass.solve(b, x);
      flexibility = b.dot(x);
    }
    all[j] = 1.0 / flexibility;
  }
  return all;
}

/// The law goes from one side of its gap to another with a rate x' of this square.
static void note_change(int before, int after, double square, double force, double equivalent_mass,
                        ContactInterval& interval, ContactRecord& record) {
  if (interval.met && before != 0)
    (before > 0 ? record.front_force : record.back_force).add(interval.largest);
  interval.met = after != 0;
  interval.largest = force;
  if (after == 0) return;
  ++(after > 0 ? record.front_impacts : record.back_impacts);
  (after > 0 ? record.front_speed : record.back_speed).add(std::sqrt(square));
  record.impact_energy += 0.5 * equivalent_mass * square;
}

void note_crossings(const Gap& gap, const ScalarInput& a, const ScalarInput& b, double force,
                    double equivalent_mass, ContactInterval& interval, ContactRecord& record) {
  const int before = gap.side(a.x), after = gap.side(b.x);
  if (before == after) return;
  // x'^2 is linear in x under a constant acceleration.
  const double part = ((after > 0 ? gap.high : gap.low) - a.x) / (b.x - a.x);
  const double square = a.x_dot * a.x_dot + part * (b.x_dot * b.x_dot - a.x_dot * a.x_dot);
  note_change(before, after, square, force, equivalent_mass, interval, record);
}

/// Force channels of the laws that have a gap, in the order of the laws.
static std::vector<Channel> gap_forces(const System& system) {
  std::vector<Channel> forces = all_channels(system);
  std::erase_if(forces, [&](const Channel& c) {
    return c.force_of() < 0 || !system.scalars()[idx(c.force_of())].force->gap();
  });
  return forces;
}

ContactStatistics::ContactStatistics(const System& system, bool inside_steps)
    : layout_(system.layout()),
      inside_steps_(inside_steps),
      forces_(inside_steps ? std::make_unique<Peaks>(gap_forces(system)) : nullptr) {
  const std::vector<double> masses = equivalent_masses(system);
  for (std::size_t j = 0; j < system.scalars().size(); ++j) {
    const ScalarTerm& term = system.scalars()[j];
    const auto gap = term.force->gap();
    if (!gap) continue;
    terms_.push_back(j);
    gaps_.push_back(*gap);
    masses_.push_back(masses[j]);
    records_.emplace_back().element = system.element_instances()[idx(index(term.element))].name;
  }
  intervals_.resize(terms_.size());
  largest_inside_.resize(terms_.size());
  turn_.resize(terms_.size());
}

ContactStatistics::~ContactStatistics() = default;

void ContactStatistics::restart(const Assembler& assembler, const EvaluatedState& point) {
  if (forces_) forces_->restart(assembler, point);
}

void ContactStatistics::look_through(StepMotion& motion) {
  motion_ = &motion;
  if (forces_) forces_->look_through(motion);
}

bool ContactStatistics::fits(const System& system) const { return system.layout() == layout_; }

void ContactStatistics::start(const Assembler& assembler, const EvaluatedState& point) {
  if (forces_) forces_->start(assembler, point);
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    records_[i].largest_force = std::abs(point.responses[terms_[i]].y);
    records_[i].largest_force_time = point.state.t;
    if (!intervals_[i].side) intervals_[i].side = gaps_[i].side(point.inputs[terms_[i]].x);
  }
}

bool ContactStatistics::needs_acceleration() const { return forces_ && forces_->needs_acceleration(); }

bool ContactStatistics::looks_inside(const EvaluatedState& from, const EvaluatedState& to,
                                     const double* beyond_cubic) {
  bool looks = forces_ && forces_->looks_inside(from, to, beyond_cubic);
  for (std::size_t i = 0; inside_steps_ && i < terms_.size(); ++i) {
    largest_inside_[i].reset();
    turn_[i].reset();
    looks |= may_rise_inside(i, from, to);
  }
  return looks;
}

/// Whether the force may come further inside the step than it is known to.
bool ContactStatistics::may_rise_inside(std::size_t i, const EvaluatedState& from, const EvaluatedState& to) {
  const std::size_t j = terms_[i];
  const int law = static_cast<int>(j);
  const ScalarResponse &a = from.responses[j], &b = to.responses[j];
  // A contact that this step begins has no largest force yet. Those at the step's ends are noted anyway.
  const bool begins = intervals_[i].side != motion_->side(law);
  const double largest = std::max({std::abs(a.y), std::abs(b.y), begins ? 0.0 : intervals_[i].largest});
  const auto reach = motion_->force_reach(law);
  if (reach && std::max(-reach->low, reach->high) <= (1.0 + kLargestOfContact) * largest) {
    largest_inside_[i] = 0.0;  // no more than at the step's ends, which are noted anyway, or before
    return false;
  }
  const auto range = motion_->force_range(law);
  if (!range) return true;
  const double inside = std::max(-range->low, range->high);
  if (range->error <= kLargestOfContact * std::max(inside, largest)) {
    largest_inside_[i] = inside;
    return false;
  }
  // What kinks add hardly moves the place of a single turn, and of that the square counts.
  if (range->turns > 1 || range->error > kMostOpen * std::max(inside, largest)) return true;
  largest_inside_[i] = 0.0;  // a monotone force is largest at an end, which is noted anyway
  if (range->turns == 1) turn_[i] = from.state.t + range->turn * (to.state.t - from.state.t);
  return false;
}

void ContactStatistics::step(const Assembler& assembler, const EvaluatedState& from,
                             const EvaluatedState& to) {
  if (forces_) forces_->step(assembler, from, to);
  const double h = to.state.t - from.state.t;
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    const std::size_t j = terms_[i];
    const ScalarInput &a = from.inputs[j], &b = to.inputs[j];
    const double begin = std::abs(from.responses[j].y), end = std::abs(to.responses[j].y);
    ContactInterval& interval = intervals_[i];
    ContactRecord& record = records_[i];
    if (const auto side = motion_ ? motion_->side(static_cast<int>(j)) : std::nullopt) {
      if (interval.side && *interval.side != *side)
        note_change(*interval.side, *side, a.x_dot * a.x_dot, begin, masses_[i], interval, record);
      interval.side = side;
      if (*side == 0) record.time_separated += h;
      note_forces(i, assembler, from, to);
    } else {
      note_forces(i, assembler, from, to);
      const Gap gap = beyond_rounding(gaps_[i]);
      if (note_time_separated(record, gap.low, gap.high, a.x, b.x, h, true))
        note_crossings(gap, a, b, end, masses_[i], interval, record);
    }
    if (!forces_) continue;
    const Peak& peak = forces_->peaks()[i];
    record.largest_force = peak.amplitude();
    record.largest_force_time = peak.time();
  }
}

void ContactStatistics::note_forces(std::size_t i, const Assembler& assembler, const EvaluatedState& from,
                                    const EvaluatedState& to) {
  const std::size_t j = terms_[i];
  const ScalarResponse &r0 = from.responses[j], &r1 = to.responses[j];
  const double h = to.state.t - from.state.t;
  double& largest = intervals_[i].largest;
  note_force(records_[i], std::abs(r1.y), to.state.t, true, largest);
  if (turn_[i]) largest_inside_[i] = std::abs(motion_->at(*turn_[i]).at.responses[j].y);
  turn_[i].reset();
  if (largest_inside_[i]) largest = std::max(largest, *largest_inside_[i]);
  if (!inside_steps_ || largest_inside_[i]) return;
  const auto rate = [&](const EvaluatedState& at) {
    const ScalarResponse& r = at.responses[j];
    const auto known = forces_->channels()[i].force_rate(assembler, at.state, at.inputs[j], r);
    return known.value_or(r.dy_dx * at.inputs[j].x_dot);
  };
  if (const auto peak = cubic_peak(r0.y, rate(from), r1.y, rate(to), h))
    note_force(records_[i], std::abs(peak->value), from.state.t + peak->s * h, true, largest);
}

}  // namespace drev
