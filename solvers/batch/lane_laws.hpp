#pragma once
/// The laws of kLanes variants at once, and Newton on their forces (contact_newton.hpp) in lanes.
///
/// A law with pieces (ScalarForce::pieces) is, in each lane, the piece that it is on: its bounds are
/// watched in lanes, and a lane that left its piece looks for its new one by itself, which is rare. Other
/// laws are evaluated lane by lane. Newton takes whole steps: it needs the line search only where it would
/// cycle, and lanes that have not converged in a few iterations are left to the caller.
#include <drev/core/assembler.hpp>

#include <array>
#include <vector>

#include "solvers/batch/lane_motion.hpp"

namespace drev {

/// Where the laws stand at one point of a run.
struct LanePointLaws {
  LaneArray x, x_dot, y, energy, power, angle;
  double t = 0.0;  ///< s, at which they were evaluated
};

/// Numbers of some unknowns.
struct LaneForces {
  std::vector<int> rows;
  LaneArray values;
};

class LaneLaws {
 public:
  /// systems: of one topology.
  explicit LaneLaws(const std::array<const System*, kLanes>& systems);

  int count() const { return static_cast<int>(laws_.size()); }
  bool phased() const { return phased_; }
  /// Sizes the point's arrays.
  void prepare(LanePointLaws& point) const;

  /// What of x and x' the unknowns do not give: moved ends and transmission errors, from the assemblers,
  /// which stand at the step's time. Only needed where has_known().
  bool has_known() const { return has_known_; }
  void take_known(const std::vector<Assembler>& assemblers);
  void take_angles(const std::vector<Assembler>& assemblers, const LaneMotion& motion,
                   LanePointLaws& to) const;

  /// compliance: B' S^-1 B from W = S^-1 B by rows.
  void set_compliance(const LaneArray& w, double kappa_x, double kappa_v);
  /// b_j as a vector over the unknowns.
  void row(int law, LaneArray& b) const;

  /// From the motion with all forces zero to the forces lambda, in the lanes that are open; the others keep
  /// theirs. Converged: |lambda - y| <= tolerance * scale. What stays open did not converge.
  void solve(const LaneMotion& free, double t, const LaneRow& scale, double tolerance, LaneMask& open,
             LaneRow* lambda, LanePointLaws& to, LaneRow& iterations);
  /// Energy and power at the point's x and x', in all lanes.
  void energies(LanePointLaws& point);
  /// B y where it is not zero; rows ascending.
  void forces(const LaneArray& y, LaneForces& by) const;

  /// What EnergyMonitor adds to the input for laws with moved ends, with transmission error, or that vary.
  bool extra_input() const { return has_known_ || varies_; }
  void add_extra_input(const LanePointLaws& from, const LaneRow* z_0, const LanePointLaws& to,
                       const LaneMotion& end, LaneRow& input) const;

 private:
  struct Piece {
    LaneRow y_0, k, c, product, elastic_0, elastic_k, energy_0;
  };
  struct Bound {
    LaneRow a, b_x, b_v;
  };
  struct Law {
    std::array<const ScalarTerm*, kLanes> terms = {};
    std::vector<int> unknowns, places;  // places of the law's unknowns in rows_
    LaneArray coefficients;
    bool in_pieces = false, has_known = false, varies = false;
    Piece piece;
    std::vector<Bound> bounds;
    LaneRow known_x, known_x_dot;
  };
  friend struct LaneLawKernels;
  /// The law goes on to the piece that holds at (x, x') in this lane.
  static void find_piece(Law& law, int lane, double x, double x_dot);
  /// Force and slopes of a law without pieces.
  static void evaluate(const Law& law, double t, const LaneRow& x, const LaneRow& x_dot, const LaneRow& angle,
                       LaneRow& y, LaneRow& dy_dx, LaneRow& dy_dx_dot);

  std::vector<Law> laws_;
  std::vector<int> rows_;  // unknowns that laws act on, ascending
  bool phased_ = false, has_known_ = false, varies_ = false;
  LaneArray compliance_;  // row by row
  double kappa_x_ = 0.0, kappa_v_ = 0.0;
  LaneArray free_x_, free_x_dot_, x_, x_dot_, y_, dy_dx_, dy_dx_dot_, residual_, tangent_;
};

}  // namespace drev
