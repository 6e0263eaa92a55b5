#pragma once
/// System: the immutable result of Model::build(). Holds the constant matrices, the terms that are not
/// constant, and the map between the user's nodes and the unknowns. One System serves many threads.
///
///   M z'' + C z' + K z + sum_j b_j y_j(x_j, x_j', t) = p(t, q) - m phi'' - d phi' - coupling to u(t)
///
/// Every node's deviation is q_i = coeff z_k or q_i = coeff u_k: prescribed nodes (u) and ideal gear
/// ratios are eliminated. m = T^T M n, and d = T^T C n is the mean drag of dashpots whose ends differ in
/// nominal speed (zero for shafts and meshes). Of a projected system (ritz_projection.hpp) also q_i =
/// coeff r z with a row r over all unknowns.
#include <drev/core/model.hpp>
#include <drev/core/table_loads.hpp>

#include <Eigen/SparseCore>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

namespace drev {

class FrequencyStiffness;
class Friction;
class GeneralForce;
class Load;
class ScalarForce;
class VaryingInertia;

static_assert(
    EIGEN_DEFAULT_ALIGN_BYTES == 64,
    "compile with -DEIGEN_MAX_ALIGN_BYTES=64, as drev's CMake targets and drev.pc say: drev and its "
    "user free each other's vectors");

using Vector = Eigen::VectorXd;
using SparseMatrix = Eigen::SparseMatrix<double>;
/// Rows over the unknowns, each in one piece of memory.
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// q_node = coeff * z[unknown], or coeff * u[prescribed], or coeff * rows().row(row) z.
struct NodeMap {
  int unknown = -1;
  int prescribed = -1;
  double coeff = 1.0;
  int row = -1;
};

/// coefficient of one unknown (or prescribed motion, or node) in a row
struct Entry {
  int index = 0;
  double coeff = 0.0;
};
/// sum coeff x[index] over a row.
template <class X>
auto value_along(const std::vector<Entry>& row, const X& x) {
  std::remove_cvref_t<decltype(x[0])> sum = 0.0;
  for (const Entry& e : row) sum += e.coeff * x[e.index];
  return sum;
}

/// x = sum z + sum u - e.
struct ScalarTerm {
  ElementId element{};
  const ScalarForce* force = nullptr;
  std::vector<Entry> z, u;
  std::vector<Entry> nodes;  ///< b over nodes, before elimination
  int phase_node = -1;
  bool along_line_of_action = false;
  bool varies = false;     ///< as its law says
  std::vector<int> slots;  ///< of (z_a, z_b), row by row, in the pattern's values
};

/// What methods in the frequency domain add: b k*(i omega) b^T.
struct FrequencyTerm {
  ElementId element{};
  const FrequencyStiffness* stiffness = nullptr;
  std::vector<Entry> nodes, z;  ///< b over nodes; over the unknowns
};

struct LoadTerm {
  ElementId element{};
  int node = 0;
  const Load* load = nullptr;
  int slot = -1;            ///< diagonal slot of its unknown; -1 where the node has none
  std::string suffix = {};  ///< of its channel, for elements with several loads
};

struct GeneralTerm {
  ElementId element{};
  const GeneralForce* force = nullptr;
  std::vector<int> nodes;
  int history_begin = 0;
  std::vector<int> slots;  ///< -1 where a node is prescribed
};

/// Dry friction, over nodes before elimination.
struct FrictionTerm {
  ElementId element{};
  const Friction* friction = nullptr;
  std::vector<Entry> nodes;
  int history_begin = 0;
};

/// A force or torque to report, or the deflection of a law that is a straight line, over nodes.
struct OutputTerm {
  ElementId element{};
  std::string suffix;
  std::vector<Entry> stiffness, damping;
  bool along_line_of_action = false;
  bool deflection = false;
};

/// The unknown z[k] whose inertia follows the angles of nodes that move with it (VaryingInertia).
struct VaryingInertiaRow {
  struct Part {
    const VaryingInertia* inertia;
    int node;
  };
  int unknown = 0;
  double constant = 0.0;         ///< its entry of the mass matrix, alone in its row
  std::vector<Part> parts = {};  ///< of one load each
  std::vector<Entry> laws = {};  ///< scalar terms with their coefficients of the unknown
};

/// b_first q_first + b_second q_second = 0, exactly.
struct IdealRatio {
  ElementId element{};
  int first = 0, second = 0;
  double b_first = 0.0, b_second = 0.0;
};

/// Constant matrices that belong together: mass, damping (Rayleigh included), stiffness.
struct MatrixSet {
  SparseMatrix mass, damping, stiffness;
};

/// State of the contacts that a linearisation is made about.
enum class Contact {
  closed,  ///< every contact closed, mesh stiffness at its mean over the phase
  open     ///< every law that has a gap is open
};

class System {
 public:
  // Defined in system.cpp: each file that copies systems would compile these anew.
  System(const System& other);
  System(System&& other) noexcept;
  System& operator=(const System& other);
  System& operator=(System&& other) noexcept;
  ~System();

