#pragma once
/// What happens in each contact: impacts on both flanks with their speeds and forces, time separated, rattle; and every
/// change of a contact with its time (ContactEvents).
#include <drev/core/law/friction.hpp>
#include <drev/core/scalar_force.hpp>
#include <drev/core/state.hpp>
#include <drev/solvers/run/contact_record.hpp>
#include <drev/solvers/run/observer.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace drev {

class Assembler;
class Peaks;
struct EvaluatedState;

/// m_eq of every law that is not linear [kg or kg m^2], in System::scalars(), infinite between prescribed nodes; 0 for the others.
std::vector<double> equivalent_masses(const System& system);

/// The contact at hand: whether an impact began it, its largest |y| so far, and where the law was in the last step
/// that knew (StepMotion::side).
struct ContactInterval {
  bool met = false;
  double largest = 0.0;
  std::optional<int> side = {};
};
/// Enters a force of size |y| at time t in these lanes; largest: of the contact at hand. Value and Mask:
/// double and bool, or Lanes and LaneMask.
template <class Number, class Value, class Mask>
[[gnu::always_inline]] inline void note_force(ContactTotals<Number>& totals, const Value& size, double t,
                                              const Mask& lanes, Number& largest) {
  put_where(lanes & (size > each(largest)), size, each(largest));
  const Mask more = lanes & (size > each(totals.largest_force));
  if (!any(more)) return;
  put_where(more, size, each(totals.largest_force));
  put_where(more, Value{} + t, each(totals.largest_force_time));
}
/// Enters the time that a step of length h, in which x goes linearly from x_0 to x_1, is inside the gap.
/// Returns whether x passes an edge of it in one of the lanes.
template <class Number, class Value, class Mask>
[[gnu::always_inline]] inline bool note_time_separated(ContactTotals<Number>& totals, const Value& low,
                                                       const Value& high, const Value& x_0, const Value& x_1,
                                                       double h, const Mask& lanes) {
  const Mask above = x_0 > high, below = x_0 < low, outside = above | below;
  const Value zero{};
  if (!any(lanes & ((above ^ (x_1 > high)) | (below ^ (x_1 < low))))) {  // each stays where it was
    each(totals.time_separated) += (lanes & !outside) ? zero + h : zero;
    return false;
  }
  const Value one = zero + 1.0, least = x_0 < x_1 ? x_0 : x_1, most = x_0 < x_1 ? x_1 : x_0;
  Value inside = (most < high ? most : high) - (least > low ? least : low);
  inside = inside > zero ? inside : zero;
  const Mask stands = most == least;
  const Value length = stands ? one : most - least;
  const Value share = stands ? (outside ? zero : one) : inside / length;
  each(totals.time_separated) += lanes ? h * share : zero;
  return true;
}
/// The gap with its edges moved out by what rounding leaves of a deflection that stands on one: it meets no flank.
inline Gap beyond_rounding(Gap gap) {
  const double rounding = 1e-13 * std::max(std::abs(gap.low), std::abs(gap.high));
  return {gap.low - rounding, gap.high + rounding};
}
/// Enters the flanks that a step a -> b leaves and meets; force: |y| at b.
void note_crossings(const Gap& gap, const ScalarInput& a, const ScalarInput& b, double force,
                    double equivalent_mass, ContactInterval& interval, ContactRecord& record);

/// Every law that has a gap. Exact propagation ends its steps at crossings and knows between which: count, time
/// and speed are exact. Elsewhere crossings inside a step are placed by linear interpolation of x, the speed
/// there by that of x'^2 over x, and a flank touched and left inside one step is not seen.
class ContactStatistics final : public Observer {
 public:
  bool fits(const System& system) const override;
  bool needs_acceleration() const override;
  bool looks_inside(const EvaluatedState& from, const EvaluatedState& to,
                    const double* beyond_cubic) override;
  void look_through(StepMotion& motion) override;
  void restart(const Assembler& assembler, const EvaluatedState& point) override;
  /// inside_steps: as in Peaks, for the largest forces; that of each single contact then holds to 1e-4 of itself.
  explicit ContactStatistics(const System& system, bool inside_steps = true);
  ~ContactStatistics() override;
  void start(const Assembler& assembler, const EvaluatedState& point) override;
  void step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) override;
  const std::vector<ContactRecord>& records() const { return records_; }

 private:
  bool may_rise_inside(std::size_t i, const EvaluatedState& from, const EvaluatedState& to);
  void note_forces(std::size_t i, const Assembler& assembler, const EvaluatedState& from,
                   const EvaluatedState& to);
  std::shared_ptr<const void> layout_;  // System::layout()
  bool inside_steps_ = true;
  StepMotion* motion_ = nullptr;
  std::unique_ptr<Peaks> forces_;  // of each law; null: not looked for inside steps
  std::vector<std::size_t> terms_;
  std::vector<Gap> gaps_;
  std::vector<double> masses_;
  std::vector<ContactInterval> intervals_;
  std::vector<std::optional<double>> largest_inside_;  // of each force in the step at hand, where it is known
  std::vector<std::optional<double>> turn_;            // time at which it is to be read off there [s]
  std::vector<ContactRecord> records_;
};

/// A contact made or lost, or a change of dry friction.
struct ContactEvent {
  double t = 0.0;       ///< s
  std::size_t law = 0;  ///< of System::scalars()
  bool front = false;   ///< the flank: the upper edge of the gap, on which deflections are positive
  bool made = false;    ///< contact made; else lost
  double rate =
      0.0;  ///< of the deflection, m/s or rad/s: positive towards the front; of friction: slip speed
  /// Of System::frictions(), whose state from here on is `becomes`; -1: contact of a law.
  int friction = -1;
  FrictionState becomes = FrictionState::open;
};

/// Every time at which the deflection of a law passes an edge of its gap, so that contact is made or lost:
/// located by exact propagation, else on the cubic through the deflections and rates at both ends of a step (from which a
/// contact that is made and lost within one step is missed). Of dry friction: every time at which a contact or lossy gear
/// sticks, slides, opens, or turns round.
class ContactEvents final : public Observer {
 public:
  /// sink: takes each event as the run comes to it; without one they are kept, see all(). Those of one time come in the
  /// order in which the edges are passed, those of different laws in that of System::scalars() within a step.
  explicit ContactEvents(const System& system, std::function<void(const ContactEvent&)> sink = {});
  bool fits(const System& system) const override;
  void look_through(StepMotion& motion) override { motion_ = &motion; }
  void start(const Assembler& assembler, const EvaluatedState& point) override;
  void step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) override;
  bool needs_acceleration() const override { return false; }
  bool looks_inside(const EvaluatedState&, const EvaluatedState&, const double*) override { return false; }
  const std::vector<ContactEvent>& all() const { return all_; }

 private:
  void note(const ContactEvent& event);
  void note_frictions(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to);
  void note_side(std::size_t law, int side, double t, double rate);
  const System& system_;
  std::function<void(const ContactEvent&)> sink_;
  const StepMotion* motion_ = nullptr;
  std::vector<std::optional<int>> sides_;  // side of each law in the last step that knew it
  std::vector<double> states_;             // of each friction contact in the last step
  std::vector<ContactEvent> all_;
};

}  // namespace drev
