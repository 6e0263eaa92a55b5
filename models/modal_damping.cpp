#include <drev/core/assembler.hpp>
#include <drev/core/system.hpp>
#include <drev/models/modal_damping.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/dense/eigenvalues.hpp"

namespace drev {

namespace {

constexpr int kMostUnknowns = 1000;

Eigen::MatrixXd dense_of(const System& system, const Vector& values) {
  SparseMatrix matrix = system.pattern();
  std::copy(values.begin(), values.end(), matrix.valuePtr());
  return Eigen::MatrixXd(matrix);
}

/// A node that moves as each unknown does.
std::vector<NodeRef> nodes_of_unknowns(const System& system) {
  std::vector<int> nodes(idx(system.size()), -1);
  for (int node = 0; node < system.node_count(); ++node) {
    const std::vector<Entry> row = system.row_of(node);
    if (row.size() == 1 && row.front().coeff == 1.0 && nodes[idx(row.front().index)] < 0)
      nodes[idx(row.front().index)] = node;
  }
  std::vector<NodeRef> refs;
  for (const int node : nodes)
    if (node >= 0) refs.emplace_back(NodeId{node});
  return refs;
}

}  // namespace

void add_modal_damping(Model& model, const std::string& name, const ModalDamping::Params& params) {
  std::vector<Finding> findings;
  ParameterCheck check(model.name() + "/" + name, findings);
  ModalDamping(params, Eigen::MatrixXd::Zero(1, 1)).check(check);
  std::optional<System> built;
  try {
    built = model.build();
  } catch (const ModelError& error) {
    findings.insert(findings.end(), error.findings().begin(), error.findings().end());
  }
  if (!built) throw ModelError(std::move(findings));
  const System& system = *built;
  const int n = system.size();
  if (n > kMostUnknowns)
    check.fail("unknowns", std::to_string(n), "",
               "must be at most " + std::to_string(kMostUnknowns) + ": the damping matrix of modes is dense");
  if (system.any_prescribed_moves())
    check.fail(
        "given motion", "a node", "",
        "must not be there: modal damping acts on deviations from nodes at rest or at their nominal speed");
  if (!findings.empty()) throw ModelError(std::move(findings));
  Vector mass, stiffness;
  const Assembler assembler(system);
  assembler.contact_values({1.0, 0.0, 0.0}, Contact::closed, mass);
  assembler.contact_values({0.0, 0.0, 1.0}, Contact::closed, stiffness);
  const Eigen::MatrixXd m = dense_of(system, mass);
  const SymmetricEigen modes = symmetric_eigen(dense_of(system, stiffness), m);
  if (!modes.converged)
    throw ModelError({{model.name() + "/" + name, "", "", "", "its modes could not be solved for"}});
  const ModalDamping ratios(params);
  Eigen::MatrixXd damping = Eigen::MatrixXd::Zero(n, n);
  const int rigid = system.rigid_mode_count(Contact::closed);
  for (int j = rigid; j < n; ++j) {
    const double omega = std::sqrt(std::max(0.0, modes.values[j]));
    const Vector row = m * modes.vectors.col(j);
    damping += 2.0 * ratios.ratio_of(idx(j - rigid)) * omega * row * row.transpose();
  }
  damping = (0.5 * (damping + damping.transpose())).eval();
  std::vector<NodeRef> nodes = nodes_of_unknowns(system);
  if (static_cast<int>(nodes.size()) != n)
    throw ModelError({{model.name() + "/" + name, "", "", "",
                       "an ideal gear or planetary set leaves a motion that no node has by itself"}});
  model.add(name, nodes, std::make_shared<const ModalDamping>(params, std::move(damping)));
}

}  // namespace drev
