#pragma once
/// ElasticCoupling: a flexible coupling between two shafts, or a shaft with material damping, from data-sheet values.
///
///   tau = k*(f) (theta_b - theta_a) + c (omega_b - omega_a)        end b minus end a
///
/// tau acts on a as +tau, on b as -tau, as ShaftSpring's. k* has a loss factor: its equation, the chain that stands for
/// it in time and the error of that are ViscoelasticStiffness's. Both ends have the same nominal speed. Takes no part
/// in Rayleigh damping. Brings a node for each branch of the chain (`ELEMENT_1`, ...), a relative twist, that no shaft
/// turns. Rotational nodes only.
#include <drev/elements/couplings/viscoelastic_stiffness.hpp>

namespace drev {

class ElasticCoupling final : public Element {
 public:
  struct Params {
    ViscoelasticStiffness::Params material =
        {};                ///< stiffness, loss factor, their tables, the band of the fit
    double damping = 0.0;  ///< c, viscous, beside it [N m s/rad], >= 0
  };
  explicit ElasticCoupling(Params params) : params_(std::move(params)), spring_(params_.material) {}

  const Params& params() const { return params_; }
  const ViscoelasticStiffness& spring() const { return spring_; }
  std::string_view type() const override { return "elastic coupling"; }
  int min_nodes() const override { return 2; }
  std::vector<NodeKind> internal_nodes() const override {
    return std::vector<NodeKind>(spring_.branches().size(), NodeKind::rotational);
  }
  void check(ParameterCheck& check) const override;
  void describe(int nodes, Terms& terms) const override;

 private:
  Params params_;
  ViscoelasticStiffness spring_;
};

}  // namespace drev
