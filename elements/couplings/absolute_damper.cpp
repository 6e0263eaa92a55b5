#include <drev/core/element.hpp>
#include <drev/elements/couplings/absolute_damper.hpp>

namespace drev {

void AbsoluteDamper::check(ParameterCheck& check) const {
  check.non_negative("damping", params_.damping, "N m s/rad");
}

void AbsoluteDamper::describe(int nodes, Terms& terms) const {
  terms.deviation_damping = Eigen::MatrixXd::Zero(nodes, nodes);
  terms.deviation_damping(0, 0) = params_.damping;
  LocalRow b = LocalRow::Zero(nodes), none = b;
  b[0] = params_.damping;
  terms.outputs.push_back({.suffix = "", .stiffness = none, .damping = b});
}

}  // namespace drev
