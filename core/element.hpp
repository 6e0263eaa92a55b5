#pragma once
/// What an element (element_interface.hpp) adds to the equation of motion. An element of one's own includes this header,
/// and so do the sources of the catalogue, but not its headers: they do without terms, which are expensive to compile.
#include <drev/core/element_interface.hpp>

#include <Eigen/Core>
#include <string>
#include <vector>

namespace drev {

class FrequencyStiffness;
class Friction;
class GeneralForce;
class Load;
class ScalarForce;

/// b^T q over the element's nodes (internal nodes after the named ones).
using LocalRow = Eigen::VectorXd;

/// x = b^T q - e, f = b y(x, x_dot, t).
struct ScalarSpec {
  LocalRow b;
  const ScalarForce* force = nullptr;  ///< owned by the element
  int phase_node = -1;                 ///< local node whose angle the law sees; -1: none
  bool along_line_of_action = false;   ///< y is a force in N although the nodes rotate (gear mesh)
};

/// A load on a local node.
struct LoadSpec {
  int node = 0;
  const Load* load = nullptr;  ///< owned by the element
  std::string suffix = {};     ///< empty, or what distinguishes several of one element ("2")
};

/// b^T n = 0: what the element asks of the nominal ratios n of its nodes. With one entry the node stands
/// still nominally (it is tied to ground).
struct SpeedRatioConstraint {
  LocalRow b;
  bool only_in_contact = false;  ///< no tie while the contact is open
  /// One entry: a spring acts on the node's deviation, which may turn nominally (a governor); n is free.
  bool holds_deviation = false;
  /// Ties the ratios alone, by no stiffness: a damper's ring turns with its hub, but may drift against it.
  bool ratio_only = false;
};

/// A force or torque to report: stiffness^T q + damping^T v.
struct OutputSpec {
  std::string suffix;  ///< empty, or what distinguishes several of one element ("2")
  LocalRow stiffness, damping;
  /// The deflection b^T q that the force belongs to, reported beside it; empty: none.
  LocalRow deflection = {};
};

/// What a complex stiffness k*(i omega) along b has beyond the element's own matrices. Methods in the frequency
/// domain add it; methods in time know the matrices alone.
struct FrequencySpec {
  LocalRow b;
  const FrequencyStiffness* stiffness = nullptr;  ///< owned by the element
};

/// Dry friction along b (friction.hpp): b lambda on the left side, lambda opposing b^T v.
struct FrictionSpec {
  LocalRow b;
  const Friction* friction = nullptr;  ///< owned by the element
};

/// What an element adds to the equation of motion. The matrices come zeroed, n x n over its nodes.
struct Terms {
  explicit Terms(int nodes);

  Eigen::MatrixXd mass, damping, stiffness;  ///< constant, symmetric
  bool rayleigh = false;                     ///< mass and stiffness take part in C = a M + b K
  /// Constant, symmetric, as damping, but on the rates of the deviations alone: the nominal motion does not drag.
  /// Empty: none.
  Eigen::MatrixXd deviation_damping;
  std::vector<ScalarSpec> scalars;
  std::vector<FrequencySpec> frequency_stiffnesses;
  std::vector<LoadSpec> loads;
  std::vector<const GeneralForce*> generals;
  std::vector<FrictionSpec> frictions;
  std::vector<SpeedRatioConstraint> speed_ratio_constraints;
  /// Rows with b^T q = 0 exactly, eliminated, for the nominal speeds too. Two entries: an ideal ratio. More (a
  /// planetary set): the last node of the row that is free follows the others.
  std::vector<LocalRow> constraints;
  std::vector<OutputSpec> outputs;
  double rayleigh_a = 0.0;  ///< 1/s, for the whole model
  double rayleigh_b = 0.0;  ///< s
};

/// Shared by the elements with two ends or one end and ground: (-1, 1) or (1). The relative motion is
/// end b minus end a; to ground it is the node's own.
LocalRow relative_motion(int nodes);

}  // namespace drev
