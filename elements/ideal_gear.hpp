#pragma once
/// IdealGear: a rigid speed ratio between two nodes, without mass, backlash or compliance.
///
///   omega_2 = ratio omega_1,      constraint  ratio q_1 - q_2 = 0
///
/// The ratio is signed: an external pair of z_1 and z_2 teeth has -z_1/z_2. Powers are equal:
/// tau_1 + ratio tau_2 = 0 for the torques on the two shafts. The constraint is eliminated, not
/// penalised.
#include <drev/core/element_interface.hpp>
#include <drev/elements/not_given.hpp>

namespace drev {

class IdealGear final : public Element {
 public:
  struct Params {
    double ratio = kNotGiven;  ///< omega_2 / omega_1 [-], finite, not 0; external pair: < 0
  };
  explicit IdealGear(Params params) : params_(params) {}

  const Params& params() const { return params_; }
  std::string_view type() const override { return "ideal gear"; }
  int min_nodes() const override { return 2; }
  void check(ParameterCheck& check) const override;
  void describe(int nodes, Terms& terms) const override;

 private:
  Params params_;
};

}  // namespace drev
