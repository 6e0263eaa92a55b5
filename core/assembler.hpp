#pragma once
/// Assembler: evaluates the terms of a System that are not constant, at one time. Holds what is known
/// about that time (nominal motion, prescribed motions) and nothing else; one per thread.
#include <drev/core/general_force.hpp>
#include <drev/core/load.hpp>
#include <drev/core/scalar_force.hpp>
#include <drev/core/state.hpp>
#include <drev/core/weights.hpp>

#include <algorithm>
#include <limits>

namespace drev {

class Assembler {
 public:
  explicit Assembler(const System& system);

  const System& system() const { return system_; }
  /// Moves to time t [s]: nominal motion phi(t) and prescribed motions u(t).
  void set_time(double t);
  /// As set_time(t + ahead), with the reference shaft turning evenly from t on: phi(t) + w(t) ahead, w(t), and dw/dt(t).
  void set_time_ahead(double t, double ahead);
  /// Stands still at nominal angle phi [rad] of the reference shaft (statics): no nominal rate; known
  /// motions keep their value at the time set last, but neither rate nor acceleration.
  void stand_at_angle(double phi);
  double time() const { return t_; }
  const MotionPoint& nominal() const { return nominal_; }
  const MotionPoint& prescribed(int k) const { return u_[idx(k)]; }

  /// Deviation, its rate and acceleration of a node.
  MotionPoint node_motion(int node, const State& s) const;
  /// Actual angle theta = n phi + q.
  double node_angle(int node, const Vector& z) const;

  /// p: all loads, less m phi'' + d phi' and less the constant matrices' coupling to u(t). Where loads follow
  /// the motion, what does not is evaluated once a time.
  void external(const Vector& z, const Vector& v, Vector& p) const;
  /// The same without the loads: what known motions alone put on the right side.
  void external_of_motions(Vector& p) const;
  /// Bound of how any load's torque follows its unknown about where external() was last [N m/rad or N/m];
  /// infinite where there are loads whose steepness is not known. rate: how much an unknown's rate changes with it
  /// [1/s]. Of a load that says its knots (KnottedLoads) it is that up to the next knot.
  double load_steepness(double rate) const {
    if (!system_.moving_loads().empty() || !system_.varying_inertias().empty())
      return std::numeric_limits<double>::infinity();
    const double by_rate = knotted_.steepest_by_speed > 0.0 ? rate * knotted_.steepest_by_speed : 0.0;
    return row_gain_ * std::max(tables_.steepest, knotted_.steepest + by_rate);
  }
  LoadResponse load(const LoadTerm& term, const Vector& z, const Vector& v) const;
  /// Torque [N m] (force [N]) of a load on its node, that of an inertia which follows the angle included.
  double load_torque(const LoadTerm& term, const State& s) const;
  /// p += what a torque on a node that is not prescribed gives.
  void add_torque(const NodeMap& map, double torque, Vector& p) const {
    if (map.unknown >= 0)
      p[map.unknown] += map.coeff * torque;
    else
      p += map.coeff * torque * system_.rows().row(map.row).transpose();
  }

  /// What the law of a scalar term sees.
  ScalarInput input(const ScalarTerm& term, const Vector& z, const Vector& v) const;
  /// What of it no unknown has a part in: time, prescribed motions, transmission error.
  ScalarInput given_input(const ScalarTerm& term) const {
    ScalarInput in;
    in.t = t_;
    if (!term.u.empty() || term.phase_node >= 0) add_given(term, in);
    return in;
  }
  ScalarResponse respond(const ScalarTerm& term, const Vector& z, const Vector& v) const {
    return term.force->evaluate(input(term, z, v));
  }
  /// f += sum_j b_j y_j.
  void add_scalar_forces(const Vector& z, const Vector& v, Vector& f) const;
  /// f += general elements' forces; history_new receives their history if the step is accepted.
  void add_general_forces(const Vector& z, const Vector& v, const Vector& history, Vector& f,
                          Vector& history_new) const;

  /// r += general elements' forces over nodes, before elimination; r has one entry a node.
  void add_general_node_forces(const State& s, Vector& r) const;
  /// Stored energy [J] and dissipated power [W] of the general elements; history as before the step.
  std::pair<double, double> general_energy(const State& s, const Vector& history) const;

  /// Values of m M + c C + k K on the pattern.
  void linear_values(const Weights& w, Vector& values) const;
  /// The same plus the laws', loads' and general elements' slopes at (z, v). Loads enter with their
  /// slopes where with_loads is set (their tangent can be indefinite).
  void tangent_values(const Weights& w, const Vector& z, const Vector& v, const Vector& history,
                      bool with_loads, Vector& values) const;
  /// Values with every law linearised in a stated contact state: what modes are computed of.
  void contact_values(const Weights& w, Contact contact, Vector& values) const;

  /// out = A x with the symmetric A's values on the pattern.
  void multiply(const Vector& values, const Vector& x, Vector& out) const;
  /// A X, by columns.
  Eigen::MatrixXd product(const Vector& values, const Eigen::MatrixXd& x) const;
  /// out = M x, C x, K x.
  void multiply_mass(const Vector& x, Vector& out) const;
  void multiply_damping(const Vector& x, Vector& out) const;
  void multiply_stiffness(const Vector& x, Vector& out) const {
    multiply(system_.stiffness_values(), x, out);
  }

 private:
  void add_given(const ScalarTerm& term, ScalarInput& in) const;
  /// coeff times this is the node's deviation, or its rate with v for z.
  double over_coeff(const NodeMap& map, const Vector& z, double MotionPoint::*known) const {
    if (map.unknown >= 0) return z[map.unknown];
    return map.row < 0 ? u_[idx(map.prescribed)].*known : system_.rows().row(map.row).dot(z);
  }
  void add_looked_up(const Vector& z, const Vector& v, Vector& p) const;
  void add_varying_inertia(const Vector& z, const Vector& v, Vector& p) const;
  void external_known(Vector& p) const;  // the part of p that is the same for all motions
  void multiply_diagonal(const Vector& values, const Vector& x, Vector& out) const;
  LocalResponse respond(const GeneralTerm& g, const Vector& z, const Vector& v, const Vector& history,
                        Vector& history_new) const;
  void add_scalar_slope(const ScalarTerm& term, double slope, Vector& values) const;
  void add_general_slopes(const Weights& w, const Vector& z, const Vector& v, const Vector& history,
                          Vector& values) const;

  const System& system_;
  double t_ = 0.0;
  MotionPoint nominal_;
  std::vector<MotionPoint> u_;
  double row_gain_ = 1.0;  // bound of how a torque per deviation of loaded rows acts on the unknowns
  bool stands_ = false;
  // Kept for one time where loads follow the motion: external_known(), tables and knotted loads.
  mutable bool known_found_ = false;
  mutable Vector known_;
  mutable TableLoads::Values tables_;
  mutable KnottedLoads::Values knotted_;
  mutable Vector z_and_rows_, v_and_rows_, p_and_rows_;  // unknowns, then loaded rows
};

}  // namespace drev
