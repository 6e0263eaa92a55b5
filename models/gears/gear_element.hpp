#pragma once
/// The element GearMesh that follows from a pair's drawing: what `geometry` of a model file does. Internal.
///
///   m.add<GearMesh>("mesh", {"pinion", "wheel"}, gear_mesh_params(drawing, {.damping = 500}));
///
/// r_b by the geometry; k(s) and e(s) by MeshCycle under the mean load, times the common width, as tables over the mesh
/// phase; the gap a percentile of the backlash. The mesh phase 0 of the element is where a pair enters at the point A.
#include <drev/elements/gear_mesh.hpp>

namespace drev {

struct GearDrawing;
struct GearMeshData;

/// `rest`: what the drawing does not say (damping, mesh_phase). Throws ModelError as gear_mesh_data() (gear_drawing.hpp)
/// does, and with pitch_deviations, which are longer than the one mesh period that the element repeats.
GearMesh::Params gear_mesh_params(const GearDrawing& drawing, GearMesh::Params rest = {});
GearMesh::Params gear_mesh_params(const GearDrawing& drawing, const GearMeshData& data,
                                  GearMesh::Params rest = {});

}  // namespace drev
