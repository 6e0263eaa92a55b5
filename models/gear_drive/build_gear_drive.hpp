#pragma once
/// The two-stage gear drive of the source's engine (S. L. Sunde, NTNU, 2015, section 4.2, Table 4.1):
///
///   crank_gear (z 59, m 8) -- mesh_1 -- idler (z 68 and, on the same node, z 34, m 9) -- mesh_2 -- gear
///
/// Both idlers share a node. Ratio 59/68 * 34/59 = 1/2: the camshaft turns at half the engine's speed, in
/// the same sense. Stiffnesses are those of the source's finite-element study, taken along the line of
/// action; the idler's 68 teeth correct a misprint (64). Inertias of crank gear and idler are typical
/// values, not the builder's.
#include <drev/models/model_case.hpp>

namespace drev {

struct GearDrawing;

/// Variation of the mesh stiffness; drawing: the curve that follows from the gears' geometry (add_gear_drive), drawing_mean:
/// its mean over the mesh period.
enum class MeshVariation { mean, step, fourier, drawing, drawing_mean };

struct GearDriveParams {
  double normal_backlash = 0.15e-3;  ///< m, total, in each mesh
  MeshVariation variation = MeshVariation::mean;
  double stiffness_factor = 1.0;  ///< stiffness of both meshes over the source's
  double mesh_damping = 0.0;      ///< N s/m, in each mesh
};

/// Drawing of mesh 1 or 2, bores as a part of the root circles. Modules, teeth, shifts and centre distances of the source (497 and
/// 417 mm), tips that clear the fillets, mean forces of 44.5 and 30.8 N/mm over widths of 88 and 130 mm; tips and bores are
/// assumed, as in models/camshaft_gears. The stiffness of the drive follows from it where that is asked for.
GearDrawing gear_drive_drawing(int mesh, double bore = 0.3);

/// Adds crank_gear, idler, mesh_1 and mesh_2 to a model that has the node `camshaft_gear`, whose inertia
/// is the caller's. Nothing is prescribed.
void add_gear_drive(Model& model, const std::string& camshaft_gear, const GearDriveParams& params);

/// The parameters of the drive, shared by the models that have one.
std::vector<Parameter> gear_drive_settings();
GearDriveParams gear_drive_params(const Parameters& parameters);

/// The drive alone: crank gear at constant speed, camshaft gear with its inertia and a torque on it.
ModelCase build_gear_drive(Parameters parameters);
const ModelEntry& gear_drive_entry();

}  // namespace drev
