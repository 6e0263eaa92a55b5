#pragma once
/// What happens in each contact: impacts on both flanks with their speeds and forces, time apart, rattle.
#include <drev/core/assembler.hpp>
#include <drev/solvers/run/distribution.hpp>
#include <drev/solvers/run/evaluated_state.hpp>
#include <drev/solvers/run/observer.hpp>

#include <string>
#include <vector>

#include "core/lanes.hpp"

namespace drev {

/// Of a contact, or (Number: LaneRow) of the same contact in kLanes variants.
template <class Number>
struct ContactTotals {
  Number time_apart{};          ///< s, with both flanks open
  Number largest_force{};       ///< N or N m, |y|
  Number largest_force_time{};  ///< s
};

struct ContactRecord : ContactTotals<double> {
  std::string element;
  long front_impacts = 0;  ///< times the gap closed on the front flank, x rising through its high edge
  long back_impacts = 0;   ///< times it closed on the back flank
  /// Impact speeds |x'| as the gap closes [m/s or rad/s]: as many as impacts.
  Distribution front_speed = {}, back_speed = {};
  /// Largest |y| from an impact until the flank is left [N or N m]. Contact without an impact before it (at
  /// the start) or that still lasts (at the end) is not among them.
  Distribution front_force = {}, back_force = {};
  /// Sum of m_eq x'^2/2 over all impacts [J], m_eq = 1/(b^T M^-1 b): the energy of the relative motion that
  /// the inertias beside the contact bring to it. 0 where a node beside it has no inertia.
  double impact_energy = 0.0;

  long impacts() const { return front_impacts + back_impacts; }
  Distribution speed() const { return both(front_speed, back_speed); }  ///< of both flanks
  Distribution force() const { return both(front_force, back_force); }
  /// Impact power: impact_energy over the duration [W]. How loud it is, and how much of it is lost, it does
  /// not say; it ranks variants of one drive.
  double rattle_index(double duration) const { return duration > 0.0 ? impact_energy / duration : 0.0; }

 private:
  static Distribution both(Distribution front, const Distribution& back) {
    front.add(back);
    return front;
  }
};

/// m_eq of every law that is not linear [kg or kg m^2], in System::scalars(); 0 for the others.
std::vector<double> equivalent_masses(const System& system);

/// The contact at hand: whether an impact began it, and its largest |y| so far.
struct ContactInterval {
  bool met = false;
  double largest = 0.0;
};
/// Enters a force of size |y| at time t in these lanes; largest: of the contact at hand. Value and Mask: double
/// and bool, or Lanes and LaneMask.
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
[[gnu::always_inline]] inline bool note_time_apart(ContactTotals<Number>& totals, const Value& low,
                                                   const Value& high, const Value& x_0, const Value& x_1,
                                                   double h, const Mask& lanes) {
  const Mask above = x_0 > high, below = x_0 < low, outside = above | below;
  const Value zero{};
  if (!any(lanes & ((above ^ (x_1 > high)) | (below ^ (x_1 < low))))) {  // each stays where it was
    each(totals.time_apart) += (lanes & !outside) ? zero + h : zero;
    return false;
  }
  const Value one = zero + 1.0, least = x_0 < x_1 ? x_0 : x_1, most = x_0 < x_1 ? x_1 : x_0;
  Value inside = (most < high ? most : high) - (least > low ? least : low);
  inside = inside > zero ? inside : zero;
  const Mask stands = most == least;
  const Value length = stands ? one : most - least;
  const Value share = stands ? (outside ? zero : one) : inside / length;
  each(totals.time_apart) += lanes ? h * share : zero;
  return true;
}
/// Enters the flanks that a step a -> b leaves and meets; force: |y| at b.
void note_crossings(const Gap& gap, const ScalarInput& a, const ScalarInput& b, double force,
                    double equivalent_mass, ContactInterval& interval, ContactRecord& record);

/// Every law that has a gap. Crossings inside a step are placed by linear interpolation of x, the speed there
/// by that of x'^2 over x (exact propagation ends its steps at crossings: both are exact); a flank touched
/// and left inside one step is not seen.
class ContactStatistics final : public Observer {
 public:
  bool needs_acceleration() const override { return false; }
  /// inside_steps: as in Peaks, for forces.
  explicit ContactStatistics(const System& system, bool inside_steps = false);
  void start(const Assembler& assembler, const EvaluatedState& point) override;
  void step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) override;
  const std::vector<ContactRecord>& records() const { return records_; }

 private:
  bool inside_steps_ = false;
  std::vector<std::size_t> terms_;
  std::vector<Gap> gaps_;
  std::vector<double> masses_;
  std::vector<ContactInterval> intervals_;
  std::vector<ContactRecord> records_;
};

}  // namespace drev
