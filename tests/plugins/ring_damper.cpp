/// RingDamper: a ring of inertia J_r on a hub, through rubber.
///
///   y = k x + k3 x^3 + c x'  [N m],  x = q_ring - q_hub [rad];   J_r q_ring'' + y = 0
///
/// Positive torque is that of a ring ahead of its hub. Nodes: the hub; the ring is the internal node.
#include <drev/app/model_file/plugin.hpp>
#include <drev/elements/own_element.hpp>

namespace {

using namespace drev;

struct RubberLaw {
  double k = kNotGiven;  ///< N m/rad, > 0
  double k3 = 0.0;       ///< N m/rad^3, >= 0
  double c = 0.0;        ///< N m s/rad, >= 0
  template <class T>
  T force(const T& x, const T& x_dot) const {
    return (k + k3 * x * x) * x + c * x_dot;
  }
  double stored_energy(double x) const { return (k / 2 + k3 * x * x / 4) * x * x; }
};

class RingDamper final : public Element {
 public:
  struct Params {
    double inertia = kNotGiven;  ///< J_r, kg m^2, > 0
    RubberLaw rubber;
  };
  explicit RingDamper(Params p) : params_(p), rubber_(p.rubber) {}
  std::string_view type() const override { return "ring damper"; }
  int min_nodes() const override { return 1; }
  std::vector<NodeKind> internal_nodes() const override { return {NodeKind::rotational}; }
  void check(ParameterCheck& check) const override {
    check.positive("inertia", params_.inertia, "kg m^2");
    check.positive("stiffness", params_.rubber.k, "N m/rad");
    check.non_negative("cubic_Nm_per_rad3", params_.rubber.k3, "N m/rad^3");
    check.non_negative("damping", params_.rubber.c, "N m s/rad");
  }
  void describe(int nodes, Terms& terms) const override {
    terms.mass(1, 1) = params_.inertia;
    terms.scalars.push_back({.b = relative_motion(nodes), .force = &rubber_});
    terms.speed_ratio_constraints.push_back({.b = relative_motion(nodes)});
  }
  const Params& params() const { return params_; }

 private:
  Params params_;
  LawForce<RubberLaw> rubber_;
};

}  // namespace

DREV_PLUGIN() {
  using namespace drev::app;
  register_element<RingDamper>("ring_damper", [](Fields& f, RingDamper::Params& p) {
    f.number({"inertia", Dimension::inertia}, p.inertia, Need::required);
    f.number({"stiffness", Dimension::torsional_stiffness}, p.rubber.k, Need::required);
    f.number({"cubic_Nm_per_rad3", Dimension::none}, p.rubber.k3);
    f.number({"damping", Dimension::torsional_damping}, p.rubber.c);
  });
}
