#pragma once
/// The step from the estimated local error, so that the sum of the errors over a run stays below a tolerance:
///
///   E = max over deviations and rates of |e| T / (h tolerance scale) <= 1
///   h <- 0.9 h E^(-0.7/q) E_last^(0.4/q)      q: order of e/h
///
/// T is the run's length. scale is the largest deviation, or rate, so far among unknowns of one kind
/// (turning, moving along); of a system that floats, without the motion as a rigid body, unless it has no other. Implicit methods
/// step on a grid of 2^(1/4), so that few matrices are factored. Source of the controller: K. Gustafsson,
/// ACM TOMS 17, 1991, doi:10.1145/210232.210242.
#include <drev/core/state.hpp>

#include <algorithm>

namespace drev {

class StepControl {
 public:
  struct Options {
    double tolerance = 0.0;             ///< [-]
    double duration = 0.0;              ///< s, T
    double first = 0.0, largest = 0.0;  ///< s
    int order = 2;                      ///< q
    bool on_grid = false;
  };
  StepControl(const System& system, const Options& options);
  static constexpr double kExpected = 0.01;

  /// Takes a state of a coarse run into the scales, at 1/100 of it: from rest, errors relative to the
  /// motion so far would never be small.
  void expect(const State& state) { scales_ = with(state, kExpected); }
  /// Takes an accepted state into the scales.
  void look_at(const State& state) { scales_ = with(state, 1.0); }
  /// Length of the next step, with `remaining` to the next stop.
  double next(double remaining) const;
  /// E of a step of length h that ends at a state, from the errors of deviations and rates. Where rounding alone may have made
  /// it, one with which the step grows: no shorter step would lower it, and steps that are all rounding would stay so.
  double error(const State& end, const Vector& e_z, const Vector& e_v, double h);
  /// After an accepted step. as_planned: not cut short by a stop or contact. One of E > 1 is followed by a shorter one only if E
  /// has fallen with the step: it does not at a jump, nor where it is rounding.
  void accepted(double h, double error, bool as_planned);
  void rejected(double h, double error);
  /// A step that could not be solved, and one that is to be halved.
  void failed(double h);
  void shorten(double h);
  /// The next step is not longer than h.
  void at_most(double h) { h_ = std::min(h_, h); }

 private:
  struct Scales {
    double z[2] = {}, v[2] = {};  // scales by kind of node
  };
  Scales with(const State& state, double part) const;
  void set(double h);

  const System& system_;
  Options options_;
  std::vector<int> kind_;  // 0 turning, 1 moving along
  Vector rigid_;           // empty: does not float
  Vector stiffness_;       // of each unknown, with the laws' where they are closed
  Vector law_forces_;      // sizes of the laws' elastic forces at the end of the step at hand
  double h_ = 0.0, last_error_ = 1.0;
  double last_above_ = 0.0;  // last E above 1 of a step in succession; 0: there was none
  bool after_rejection_ = false;
  Scales scales_;
};

}  // namespace drev
