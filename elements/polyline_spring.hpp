#pragma once
/// PolylineSpring: a spring whose force is given by points, linear between them.
///
///   y(x) through (x_i, y_i), its outer segments continued
///   total: y(x) + c x_dot             the damper acts always, in a gap too
///   x = q_b - q_a between two nodes,  x = q on one node, to ground
///
/// y must not fall with x and must pass through zero. Stored energy: the exact integral of y from
/// where y = 0, hence >= 0. Segments with y = 0 are the gap; it reaches to infinity where an outer
/// segment is zero (a one-sided stop). Each segment is a piece; all else follows from the pieces
/// (PiecewiseLaw): on a point the segment below it holds, but closed_stiffness() takes the one above. Units:
/// rad and N m between rotational nodes, m and N between translational ones.
#include <drev/core/element_interface.hpp>
#include <drev/core/law/piecewise_law.hpp>

#include <vector>

namespace drev {

class PolylineSpring final : public Element, public PiecewiseForce {
 public:
  struct Params {
    std::vector<double> x;  ///< ascending [rad], at least 2
    std::vector<double> y;  ///< not descending [N m]
    double damping = 0.0;   ///< c [N m s/rad], >= 0
  };
  explicit PolylineSpring(Params params);

  /// Free within +-half_gap, k beyond: y = k (x -+ half_gap).
  static Params dead_band(double stiffness, double half_gap, double damping = 0.0);
  /// k within +-travel, stop_stiffness beyond (slope of the whole, not added to k).
  static Params with_stops(double stiffness, double travel, double stop_stiffness, double damping = 0.0);

  const Params& params() const { return params_; }
  std::string_view type() const override { return "polyline spring"; }
  int min_nodes() const override { return 1; }
  int max_nodes() const override { return 2; }
  void check(ParameterCheck& check) const override;
  void describe(int nodes, Terms& terms) const override;

 private:
  Params params_;
};

}  // namespace drev
