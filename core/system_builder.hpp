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
  // Names, element parameters, node references.
  void check_names();
  int resolve(const NodeRef& ref, const std::string& place, const std::string& parameter);
  void describe_elements();
  // Nominal motion and elimination.
  void find_reference();
  void eliminate();
  // Matrices and terms over unknowns.
  void map_terms();
  void assemble_matrices();
  void check_inertias();
  void set_initial();
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
  std::vector<int> resolved_prescriptions_;
  int reference_node_ = -1;
  double rayleigh_a_ = 0.0, rayleigh_b_ = 0.0;
};

}  // namespace drev
