#pragma once
/// Nominal kinematics: theta_i = n_i phi(t) + q_i. The ratios n follow from the speed_ratio_constraints b^T n
/// = 0 of shafts, meshes and ideal gears, walked as a graph from the reference node. A loop whose ratios
/// contradict each other cannot turn and is an error that names the loop. Rows over three nodes or more (planetary
/// sets) are solved over the components that the rows over two leave.
#include <drev/core/error.hpp>
#include <drev/core/model.hpp>

#include <string>
#include <utility>
#include <vector>

namespace drev {

/// One speed ratio constraint over model nodes. second < 0: the node is tied to ground, n = 0, or with holds_deviation to its
/// nominal motion.
struct RatioRow {
  int first = 0, second = -1;
  double b_first = 1.0, b_second = 0.0;
  bool only_in_contact = false;
  bool holds_deviation = false;
  bool ratio_only = false;
  int element = -1;  ///< the element that asks for it
};

/// A row over three nodes or more, sum b_i n_i = 0 (a planetary set).
struct WideRatioRow {
  std::vector<std::pair<int, double>> b;  ///< node, coefficient
  bool only_in_contact = false;
  int element = -1;
};

/// What ties the nodes together.
struct Kinematics {
  std::vector<double> ratio;  ///< n_i; 0 for what the reference does not reach
  /// Speeds of the nodes of a component relative to each other, as its rows over two nodes have them.
  std::vector<double> relative;
  std::vector<int> component;  ///< of the closed model, per node, ratios alone included
};

/// Finds the ratios; reports contradicting loops and reference motion of grounded parts.
/// reference < 0: nothing moves nominally and all ratios are 0. prescribed: nodes that stand still where the
/// reference does not reach them (< 0: none).
/// model: its name; element_instances: for the names of the elements.
Kinematics find_ratios(const std::string& model, const std::vector<std::string>& node_names,
                       const std::vector<ElementInstance>& element_instances,
                       const std::vector<RatioRow>& speed_ratio_constraints,
                       const std::vector<WideRatioRow>& wide, const std::vector<int>& prescribed,
                       int reference, std::vector<Finding>& findings);

/// Gaussian elimination of the wide rows over components. component, relative: as above. known: components
/// whose speed is known (0: unknown, 1: known), with the speed. open: without those only_in_contact.
struct ComponentSpeeds {
  std::vector<int> dependent;                      ///< components that a row determines
  std::vector<double> speed;                       ///< of each component; 0 where nothing moves it
  std::vector<const WideRatioRow*> contradicting;  ///< rows that no speed fulfils
  std::vector<const WideRatioRow*> undetermined;  ///< rows that move components which nothing else determines
};
ComponentSpeeds solve_components(const std::vector<WideRatioRow>& wide, const std::vector<int>& component,
                                 const std::vector<double>& relative, const std::vector<bool>& known,
                                 std::vector<double> speed, bool open);

/// Components of the graph of nodes under the speed_ratio_constraints; those only_in_contact are left out if
/// with_contacts is false, those ratio_only if with_ratios is. Returns the component of each node, numbered from 0.
std::vector<int> connected_components(int nodes, const std::vector<RatioRow>& speed_ratio_constraints,
                                      bool with_contacts, bool with_ratios = false);

}  // namespace drev
