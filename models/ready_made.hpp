#pragma once
/// The ready-made models, built in C++, and the parts of them that a model of one's own may take. By their names:
/// find_model() and build_case() (model_case.hpp).
#include <drev/models/model_case.hpp>

#include <string>
#include <vector>

namespace drev {

struct GearDrawing;

/// The source's benchmark against FEDEM (S. L. Sunde, NTNU, 2015, section 4.4.1, figure 4.7):
///
///   ground --(k_1, half gap b_1)-- mass_1 --(k_2, half gap b_2)-- mass_2 <- F(t)
///
/// no damping, at rest in mid gap at t = 0. F rises linearly to its full value at 1 s, holds to 2 s and is
/// released at once. The size of F is not printed in the source; 100 N is drev's choice.
/// The published cases: zero backlash k 2000, 2000; A2 with half gaps 0.05, 0.05; B (the default) with k
/// 2000, 1000 and half gaps 0.05, 0.03.
ModelCase build_two_mass_backlash(Parameters parameters);
const ModelEntry& two_mass_backlash_entry();

/// Variation of the mesh stiffness; drawing: the curve that follows from the gears' geometry (add_gear_drive), drawing_mean:
/// its mean over the mesh period.
enum class MeshVariation { mean, step, fourier, drawing, drawing_mean };

struct GearDriveParams {
  double normal_backlash = 0.15e-3;  ///< m, total, in each mesh
  MeshVariation variation = MeshVariation::mean;
  double stiffness_factor = 1.0;  ///< stiffness of both meshes over the source's
  double mesh_damping = 0.0;      ///< N s/m, in each mesh
};

/// The two-stage gear drive of the source's engine (S. L. Sunde, NTNU, 2015, section 4.2, Table 4.1):
///
///   crank_gear (z 59, m 8) -- mesh_1 -- idler (z 68 and, on the same node, z 34, m 9) -- mesh_2 -- gear
///
/// Both idlers share a node. Ratio 59/68 * 34/59 = 1/2: the camshaft turns at half the engine's speed, in
/// the same sense. Stiffnesses are those of the source's finite-element study, taken along the line of
/// action; the idler's 68 teeth correct a misprint (64). Inertias of crank gear and idler are typical
/// values, not the builder's.
///
/// Adds crank_gear, idler, mesh_1 and mesh_2 to a model that has the node `camshaft_gear`, whose inertia
/// is the caller's. Nothing is prescribed.
void add_gear_drive(Model& model, const std::string& camshaft_gear, const GearDriveParams& params);

/// The parameters of the drive, shared by the models that have one.
std::vector<Parameter> gear_drive_parameters();
GearDriveParams gear_drive_params(const Parameters& parameters);

/// The drive alone: crank gear at constant speed, camshaft gear with its inertia and a torque on it.
ModelCase build_gear_drive(Parameters parameters);
const ModelEntry& gear_drive_entry();

/// Drawing of mesh 1 or 2, bores as a part of the root circles. Modules, teeth, shifts and centre distances of the source (497 and
/// 417 mm), tips that clear the fillets, mean forces of 44.5 and 30.8 N/mm over widths of 88 and 130 mm; tips and bores are
/// assumed, as in models/camshaft_gears. The stiffness of the drive follows from it where that is asked for.
GearDrawing gear_drive_drawing(int mesh, double bore = 0.3);

struct CamshaftParams {
  int cylinders = 9;                   ///< 6 to 10
  std::vector<int> firing_order = {};  ///< empty: the default one
  bool twist_feedback = true;          ///< false: the source's loads, at the nominal angle
  double rayleigh_a = 0.0;             ///< 1/s
  double rayleigh_b = 0.0;             ///< s
};

/// The camshaft of a four-stroke marine diesel, 6 to 10 cylinders (S. L. Sunde, NTNU, 2015, figure 3.1), on
/// reconstructed data (camshaft_data.hpp):
///
///   gear - journal_1 - fuel_1 - exhaust_1 - inlet_1 - journal_2 - ... - inlet_N - end
///
/// Cylinder k's cams run at -360 j/N degrees, j its place in the firing order counted from 0.
///
/// Adds the shaft from node "gear" to node "end" with its loads; nothing is prescribed.
void add_camshaft(Model& model, const CamshaftParams& params);

/// Drive: gears (the two-stage gear drive, crank gear at constant speed), held (the camshaft's gear at constant
/// speed), or free (nothing held: for free-free modes).
ModelCase build_camshaft(Parameters parameters);
const ModelEntry& camshaft_entry();

}  // namespace drev
