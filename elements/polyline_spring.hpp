#pragma once
/// PolylineSpring: a spring whose force is given by points, linear between them.
///
///   y(x) through (x_i, y_i), its outer segments continued
///   total: y(x) + c x_dot             the damper acts always, in a gap too
///   x = q_b - q_a between two nodes,  x = q on one node, to ground
///
/// y must not fall with x and must pass through zero. Stored energy: the exact integral of y from
/// where y = 0, hence >= 0. A stretch with y = 0 is the gap; it reaches to infinity where an outer
/// segment is zero (a one-sided stop). closed_stiffness(): mean of the outer slopes that are not
/// zero where there is a gap, else the slope at x = 0 (right of it at a point). Units: rad and N m
/// between rotational nodes, m and N between translational ones.
#include <drev/core/element.hpp>

#include <vector>

namespace drev {

class PolylineSpring final : public Element, public ScalarForce {
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

  ScalarResponse evaluate(const ScalarInput& in) const override;
  double closed_stiffness() const override;
  double closed_damping() const override { return params_.damping; }
  std::span<const double> kinks() const override;
  std::optional<Gap> gap() const override { return gap_; }
  std::span<const LawPiece> pieces() const override { return pieces_; }

 private:
  bool usable() const;
  std::size_t segment_at(double x) const;
  void find_segments();
  void find_gap();
  void find_pieces();

  /// y = y_0 + slope (x - x_0), with the stored energy at x_0.
  struct Segment {
    double x = 0.0, y = 0.0, slope = 0.0, energy = 0.0;
  };

  Params params_;
  std::vector<Segment> segments_;
  std::vector<LawPiece> pieces_;
  std::optional<Gap> gap_;
};

}  // namespace drev
