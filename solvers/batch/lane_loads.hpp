#pragma once
/// The right side p(t, z, v) of kLanes variants at once: Assembler::external in lanes.
///
/// Periodic tables of even spacing keep, in each lane, the knot nearest to their angle, as TableLoads does.
/// It serves as far as the next knot: a lane that has come nearer to another one takes that for the next
/// evaluation, and only where a step leaps over it is the sum made again. Other loads are evaluated lane by
/// lane, in each pass or, where they do not depend on motion, once a step.
#include <drev/core/assembler.hpp>
#include <drev/core/table_loads.hpp>

#include <array>
#include <vector>

#include "solvers/batch/lane_motion.hpp"

namespace drev {

class LaneLoads {
 public:
  /// systems: of one topology.
  explicit LaneLoads(const std::array<const System*, kLanes>& systems);

  bool depend_on_motion() const { return depend_on_motion_; }
  /// Moves to the assemblers' time.
  void set_time(const std::vector<Assembler>& assemblers);
  /// p at the motion in the lanes that are open; the others keep theirs.
  void evaluate(const LaneMotion& motion, const LaneMask& open, LaneArray& p);
  /// Bound of how any load's torque follows its unknown about where evaluate() was last [N m/rad or N/m], as
  /// Assembler::load_steepness; false: not known, there are loads that move and are no tables.
  bool steepness_known() const { return steepness_known_; }
  void steepness(LaneRow& out);

 private:
  struct Evaluated {
    std::array<const Load*, kLanes> loads = {};
    int row = 0;
    LaneRow coeff, ratio;
    bool moves = false;  // depends on motion
    LaneRow torque;
  };
  /// What a pass reads of a table, together.
  struct Knot {
    LaneRow angle, value, left, right;
  };
  template <class T>  // double where all lanes have the same
  struct Factors {
    T ratio, gain, width;  // width: of the angles that are nearest to a knot, half [rad]
  };
  struct Row {
    int row = 0, first = 0, end = 0, first_evaluated = 0, end_evaluated = 0;  // of the lists, sorted by row
  };
  friend struct LaneLoadKernels;
  bool take_nearest(std::size_t table, int lane, const LaneMotion& motion);
  void evaluate_by_lane(const LaneMotion& motion, const LaneMask& open, bool moving);

  TableLoads tables_;  // kLanes entries for each
  std::vector<int> table_row_;
  std::vector<Knot> knots_;
  std::vector<Factors<LaneRow>> factors_;
  std::vector<Factors<double>> common_factors_;  // where no lane has its own; else empty
  std::vector<double> reach_;                    // of every table's knots in each lane [rad]
  LaneArray steepness_;
  LaneRow steepest_;
  std::vector<Evaluated> evaluated_;
  std::vector<Row> rows_;
  std::vector<int> groups_;  // of rows, by their first, with few enough tables for one word of bits
  std::vector<int> unloaded_;
  LaneArray base_;
  LaneRow phi_, phi_rate_;
  Vector motions_;
  bool depend_on_motion_ = false, evaluated_move_ = false, steepness_known_ = true;
  bool moved_ = false, always_base_ = false, base_is_zero_ = true, taken_ = false;
  double t_ = 0.0;
};

}  // namespace drev
