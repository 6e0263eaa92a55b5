#pragma once
/// ContactRecord: what happened in one contact over a run.
#include <drev/core/lanes.hpp>
#include <drev/solvers/run/distribution.hpp>

#include <string>

namespace drev {

/// Of a contact, or (Number: LaneRow) of the same contact in kLanes variants.
template <class Number>
struct ContactTotals {
  Number time_separated{};      ///< s, with both flanks open
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
  /// the inertias beside the contact bring to it. 0 where a node beside it has no inertia, infinite between prescribed ones.
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

}  // namespace drev
