#pragma once
/// GearMesh: two gears in mesh, with compliance, backlash and damping along the line of action.
///
///   external pair   x = r_b1 theta_1 + r_b2 theta_2 - e      both angles about one axis sense
///   internal pair   x = r_b1 theta_1 - r_b2 theta_2 - e      gear 2 is the ring
///   f = b y(x, x_dot),   b = (r_b1, +-r_b2)                y: BacklashLaw [N], the force reported
///
/// A third node carries the bearings of both gears, a housing or a planet carrier that turns by theta_c:
///
///   external   x = r_b1 theta_1 + r_b2 theta_2 - (r_b1 + r_b2) theta_c - e
///   internal   x = r_b1 theta_1 - r_b2 theta_2 - (r_b1 - r_b2) theta_c - e
///
/// It takes the gears' reaction. A planet is a node with one mesh to the sun (external) and one to the ring
/// (internal, gear 1 the planet), both with the carrier as third node. The mesh phase is that of gear 1's own angle:
/// right for a housing, not for a carrier that turns.
///
/// y > 0: the flanks in front carry (gear 1 turned forward relative to the mesh); y brakes gear 1
/// with the torque r_b1 y. e is the transmission error. Nominal speeds: r_b1 n_1 +- r_b2 n_2 = 0.
///
/// Radii: give base_radius_1 and _2, or module, teeth_1, teeth_2 and pressure_angle (r_b = m z
/// cos(alpha)/2; helical gears: transverse module and pressure angle). Both are accepted if they
/// agree to 0.1 % (printed radii are rounded); the base radii given are then used.
///
/// The stiffness follows the load where `stiffening` is given: k(s) S(p) in place of k(s) p (backlash_law.hpp); modes
/// take k, the slope at the load where S has the slope 1.
///
/// The stiffness follows the mesh phase s = teeth_1 theta_1/(2 pi) + mesh_phase of gear 1's ACTUAL
/// angle; the transmission error takes gear 1's nominal angle. The tangent leaves out the coupling
/// through the phase (dy/dangle is given for those who want it).
///
/// Limits: rigid gear bodies, no friction on the flanks, gap centred at x = 0, same stiffness on
/// both flanks, contact ratio and backlash constant. Stiffness along the line of action: torque
/// stiffness of gear 1 with gear 2 held, divided by r_b1^2.
///
/// Source: S. L. Sunde, Mechanical analysis of camshaft system on a marine engine, NTNU, 2015,
/// equations 4.2 to 4.5, with the signs of one common axis sense.
#include <drev/core/element_interface.hpp>
#include <drev/core/law/angle_scaled_force.hpp>
#include <drev/elements/backlash_law.hpp>
#include <drev/elements/mesh_stiffness.hpp>
#include <drev/elements/transmission_error.hpp>

namespace drev {

class GearMesh final : public Element, public ScalarForce, public AngleScaledForce {
 public:
  struct Params {
    double base_radius_1 = kNotGiven;     ///< r_b1 [m], > 0
    double base_radius_2 = kNotGiven;     ///< r_b2 [m], > 0; internal: > r_b1
    double module = kNotGiven;            ///< m [m], > 0
    int teeth_1 = 0;                      ///< z_1; needed where stiffness or error varies
    int teeth_2 = 0;                      ///< z_2
    double pressure_angle = kNotGiven;    ///< alpha [rad], 0 <= alpha < pi/2
    bool internal = false;                ///< gear 2 is a ring
    MeshStiffness stiffness = kNotGiven;  ///< k [N/m]: a number, or step, fourier, table
    double normal_backlash = 0.0;         ///< TOTAL gap along the line of action [m], >= 0
    double damping = 0.0;                 ///< c [N s/m], >= 0
    MeshDamping damping_law = MeshDamping::proportional;
    double reference_penetration = kNotGiven;  ///< p_ref [m], > 0; NaN: normal_backlash/40
    Stiffening stiffening = {};                ///< with the load: k(s) times a slope of the penetration
    TransmissionError transmission_error = {};
    double mesh_phase = 0.0;  ///< offset of the mesh phase [mesh periods]
  };
  explicit GearMesh(Params params);