  const std::string& name() const { return name_; }
  int size() const { return static_cast<int>(unknown_node_.size()); }  ///< number of unknowns
  int node_count() const { return static_cast<int>(node_names_->size()); }
  int prescribed_count() const { return static_cast<int>(prescribed_.size()); }
  int history_size() const { return history_size_; }
  /// What its copies share and no other system has: by it channels and observers know whose they are.
  std::shared_ptr<const void> layout() const { return pattern_; }
  const std::vector<std::string>& node_names() const { return *node_names_; }
  NodeKind node_kind(int node) const { return node_kinds_[idx(node)]; }
  const NodeMap& node_map(int node) const { return node_map_[idx(node)]; }
  /// Rows of the nodes that have one; the first loaded_rows() of them are nodes with loads.
  const RowMatrix& rows() const { return rows_; }
  int loaded_rows() const { return loaded_rows_; }
  /// The node's deviation over the unknowns; empty where it is prescribed.
  std::vector<Entry> row_of(int node) const;
  /// Position of a node by name; throws ModelError with the nearest name.
  int node(const std::string& name) const;
  int node_of(const NodeRef& ref) const { return ref.id ? index(*ref.id) : node(ref.name); }
  /// Place of a node that is not prescribed among the unknowns and, behind them, rows().
  int place(const NodeMap& map) const { return map.unknown >= 0 ? map.unknown : size() + map.row; }
  const std::vector<ElementInstance>& element_instances() const { return *element_instances_; }
  /// What the elements report, in their order; asked of them anew.
  std::vector<OutputTerm> outputs() const;
  /// A node that stands for unknown z[k], for messages.
  const std::string& unknown_name(int k) const { return (*node_names_)[idx(unknown_node_[idx(k)])]; }

  /// n_i: nominal ratio of the node to the reference shaft.
  double ratio(int node) const { return ratio_[idx(node)]; }
  const std::optional<Motion>& reference() const { return reference_; }
  /// |phi'| at t = 0 [rad/s]; 0 without a reference shaft.
  double reference_speed() const;
  /// Motions u_k of the prescribed nodes; empty function: u = 0.
  const std::vector<Motion>& prescribed() const { return prescribed_; }
  int prescribed_node(int k) const { return prescribed_node_[idx(k)]; }
  bool any_prescribed_moves() const { return any_prescribed_moves_; }

  /// Union of all element cliques, structurally symmetric; its values are not used.
  const SparseMatrix& pattern() const { return *pattern_; }
  /// Values of M, C, K on the pattern.
  const Vector& mass_values() const { return mass_; }
  const Vector& damping_values() const { return damping_; }
  const Vector& stiffness_values() const { return stiffness_; }
  /// Slots of the diagonal; and whether M, C hold nothing else (lumped inertias).
  const std::vector<int>& diagonal_slots() const { return diagonal_slots_; }
  bool mass_is_diagonal() const { return mass_is_diagonal_; }
  bool damping_is_diagonal() const { return damping_is_diagonal_; }
  /// Columns of the prescribed motions: rows are unknowns (zu) or prescribed motions (uu).
  const MatrixSet& coupling_zu() const { return zu_; }
  const MatrixSet& coupling_uu() const { return uu_; }
  /// Over nodes, before elimination; only where the model has ideal ratios (to find their torques).
  const std::optional<MatrixSet>& node_matrices() const { return node_matrices_; }
  const Vector& node_drag() const { return node_drag_; }
  /// m and d over unknowns, then prescribed motions.
  const Vector& nominal_inertia() const { return nominal_inertia_; }
  const Vector& nominal_drag() const { return nominal_drag_; }

