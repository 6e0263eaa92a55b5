#pragma once
/// The camshaft's gear drive, undamped, with the laws that a mesh may have in place of its own.
#include <drev/core/system.hpp>
#include <drev/elements/gear_mesh.hpp>
#include <drev/models/ready_made.hpp>

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace drev::test {

struct MeshLaw {
  const char* name;
  void (*change)(GearMesh::Params&);
};

inline const std::vector<MeshLaw>& mesh_laws() {
  static const std::vector<MeshLaw> laws{
      {"constant stiffness, no damping", [](GearMesh::Params&) {}},
      {"stiffness in steps",
       [](GearMesh::Params& p) {
         p.stiffness = MeshStiffness::step(0.85 * p.stiffness.mean(), 1.15 * p.stiffness.mean(), 1.5);
       }},
      {"stiffness as Fourier series, 5 orders",
       [](GearMesh::Params& p) {
         p.stiffness =
             MeshStiffness::fourier_of_step(0.85 * p.stiffness.mean(), 1.15 * p.stiffness.mean(), 1.5, 5);
       }},
      {"stiffness as table of 8 points",
       [](GearMesh::Params& p) {
         const double k = p.stiffness.mean();
         p.stiffness = MeshStiffness::table(
             {0.0, 0.1, 0.25, 0.45, 0.5, 0.6, 0.75, 0.95},
             {1.1 * k, 1.14 * k, 1.16 * k, 1.12 * k, 0.9 * k, 0.86 * k, 0.84 * k, 0.88 * k});
       }},
      {"proportional damping", [](GearMesh::Params& p) { p.damping = 2e4; }},
      {"limited damping",
       [](GearMesh::Params& p) {
         p.damping = 2e4;
         p.damping_law = MeshDamping::limited;
       }},
      {"proportional damping, stiffness in steps", [](GearMesh::Params& p) {
         p.damping = 2e4;
         p.stiffness = MeshStiffness::step(0.85 * p.stiffness.mean(), 1.15 * p.stiffness.mean(), 1.5);
       }}};
  return laws;
}

/// The first of them whose name holds a word.
inline const MeshLaw& mesh_law(const std::string& word) {
  for (const MeshLaw& law : mesh_laws())
    if (std::string(law.name).find(word) != std::string::npos) return law;
  throw std::invalid_argument("no mesh law of the tests is named " + word);
}

struct GearDrive {
  System system;
  std::vector<std::string> torques;  ///< channels of the shafts
};

inline GearDrive gear_drive_with(const MeshLaw& law) {
  Parameters parameters("camshaft", camshaft_entry().parameters);
  parameters.set("damping", "undamped");
  const ModelCase model_case = camshaft_entry().build(parameters);
  Model m("camshaft");
  for (const std::string& node : model_case.model.node_names()) m.add_node(node);
  for (const ElementInstance& p : model_case.model.element_instances()) {
    const auto* mesh = dynamic_cast<const GearMesh*>(p.element.get());
    if (mesh == nullptr) {
      m.add(p.name, p.nodes, p.element);
      continue;
    }
    GearMesh::Params params = mesh->params();
    if (params.teeth_1 == 0) params.teeth_1 = 60, params.teeth_2 = 0;
    params.damping = 0.0;
    law.change(params);
    m.add(p.name, p.nodes, std::make_shared<GearMesh>(params));
  }
  for (const Model::Prescription& p : model_case.model.prescriptions()) m.constant_speed(p.node, *p.omega);
  return {m.build(), model_case.torques};
}

}  // namespace drev::test
