#pragma once
/// What happens in each contact: impacts on both flanks, time apart, largest force.
#include <string>
#include <vector>

#include "solvers/observer.hpp"

namespace drev {

struct ContactRecord {
  std::string element;
  long front_impacts = 0;        ///< times the gap closed on the front flank, x rising through its high edge
  long back_impacts = 0;         ///< times it closed on the back flank
  double time_apart = 0.0;       ///< s, with both flanks open
  double largest_force = 0.0;    ///< N or N m, |y|
  double largest_force_time = 0.0;  ///< s
  double largest_gap_speed = 0.0;   ///< m/s or rad/s, |x'| at the impact of largest speed
};

/// Every law that has a gap. Crossings inside a step are placed by linear interpolation of x; a flank
/// touched and left inside one step is not seen.
class ContactStatistics final : public Observer {
 public:
  /// inside_steps: as in Peaks, for the largest force.
  explicit ContactStatistics(const System& system, bool inside_steps = false);
  void start(const Assembler& assembler, const StepPoint& point) override;
  void step(const Assembler& assembler, const StepPoint& from, const StepPoint& to) override;
  const std::vector<ContactRecord>& records() const { return records_; }

 private:
  void note_force(ContactRecord& record, double y, double t) const;

  bool inside_steps_ = false;
  std::vector<std::size_t> terms_;
  std::vector<Gap> gaps_;
  std::vector<ContactRecord> records_;
};

}  // namespace drev
