#pragma once
/// EngineCylinders: gas and mass torque of the cylinders of an engine on its crankshaft, one throw a node.
///
///   tau_k = -((p - p_c) A + m_osc x'' w^2) x'      on the RIGHT side: positive drives the crank forward
///
/// x(a) distance from crank centre to piston pin (crank_slider.hpp), x', x'' its derivatives by the crank angle,
/// a = theta_k - (firing angle of the cylinder) the angle from its firing top dead centre, A = pi bore^2/4, p the
/// gas pressure in the cylinder, p_c the crankcase's (or back) pressure, m_osc piston, pin and the rod's upper part,
/// w the speed of the throw. Exact slider-crank, no series. theta_k and w are the actual ones, so that twist and
/// speed feed back; twist_feedback = false takes the nominal ones. The pressure follows the NOMINAL speed of the
/// throw (a curve belongs to the mean speed of a cycle), the actual one where it has no nominal motion.
///
/// Gas: curves of pressure (gas_pressure.hpp); or, the classic way, harmonics of the tangential pressure,
///   (p - p_c) A x' replaced by -A r (t_0 + sum t_i cos(order_i a + phase_i)),   orders a turn of the crank;
/// or none (a motored engine without compression).
///
/// Inertia: m_rot r^2 (crank pin's share of the rod and what else turns at the crank radius) is added to the node,
/// and with mean_oscillating_inertia also the mean of m_osc x'^2. The inertia that varies with the angle acts by its term
/// -m_osc x' x'' w^2, at constant speed all there is, and as usual in orders no more. With varying_inertia its term in the
/// acceleration acts too,
///
///   J(theta) theta_k'' + 1/2 J'(theta) w^2 = other torques,   J = J_node + m_rot r^2 + m_osc x'^2
///
/// without an approximation, in steps of any method, constant or controlled (core/law/varying_inertia.hpp); tau_k, as
/// reported, is then -(p - p_c) A x' - (m_osc x'^2 - mean) theta_k'' - m_osc x' x'' w^2. Modes and statics know the mean.
/// LIMIT: exact propagation, lockstep, projections and methods in the frequency domain refuse it by name.
///
/// Firing may be gated by speed (gas.firing): outside the gate all cylinders compress and expand without injection.
/// Misfire of one cylinder: no injection, compression stays (its pressure is symmetric about the firing dead
/// centre). Mean gas torque of a cylinder = pmi V_h/(4 pi), four strokes.
/// Source: E. J. Nestorides, A Handbook on Torsional Vibration, Cambridge, 1958, chapter 4; IACS UR M53 (half range
/// by synthesis, misfire).
#include <drev/core/element_interface.hpp>
#include <drev/core/law/knotted_load.hpp>
#include <drev/core/law/load_response.hpp>
#include <drev/core/law/speed_scaled_load.hpp>
#include <drev/core/law/varying_inertia.hpp>
#include <drev/elements/engine/crank_slider.hpp>
#include <drev/elements/engine/gas_pressure.hpp>
#include <drev/elements/harmonic.hpp>
#include <drev/elements/not_given.hpp>

#include <string>
#include <vector>

namespace drev {

class EngineCylinders final : public Element {
 public:
  struct Params {
    double bore = kNotGiven;                ///< m, > 0
    double stroke = kNotGiven;              ///< 2 r [m], > 0
    double rod = kNotGiven;                 ///< l [m], > 0.6 stroke
    double oscillating_mass = 0.0;          ///< m_osc of a cylinder [kg], >= 0
    double rotating_mass = 0.0;             ///< m_rot at the crank radius [kg], >= 0
    bool mean_oscillating_inertia = false;  ///< add the mean of m_osc x'^2 to the nodes
    bool varying_inertia = false;           ///< add m_osc x'^2 at the actual angle; needs twist_feedback
    int strokes = 4;                        ///< of a cycle: 2 or 4
    /// Crank angle at the firing top dead centre of each cylinder [rad], one a node; even_firing() finds them.
    std::vector<double> firing_angles = {};
    std::string unread_firing_order =
        {};  ///< an order that even_firing() refuses; empty: angles are those meant
    GasPressure::Params gas = {};
    double crankcase_pressure = 0.0;                 ///< p_c [Pa]
    std::vector<Harmonic> tangential_pressure = {};  ///< instead of gas: order, Pa, rad; no misfire
    double mean_tangential_pressure = 0.0;           ///< t_0 [Pa]
    int misfiring_cylinder = 0;                      ///< number from 1; 0: none
    bool twist_feedback = true;
  };
  explicit EngineCylinders(Params params);

