#pragma once
/// Turns a Model into a System, step by step; collects findings and throws them together.
/// Internal to core: users call Model::build().
#include <drev/core/element.hpp>
#include <drev/core/system.hpp>

#include "core/kinematics.hpp"
#include "core/name_index.hpp"
#include "core/node_matrix.hpp"

namespace drev {

class SystemBuilder {
 public:
  explicit SystemBuilder(const Model& model) : model_(model) {}
  System build();
  /// solvers/at_speed.hpp
  static System at_speed(const System& system, double speed, const Vector& forces);

 private:
  // Names, known motions, elements: what can be found wrong with each by itself.
  void check_names();
  int find(const NodeRef& ref) const;  // -1: no node of this model
  int resolve(const NodeRef& ref, const std::string& place, const std::string& parameter);
  void resolve_motions();
  void check_motion(const Motion& motion, const std::string& place, const std::string& parameter);
  void describe_elements();
  std::vector<int> resolve_nodes(const ElementInstance& p, bool& usable);
  bool check_terms(const Terms& terms, const std::vector<int>& nodes, const ElementInstance& p);
  bool check_kinds(const ElementInstance& p, const std::vector<int>& nodes);
  // Nominal motion, elimination, and what must hold of the whole. These pass over faulty elements, so
  // that all findings come at once.
  void find_nominal_motion();
  std::vector<int> floating_parts(const std::vector<double>& relative, Contact contact) const;
  void eliminate();
  /// Numbers the unknowns along the lines of the train, where fewer couplings are then of unknowns that are not next to each other:
  /// series and sweeps take those next to each other with the least work (solvers/series).
  void order_unknowns();
  void check_inertias();
  void set_initial();
  /// Internal nodes whose start nobody states: where, beside the nodes that are stated, no force acts on them, K_ii q_i = -K_ik q_k, and
  /// as fast, K_ii q_i' = -K_ik q_k'. Left at rest, a shaft turned as a whole would start twisted by its turn.
  /// set_by: by unknown, the node that states its start; -1: none.
  void start_internal_nodes(const std::vector<int>& set_by);
  // Matrices and terms over unknowns, of a model without findings.
  void map_terms();
  void assemble_matrices();
  void check_values();
  void find_varying_inertias();
  void finish();
  /// Without the unknowns that wide constraints make dependent.
  System constrained();
  void throw_if_findings() const;

  std::string place(const std::string& part) const { return model_.name() + "/" + part; }

  void keep(int element, const std::vector<int>& nodes, const Terms& terms);
  static void keep_entries(const std::vector<int>& nodes, const Eigen::MatrixXd& matrix, NodeMatrix& sum);
  const std::string& node_name(int node) const { return model_.node_names()[idx(node)]; }
  /// Calls visit(i, j) for every two unknowns that something couples; more than once for some.
  template <class Visit>
  void for_each_coupling(const Visit& visit) const;
  /// The same by unknown: those coupled to k at others[begin[k]] to others[begin[k + 1] - 1], with itself, in rising order.
  struct Couplings {
    std::vector<int> begin, others;
  };
  Couplings couplings() const;
  std::shared_ptr<const SparseMatrix> pattern() const;
  /// Calls visit(i, j, value) for every entry of M, C, K (0, 1, 2), Rayleigh damping included.
  template <class Visit>
  void for_each_entry(int matrix, const Visit& visit) const;
  Vector values_on_pattern(int matrix) const;

  const Model& model_;
  System system_;
  std::vector<Finding> findings_;
  NameIndex node_by_name_{0, {}};
  NodeMatrix mass_[2], damping_, deviation_damping_,
      stiffness_[2];  // the second ones take part in C = a M + b K
  std::vector<RatioRow> ratio_rows_;
  std::vector<WideRatioRow> wide_ratio_rows_;
  std::vector<int> component_;  // Kinematics::component
  struct WideConstraint {
    ElementId element;
    std::vector<Entry> nodes;
  };
  std::vector<WideConstraint> wide_constraints_;  // rows over three nodes or more
  std::vector<int> faulty_nodes_;                 // of elements whose terms are not known
  std::vector<int> resolved_prescriptions_;       // -1: unknown or already prescribed
  bool inertia_in_doubt_ = false;                 // a fault hides which node some inertia or tie belongs to
  int reference_node_ = -1;
  double rayleigh_a_ = 0.0, rayleigh_b_ = 0.0;
};

}  // namespace drev
