#pragma once
/// Turns a Model into a System, step by step; collects findings and throws them together.
/// Internal to core: users call Model::build().
#include <unordered_map>

#include "core/system.hpp"

namespace drev {

class SystemBuilder {
 public:
  explicit SystemBuilder(const Model& model) : model_(model) {}
  System build();

 private:
  // Names, known motions, elements: what can be found wrong with each by itself.
  void check_names();
  int resolve(const NodeRef& ref, const std::string& place, const std::string& parameter);
  void resolve_motions();
  void check_motion(const Motion& motion, const std::string& place, const std::string& parameter);
  void describe_elements();
  std::vector<int> resolve_nodes(const Placement& p, bool& usable);
  bool check_terms(const Terms& terms, const std::vector<int>& nodes, const std::string& place);
  bool check_kinds(const Placement& p, const std::vector<int>& nodes);
  // Nominal motion, elimination, and what must hold of the whole. These pass over faulty elements, so
  // that all findings come at once.
  void collect_closures();
  void find_nominal_motion();
  void eliminate();
  void check_inertias();
  void set_initial();
  // Matrices and terms over unknowns, of a model without findings.
  void map_terms();
  void add_load(const LoadTerm& term);
  void assemble_matrices();
  void check_values();
  void finish();
  void throw_if_findings() const;

  std::string place(const std::string& part) const { return model_.name() + "/" + part; }

  struct Described {
    std::vector<int> nodes;
    Terms terms;
  };

  const Model& model_;
  System system_;
  std::vector<Finding> findings_;
  std::unordered_map<std::string, int> node_by_name_;
  std::vector<std::optional<Described>> described_;
  std::vector<std::vector<int>> element_nodes_;
  std::vector<int> resolved_prescriptions_;  // -1: unknown or already prescribed
  bool inertia_in_doubt_ = false;  // a fault hides which node some inertia or tie belongs to
  int reference_node_ = -1;
  double rayleigh_a_ = 0.0, rayleigh_b_ = 0.0;
};

}  // namespace drev
