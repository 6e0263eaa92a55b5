#pragma once
/// What happens in each contact: impacts on both flanks with their speeds and forces, time apart, rattle.
#include <drev/core/assembler.hpp>
#include <drev/solvers/run/distribution.hpp>
#include <drev/solvers/run/evaluated_state.hpp>
#include <drev/solvers/run/observer.hpp>

#include <string>
#include <vector>

namespace drev {

struct ContactRecord {
  std::string element;
  long front_impacts = 0;      ///< times the gap closed on the front flank, x rising through its high edge
  long back_impacts = 0;       ///< times it closed on the back flank
  double time_apart = 0.0;     ///< s, with both flanks open
  double largest_force = 0.0;  ///< N or N m, |y|
  double largest_force_time = 0.0;  ///< s
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
  void note_force(std::size_t i, double y, double t);

  bool inside_steps_ = false;
  std::vector<std::size_t> terms_;
  std::vector<Gap> gaps_;
  std::vector<double> masses_;
  std::vector<ContactInterval> intervals_;
  std::vector<ContactRecord> records_;
};

}  // namespace drev
