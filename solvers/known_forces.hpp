#pragma once
/// KnownForces: loads, nominal motion and prescribed motions as polynomials over a step, for
/// TaylorSeries.
///
/// A load in its stretch is linear in t and theta: its constant goes to the right side, its slope
/// against the deviation to the stiffness's diagonal, and the knots at the stretch's ends are
/// events, found as roots of theta(s) - knot. A load with a series of its own (engine orders) is
/// composed with theta(s) degree by degree, exactly. Motions are polynomials of degree 2 between
/// their breakpoints.
#include <memory>
#include <optional>

#include "solvers/taylor_series.hpp"

namespace drev {

class KnownForces final : public SeriesSource {
 public:
  explicit KnownForces(const System& system);

  /// Moves to a state: known motions at t, and each load's stretch ahead of its angle. At the start
  /// and after breakpoints.
  void locate(double t, const Vector& z, const Vector& v);
  /// Moves to a state further on, between breakpoints. Loads that stand at the end of their stretch
  /// (within rounding) go on to the next one; true if any did.
  bool advance(double t, const Vector& z, const Vector& v);

  /// Seconds until the first load reaches the end of its stretch, going on at its speed.
  double time_to_knot() const;
  /// Adds the right side over a step of h seconds and the loads' slopes.
  void add_to(TaylorSeries& series, double h);
  void add(int k, const double* z, double* rhs) override;
  bool composed() const { return !composed_.empty(); }
  /// The step became r h.
  void shorten(double r);

  /// Prescribed motion k as a polynomial over the step.
  const std::array<double, 3>& prescribed(int k) const { return u_[at(k)]; }

  /// First s in (0, end] (0 for a load about to leave backwards) at which a load leaves its
  /// stretch.
  std::optional<double> first_knot(const TaylorSeries& series, double end);
  /// After first_knot() and advance() to it: that load goes on to the next stretch, if it has not.
  void pass_knot();
  ElementId knot_element() const { return loads_[at(leaving_)].term->element; }

  /// Work of all these forces on the unknowns from 0 to s of the step [J].
  double work(const TaylorSeries& series, double s);

 private:
  struct Linear {
    const LoadTerm* term;
    int row;
    double coeff, ratio;
    bool feedback;
    LoadStretch stretch;
    double t_0, angle_0;                     // where `stretch` gives its torque
    double angle, speed, deviation, torque;  // at the step's start
  };
  struct Composed {
    const LoadTerm* term;
    int row;
    double coeff, ratio;
    bool feedback;
    std::unique_ptr<LoadSeries> series;
    std::vector<double> angle, torque;
  };
  void move(double t, const Vector& z, const Vector& v);
  void look_up(Linear& load, double direction);

  const System& system_;
  Assembler assembler_;
  std::vector<Linear> loads_;
  std::vector<Composed> composed_;
  std::array<Vector, 3> p_;  // of the step, without the loads' slopes
  std::array<double, 3> phi_{};
  std::vector<std::array<double, 3>> u_;
  std::vector<double> theta_, power_;
  Vector i0_, i1_, i2_;
  double t_ = 0.0;
  int leaving_ = -1;
  double leaving_direction_ = 0.0;
};

}  // namespace drev