  /// The scalar terms whose laws are no straight lines; those that are stand in the matrices.
  const std::vector<ScalarTerm>& scalars() const { return scalars_; }
  const std::vector<LoadTerm>& loads() const { return loads_; }
  /// Those of the loads on unknowns that are tables of even spacing.
  const TableLoads& table_loads() const { return table_loads_; }
  /// Those that say their knots and curves (an engine's cylinders).
  const KnottedLoads& knotted_loads() const { return knotted_loads_; }
  /// Places in loads() of those on unknowns that are neither: which follow the motion, which do not.
  const std::vector<int>& moving_loads() const { return moving_loads_; }
  const std::vector<int>& known_loads() const { return known_loads_; }
  /// Inertias that follow an angle.
  const std::vector<VaryingInertiaRow>& varying_inertias() const { return varying_inertias_; }
  /// Why `method`, of which that is said, does not take the system's varying inertia: names an element of it; none if
  /// there is no such inertia. steps: a method of steps can be taken in its place, and is advised.
  std::optional<std::string> why_not_varying_inertia(const std::string& method, bool steps = true) const;
  const std::vector<FrequencyTerm>& frequency_terms() const { return frequency_terms_; }
  const std::vector<GeneralTerm>& generals() const { return generals_; }
  const std::vector<FrictionTerm>& frictions() const { return frictions_; }
  const std::vector<IdealRatio>& ideal_ratios() const { return ideal_ratios_; }
  bool loads_depend_on_motion() const { return loads_depend_on_motion_; }
  bool symmetric_tangent() const { return symmetric_tangent_; }

  /// Times at which a load or known motion jumps or kinks, ascending, without doubles [s].
  const std::vector<double>& breakpoints() const { return breakpoints_; }
  const Vector& initial_deviation() const { return initial_z_; }
  const Vector& initial_rate() const { return initial_v_; }
  /// The same system with other initial conditions, over the unknowns. Throws ModelError where a size is
  /// not size() or a value is not finite.
  System with_initial(Vector deviation, Vector rate) const;
  /// z' while the reference shaft turns at 1 rad/s more and everything with it at its ratio.
  const Vector& nominal_direction() const { return nominal_direction_; }

  /// Number of rigid-body motions, from the graph: parts tied neither to ground nor to a prescribed
  /// node. Names of one node each, for messages.
  std::vector<std::string> floating_parts(Contact contact) const;
  int rigid_mode_count(Contact contact) const { return static_cast<int>(floating(contact).size()); }
  /// The other modes, contacts closed.
  int elastic_mode_count() const { return size() - rigid_mode_count(Contact::closed); }

 private:
  friend class SystemBuilder;
  friend class RitzProjector;
  System() = default;
  /// Puts load `number` with those that external() evaluates alike.
  void map_load(int number);
  const std::vector<int>& floating(Contact contact) const {
    return contact == Contact::closed ? floating_closed_ : floating_open_;
  }
  int slot(int row, int col) const;  // in pattern_
  /// Slots of the diagonal and of all terms in pattern_.
  void find_slots();

  std::string name_;
  std::shared_ptr<const std::vector<std::string>> node_names_;  // the model's, as the element_instances
  std::vector<NodeKind> node_kinds_;
  std::shared_ptr<const std::vector<ElementInstance>> element_instances_;
  std::vector<NodeMap> node_map_;
  RowMatrix rows_;
  int loaded_rows_ = 0;
  std::vector<int> unknown_node_, prescribed_node_;
  std::vector<double> ratio_;
  std::vector<int> floating_closed_, floating_open_;  // a node of each floating part
  std::optional<Motion> reference_;
  std::vector<Motion> prescribed_;
  std::shared_ptr<const SparseMatrix> pattern_;  // a SparseMatrix cannot be moved
  Vector mass_, damping_, stiffness_, nominal_inertia_, nominal_drag_, node_drag_, initial_z_, initial_v_,
      nominal_direction_;
  MatrixSet zu_, uu_;
  std::optional<MatrixSet> node_matrices_;
  std::vector<ScalarTerm> scalars_;
  std::vector<LoadTerm> loads_;
  TableLoads table_loads_;
  KnottedLoads knotted_loads_;
  std::vector<int> moving_loads_, known_loads_;
  std::vector<VaryingInertiaRow> varying_inertias_;
  std::vector<FrequencyTerm> frequency_terms_;
  std::vector<GeneralTerm> generals_;
  std::vector<FrictionTerm> frictions_;
  std::vector<IdealRatio> ideal_ratios_;
  std::vector<double> breakpoints_;
  std::vector<int> diagonal_slots_;
  int history_size_ = 0;
  bool mass_is_diagonal_ = false, damping_is_diagonal_ = false;
  bool any_prescribed_moves_ = false, loads_depend_on_motion_ = false, symmetric_tangent_ = true;
};

}  // namespace drev
