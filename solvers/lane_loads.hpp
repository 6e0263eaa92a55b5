#pragma once
/// The right side p(t, z, v) of kLanes variants at once: Assembler::external in lanes.
///
/// A load with stretches (Load::stretch) is, in each lane, the stretch that its angle is in. The angles are
/// watched in lanes; one that has left its stretch is looked up anew by itself. Other loads are evaluated
/// lane by lane, in each pass or, where they do not depend on motion, once a step.
#include <array>
#include <vector>

#include "core/assembler.hpp"
#include "core/lanes.hpp"

namespace drev {

class LaneLoads {
 public:
  /// systems: of one topology.
  explicit LaneLoads(const std::array<const System*, kLanes>& systems);

  bool depend_on_motion() const { return depend_on_motion_; }
  /// Loads whose torque depends on speeds, or may.
  bool want_rates() const { return want_rates_; }
  /// Forgets the stretches: at the start and behind breakpoints at time t [s].
  void restart(double t);
  /// Moves to the assemblers' time.
  void set_time(const std::vector<Assembler>& assemblers);
  /// p at (z, v) in the lanes that are open; the others keep theirs. change, largest: of |p - before| and |p|
  /// over the rows. before: p of the pass before, or null.
  void evaluate(const LaneRow* z, const LaneRow* v, const LaneMask& open, const LaneRow* before, LaneRow* p,
                LaneRow& change, LaneRow& largest);

 private:
  struct Place {
    std::array<const Load*, kLanes> loads = {};
    int row = 0;
    LaneRow coeff, feedback, ratio;  // of the row; of the deviation in the angle; n
    bool moves = false;              // depends on motion
  };
  /// What a pass reads of a load with stretches, together: its stretch in each lane.
  struct Stretch {
    LaneRow torque, slope, angle_0, width;  // torque at angle_0, which lies `width` from both ends
  };
  struct Evaluated : Place {
    LaneRow torque;
  };
  struct Row {
    int row = 0, first = 0, end = 0, first_evaluated = 0, end_evaluated = 0;  // of the lists, sorted by row
  };
  friend struct LaneLoadKernels;
  double angle(std::size_t load, int lane, const LaneRow* z) const;
  void look_up(std::size_t load, int lane, double angle, double direction);
  void evaluate_by_lane(const LaneRow* z, const LaneRow* v, const LaneMask& open, bool moving);

  std::vector<Place> places_;  // of the loads with stretches
  std::vector<Stretch> stretches_;
  LaneArray time_slopes_;      // N m/s, from start_ on
  struct Factors {
    double coeff, feedback, ratio;
  };
  std::vector<Factors> factors_;  // of the same, where no lane has its own; else empty
  std::vector<Evaluated> evaluated_;
  std::vector<Row> rows_;
  std::vector<int> groups_;    // of rows, by their first, with few enough loads for one word of bits
  std::vector<int> unloaded_;
  LaneArray base_;
  LaneRow phi_, phi_rate_, base_largest_;
  Vector motions_;
  bool depend_on_motion_ = false, want_rates_ = false, timed_ = false;
  bool moved_ = false, always_base_ = false, base_is_zero_ = true;
  double t_ = 0.0, start_ = 0.0;
};

}  // namespace drev
