#pragma once
/// TorsionalDamper: a torsional vibration damper on a shaft's free end: a hub or housing, and a ring on it.
///
///   hub    J_hub on the node
///   ring   J_ring, tau = k*(f) (theta_ring - theta_hub) + c (omega_ring - omega_hub)     on the hub: +tau
///
///   viscous (Houdaille)    k = 0: housing, ring, silicone fluid; c given, or from the fluid's film
///   tuned rubber           k from stiffness or natural frequency, loss factor (ViscoelasticStiffness)
///   spring and oil         k and c, or damping ratio of the ring on a hub that is held: c = 2 zeta sqrt(k J_ring)
///
/// Natural frequency f_n of the ring on a hub that is held: k = J_ring (2 pi f_n)^2. Film of a fluid of the viscosity
/// mu between concentric surfaces (laminar shear, no slip):
///
///   c = pi mu ((R_o^4 - R_i^4)/h_side + 2 w R_o^3/h_outer + 2 w R_i^3/h_inner)
///
/// R_o, R_i, w: ring's radii and width; h: gaps (both sides; a gap that is not given has no film). The ring brings its
/// own node, `ELEMENT_1`, turning with the hub; channels: torque and relative angle. Heat is in the sweep's sections.
/// Optimum of a viscous damper on J, K (mu = J_ring/J): zeta = c/(2 J_ring w_n) = 1/sqrt(2 (1 + mu)(2 + mu)).
/// Source: J. P. Den Hartog, Mechanical Vibrations, 4th ed., McGraw-Hill, 1956, chapters 3 and 5.
#include <drev/core/units.hpp>
#include <drev/elements/couplings/viscoelastic_stiffness.hpp>

#include <cmath>
#include <optional>

namespace drev {

/// Data of a viscous damper's film.
struct FluidFilm {
  double viscosity = kNotGiven;     ///< mu, at its temperature and shear rate [Pa s], > 0
  double outer_radius = kNotGiven;  ///< R_o [m], > R_i
  double inner_radius = 0.0;        ///< R_i [m], >= 0
  double width = kNotGiven;         ///< w [m], > 0
  double side_gap = 0.0;            ///< h_side, of each side [m]; 0: no film there
  double outer_gap = 0.0;           ///< h_outer [m]; 0: none
  double inner_gap = 0.0;           ///< h_inner [m]; 0: none

  double damping() const;  ///< c [N m s/rad]
  void check(ParameterCheck& check) const;
};

class TorsionalDamper final : public Element {
 public:
  struct Params {
    double hub_inertia = 0.0;                   ///< J_hub, or housing [kg m^2], >= 0
    double ring_inertia = kNotGiven;            ///< J_ring [kg m^2], > 0
    double natural_frequency = kNotGiven;       ///< f_n [Hz], > 0; instead of a stiffness
    ViscoelasticStiffness::Params spring = {};  ///< k, loss factor; nothing of it: viscous damper
    double damping = 0.0;                       ///< c [N m s/rad], >= 0
    double damping_ratio = kNotGiven;           ///< zeta [-], >= 0; instead of c, with a spring
    std::optional<FluidFilm> film = {};         ///< a fluid film in place of c
  };
  explicit TorsionalDamper(Params params);

  const Params& params() const { return params_; }
  double stiffness() const { return stiffness_; }  ///< k [N m/rad]; 0: none
  double damping() const { return damping_; }      ///< c [N m s/rad]
  const ViscoelasticStiffness& spring() const { return spring_; }
  std::string_view type() const override { return "torsional damper"; }
  int min_nodes() const override { return 1; }
  std::vector<NodeKind> internal_nodes() const override {
    return std::vector<NodeKind>(1 + spring_.branches().size(), NodeKind::rotational);
  }
  void check(ParameterCheck& check) const override;
  void describe(int nodes, Terms& terms) const override;

 private:
  bool sprung() const {
    return !std::isnan(params_.natural_frequency) || !std::isnan(params_.spring.stiffness) ||
           !params_.spring.frequencies.empty() || !params_.spring.by_mean_torque.at.empty() ||
           !params_.spring.by_amplitude.at.empty();
  }
  Params params_;
  double stiffness_ = 0.0, damping_ = 0.0;
  ViscoelasticStiffness spring_;
};

}  // namespace drev
