#pragma once
/// DistributedShaft: a uniform round shaft with its own inertia, as linear finite elements.
///
///   I_p = pi (D^4 - d^4)/32,  k = G I_p n/L,  J = rho I_p L/n          a segment, n of them
///   K = k [1 -1; -1 1],       M = J/6 [2 1; 1 2]                       consistent mass
///
/// The consistent mass approaches the continuum's frequencies from above, with an error of
/// (omega L/(n c))^2/24 relative, c = sqrt(G/rho): at least 10 segments per wavelength keep it near
/// 2 %. The averaged mass M = J/12 [5 1; 1 5] comes from below, with a far smaller error where the ends carry
/// little inertia; segments_for() (segment_count.hpp) picks n. Positive torque is that of a positive twist,
/// end b minus end a, as in ShaftSpring; outputs "1".."n" count the segments from a to b. Nodes: a, b, then
/// the n - 1 internal ones from a to b. Takes part in Rayleigh damping. density = 0 makes a massless spring,
/// then with one segment only.
///
/// Source: M. I. Friswell, J. E. T. Penny, S. D. Garvey, A. W. Lees, Dynamics of Rotating Machines,
/// Cambridge University Press, 2010, chapter 9.
#include <drev/core/element_interface.hpp>
#include <drev/elements/not_given.hpp>
#include <drev/elements/segment_count.hpp>

namespace drev {

class DistributedShaft final : public Element {
 public:
  struct Params {
    double shear_modulus = kNotGiven;   ///< G [Pa], > 0; steel 8e10
    double density = kNotGiven;         ///< rho [kg/m^3], >= 0; steel 7850
    double outer_diameter = kNotGiven;  ///< D [m], > 0
    double inner_diameter = 0.0;        ///< d [m], 0 <= d < D
    double length = kNotGiven;          ///< L [m], > 0
    int segments = 1;                   ///< n, 1 to kMaxSegments
    SegmentMass mass = SegmentMass::consistent;
  };
  static constexpr int kMaxSegments = 10000;
  explicit DistributedShaft(Params params) : params_(params) {}

  std::string_view type() const override { return "distributed shaft"; }
  int min_nodes() const override { return 2; }
  std::vector<NodeKind> internal_nodes() const override;
  void check(ParameterCheck& check) const override;
  void describe(int nodes, Terms& terms) const override;
  int part_count() const override { return params_.segments; }  ///< the segments, from a to b
  std::vector<int> part_nodes(int part) const override;
  void describe_part(int part, Terms& terms) const override;

  const Params& params() const { return params_; }
  double segment_stiffness() const;  ///< k [N m/rad]
  double segment_inertia() const;    ///< J [kg m^2]

 private:
  Params params_;
};

}  // namespace drev
