#pragma once
/// BacklashLaw: two flanks with a gap between them (dead zone), linear stiffness, damping.
///
///   p = x - b  (x > b),   p = x + b  (x < -b),   p = 0 between;       b = normal_backlash/2
///   y = k p + c_eff x_dot                                             in contact
///
/// clipped so that no flank pulls: y >= 0 in front, y <= 0 behind (all laws but `always`).
/// x and y as in ScalarForce: N and m along a line of action (or N m and rad). k is passed in,
/// because it may follow the mesh's phase. Stored energy k p^2/2; dissipated power (y - k p) x_dot,
/// never < 0.
///
/// Damping laws:
///   proportional  c_eff = c min(|p|/p_ref, 1). The default: the force stays continuous where the
///                 flanks meet, so no order of accuracy is lost there and energy cannot leak
///                 through a jump. For |p| < p_ref, y = p (k + c x_dot/p_ref): the clip acts
///                 exactly where the bracket is negative, so y never falls with x. Beyond p_ref it
///                 is the linear damper c, which is what modes with closed contact see. (After the
///                 idea of K. H. Hunt, F. R. E. Crossley, Coefficient of restitution interpreted as
///                 damping in vibroimpact, J. Appl. Mech. 42, 1975, whose damping grows with p
///                 without bound; saturated here.)
///   limited       the damper's force is limited to the spring's: y = k p + c x_dot, but between 0
///                 and 2 k p on the front flank (mirrored behind). Continuous at the edge, without
///                 a parameter of its own. (Modelica Standard Library,
///                 Mechanics.Rotational.Components.ElastoBacklash.)
///   contact_only  c_eff = c in contact: the force jumps by c x_dot where the flanks meet. Never
///                 pulls. A discrete step can then be left without a solution.
///   always        y = k p + c x_dot everywhere, in the gap too, and may pull. The law of the
///                 source, S. L. Sunde, Mechanical analysis of camshaft system on a marine engine,
///                 NTNU, 2015, equation 4.4; here to reproduce it. Drags on gears that do not
///                 touch.
///
/// docs/catalogue.md compares them. In units of k the law is piecewise, y = k Y(x, x_dot/k): Y is stated
/// once, as pieces, and the call and the pieces at any k follow from it.
///
/// p_ref (reference_penetration) wants to be small against the penetration under load, so that c is
/// the mesh's damping, and large against the distance of one time step at impact, so that it is
/// resolved. Default: b/20, i.e. 2 um for 80 um of total backlash.
///
/// Without backlash (0) both flanks touch: y = k x + c x_dot for every damping law, linear,
/// bilateral, no gap and no clip.
///
/// With `stiffening` k p is k S(p) everywhere above, S a line of straight stretches: slope slopes[i] from
/// penetrations[i] on. A mesh gets stiffer with its load, since contacts grow with it.
#include <drev/core/error.hpp>
#include <drev/core/law/piecewise_law.hpp>
#include <drev/elements/curve.hpp>
#include <drev/elements/not_given.hpp>

#include <optional>
#include <span>
#include <vector>

namespace drev {

enum class MeshDamping { proportional, limited, contact_only, always };

/// Slopes of a flank's spring over its penetration, in parts of k; empty: 1 everywhere.
struct Stiffening {
  std::vector<double>
      penetrations;            ///< m, ascending from 0; the second >= p_ref where damping rises up to that
  std::vector<double> slopes;  ///< of the stretch from there on, > 0
};

class BacklashLaw {
 public:
  struct Params {
    double normal_backlash = 0.0;  ///< 2 b, TOTAL gap [m], >= 0
    double damping = 0.0;          ///< c [N s/m], >= 0
    MeshDamping damping_law = MeshDamping::proportional;
    double reference_penetration = kNotGiven;  ///< p_ref [m], > 0; NaN: b/20
    Stiffening stiffening = {};
  };
  explicit BacklashLaw(const Params& params);

  /// stiffness: k [N/m] and its slope against the phase node's angle [N/(m rad)].
  ScalarResponse evaluate(double x, double x_dot, CurvePoint stiffness) const {
    return unit_.evaluate(x, x_dot, stiffness.value, stiffness.slope);
  }
  double damping() const { return params_.damping; }
  bool has_gap() const { return half_gap_ > 0.0; }
  std::optional<Gap> gap() const { return unit_.gap(); }
  /// Edges of the gap; with proportional damping also where it saturates.
  std::span<const double> kinks() const { return unit_.kinks(); }
  /// The law as pieces at a constant stiffness [N/m]. Damping that grows with penetration has a product.
  std::vector<LawPiece> pieces(double stiffness) const { return unit_.scaled(stiffness); }
  void check(ParameterCheck& check) const;

 private:
  /// A stretch of S: at + slope p from `from` on.
  struct Stretch {
    double from = 0.0, at = 0.0, slope = 1.0;
  };
  static std::vector<Stretch> stretches_of(const Stiffening& stiffening);
  std::vector<LawPiece> unit_pieces() const;
  LawPiece spring(std::size_t stretch, int side, double factor, double c) const;
  LawBound pulls(std::size_t stretch, int side, double c, double sign, int next) const;
  void bound_stretch(LawPiece& piece, std::size_t stretch, int side, int below, int above) const;
  std::vector<LawPiece> plain_damper() const;
  std::vector<LawPiece> switched_damper(bool limited) const;
  std::vector<LawPiece> rising_damper() const;

  Params params_;
  double half_gap_, p_ref_;
  std::vector<Stretch> stretches_;
  PiecewiseLaw unit_;  // the one statement of the law: y = k Y(x, x_dot/k), Y at k = 1
};

}  // namespace drev
