#include <drev/core/element.hpp>

namespace drev {

Terms::Terms(int nodes)
    : mass(Eigen::MatrixXd::Zero(nodes, nodes)),
      damping(Eigen::MatrixXd::Zero(nodes, nodes)),
      stiffness(Eigen::MatrixXd::Zero(nodes, nodes)) {}

LocalRow relative_motion(int nodes) {
  LocalRow b(nodes);
  if (nodes == 1)
    b << 1.0;
  else
    b << -1.0, 1.0;
  return b;
}

}  // namespace drev