  /// Firing angles of cylinders 1, 2, ... that fire at even intervals of a cycle in an order such as
  /// "1-5-3-6-2-4", the first of them at `first` [rad]. Throws ModelError where a number is missing or twice.
  static std::vector<double> even_firing(const std::string& order, int strokes, double first = 0.0);

  /// What is wrong with an order: empty, nothing.
  static std::string why_no_order(const std::string& order);
  /// The numbers in an order, right or wrong: as many cylinders are meant.
  static std::size_t cylinders_of(const std::string& order);

  const Params& params() const { return params_; }
  std::string_view type() const override { return "set of engine cylinders"; }
  /// One node a cylinder.
  int min_nodes() const override {
    return params_.firing_angles.empty() ? 1 : static_cast<int>(params_.firing_angles.size());
  }
  void check(ParameterCheck& check) const override;
  void describe(int nodes, Terms& terms) const override;
  /// Torque of cylinder k (from 0) at a crank angle and speed that are nominal and actual [rad], [rad/s] -> N m.
  double torque(int k, double angle, double speed) const;
  /// Mean torque of cylinder k over a cycle at a speed [N m].
  double mean_torque(int k, double speed) const;

 private:
  class Cylinder final : public Load, public SpeedScaledLoad, public KnottedLoad, public VaryingInertia {
   public:
    Cylinder(const EngineCylinders& engine, int number) : engine_(engine), number_(number) {}
    LoadResponse evaluate(const LoadInput& in) const override;
    bool depends_on_motion() const override { return engine_.params_.twist_feedback; }
    /// Over the angle it jumps as its table does, which its knots tell: that slope has no bound.
    std::optional<LoadSlopes> steepest(const LoadRanges& over) const override;
    /// w^2 of the mass torque, 1 of what the speed does not move, then those of the gas pressure's curves.
    std::vector<double> speed_factors(double speed) const override;
    double curve(int k, double angle) const override;
    Family family() const override;
    /// P: p - p_c (1 where there are no curves of pressure); S: -A x', or of the tangential pressure; G: -m_osc x' x''.
    CubicPiece piece(double angle, double direction, double nominal_speed) const override;
    bool piece_follows_speed() const override { return engine_.gas_.follows_speed(); }
    Curves curves(double angle) const override;
    int turns() const override;
    bool inertia_varies() const override { return engine_.params_.varying_inertia; }
    double inertia_beyond(double angle) const override;

   private:
    /// The formula: over dual numbers with its slopes. angle: of the crank [rad], from its own top dead centre.
    Dual torque(const Dual& angle, const Dual& speed, const Dual& speed_of_gas) const;
    /// Its parts; first and second: derivatives of the piston's way by the crank angle [m].
    Dual inertia_by_speed_squared(const Dual& first, const Dual& second) const;  ///< N m s^2/rad^2
    Dual by_pressure(const Dual& first) const;                                   ///< N m/Pa
    Dual tangential(const Dual& angle) const;                                    ///< N m

    const EngineCylinders& engine_;
    int number_;
  };

  Params params_;
  CrankSlider crank_;
  double area_ = 0.0, mean_inertia_ = 0.0;  // of the oscillating mass [kg m^2]
  double most_by_speed_squared_ = 0.0;      // largest size of G [N m s^2/rad^2]
  GasPressure gas_;
  std::vector<Cylinder> cylinders_;
};

}  // namespace drev