  std::string_view type() const override { return "gear mesh"; }
  int min_nodes() const override { return 2; }
  int max_nodes() const override { return 3; }
  void check(ParameterCheck& check) const override;
  void describe(int nodes, Terms& terms) const override;

  const Params& params() const { return params_; }
  double base_radius_1() const { return radius_1_; }
  double base_radius_2() const { return radius_2_; }

  ScalarResponse evaluate(const ScalarInput& in) const override;
  double closed_stiffness() const override { return mean_stiffness_; }
  double closed_damping() const override { return params_.damping; }
  std::span<const double> kinks() const override { return law_.kinks(); }
  std::optional<Gap> gap() const override { return law_.gap(); }
  bool varies() const override { return params_.stiffness.varies(); }
  Offset offset(double nominal_angle) const override;
  bool has_offset() const override { return params_.transmission_error.varies(); }
  /// At the mean stiffness.
  std::span<const LawPiece> pieces() const override { return pieces_; }
  double pieces_scale(double angle) const override;
  ScaleStretch scale_stretch(double angle, double direction) const override;
  std::optional<double> next_knot(double angle, double direction) const override;
  std::optional<double> next_offset_knot(double nominal_angle, double direction) const override;

 private:
  void check_radii(ParameterCheck& check) const;
  std::optional<double> angle_of(std::optional<double> knot, double angle) const;  // of a phase near it
  double phase(double angle) const { return teeth_per_radian_ * angle + params_.mesh_phase; }
  CurvePoint stiffness(double angle) const;  // and its slope by the angle of gear 1

  Params params_;
  BacklashLaw law_;
  double radius_1_, radius_2_, teeth_per_radian_, mean_stiffness_;
  std::vector<LawPiece> pieces_;
  std::vector<ScaleOrder> orders_;  // of the stiffness over its mean, per revolution of gear 1
};

/// LateralGearMesh: two gears in mesh whose centres move along the line of action, on bearings that give: torsion and
/// lateral motion together.
///
///   external pair   x = r_b1 theta_1 + y_1 + r_b2 theta_2 + y_2 - e
///   internal pair   x = r_b1 theta_1 + y_1 - (r_b2 theta_2 + y_2) - e           gear 2 is the ring
///   f = b F(x, x_dot)           F: the mesh's force [N], that of GearMesh with the same parameters
///
/// Nodes: gear 1, gear 2 (rotational), centre of gear 1, centre of gear 2 (translational). y_i: displacement of the centre of
/// gear i along the line of action, positive in the direction in which r_bi theta_i moves its flank. The centre takes the
/// whole force of the mesh; its mass is an Inertia, its bearing a GroundSpring on its node, a centre that does not move is
/// held. Nominal speeds obey the ratio of the base radii, centres have none. Stiffness, backlash, damping law, transmission
/// error and mesh phase are GearMesh's.
///
/// Limits: the direction of the line of action is fixed (a gear that carries several meshes has them on one line, or a centre
/// node for each direction, tied by nothing); motion across it, tilting and gyroscopic torques are left out; the contact
/// ratio does not follow the centre distance.
/// Source: A. Kahraman, R. Singh, Non-linear dynamics of a geared rotor-bearing system with multiple clearances, J. Sound
/// Vib. 144 (1991) 469 (gear pair with translation along the line of action).
class LateralGearMesh final : public Element {
 public:
  using Params = GearMesh::Params;
  explicit LateralGearMesh(Params params) : mesh_(std::move(params)) {}

  const Params& params() const { return mesh_.params(); }
  const GearMesh& mesh() const { return mesh_; }
  std::string_view type() const override { return "lateral gear mesh"; }
  int min_nodes() const override { return 4; }
  bool mixes_kinds() const override { return true; }
  void check(ParameterCheck& check) const override;
  void describe(int nodes, Terms& terms) const override;

 private:
  GearMesh mesh_;
};

}  // namespace drev
