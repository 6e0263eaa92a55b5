#pragma once
/// Nominal kinematics: theta_i = n_i phi(t) + q_i. The ratios n follow from the speed_ratio_constraints b^T n
/// = 0 of shafts, meshes and ideal gears, walked as a graph from the reference node. A loop whose ratios
/// contradict each other cannot turn and is an error that names the loop.
#include <drev/core/error.hpp>
#include <drev/core/model.hpp>

#include <string>
#include <vector>

namespace drev {

/// One closure over model nodes. second < 0: the node is tied to ground, n = 0.
struct Closure {
  int first = 0, second = -1;
  double b_first = 1.0, b_second = 0.0;
  bool only_in_contact = false;
  int element = -1;  ///< that asks for it
};

/// What ties the nodes together.
struct Kinematics {
  std::vector<double> ratio;   ///< n_i; 0 for what the reference does not reach
  std::vector<int> component;  ///< of the closed model, per node
};

/// Finds the ratios; reports contradicting loops and reference motion of grounded parts.
/// reference < 0: nothing moves nominally and all ratios are 0.
/// model: its name; element_instances: for the names of the elements.
Kinematics find_ratios(const std::string& model, const std::vector<std::string>& node_names,
                       const std::vector<ElementInstance>& element_instances,
                       const std::vector<Closure>& speed_ratio_constraints, int reference,
                       std::vector<Finding>& findings);

/// Components of the graph of nodes under the speed_ratio_constraints; those only_in_contact are left out if
/// with_contacts is false. Returns the component of each node, numbered from 0.
std::vector<int> connected_components(int nodes, const std::vector<Closure>& speed_ratio_constraints,
                                      bool with_contacts);

}  // namespace drev
