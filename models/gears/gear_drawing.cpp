#include <drev/core/error.hpp>
#include <drev/models/gears/gear_drawing.hpp>

#include <cmath>
#include <vector>

#include "models/gears/gear_element.hpp"

namespace drev {
namespace {

MeshCycleOptions under_load(const GearDrawing& drawing, const GearPair& pair, const std::string& place) {
  MeshCycleOptions options = drawing.cycle;
  std::vector<Finding> findings;
  ParameterCheck check(place, findings);
  check.positive("width", pair.face_width(), "m");
  if (std::isnan(options.load) == std::isnan(drawing.torque_1))
    check.fail("load", to_text(options.load), "N/m",
               "or torque_1 must be given, one of them: the contacts depend on it");
  else if (std::isnan(options.load)) {
    check.positive("torque_1", drawing.torque_1, "N m");
    options.load = drawing.torque_1 / (pair.contour(0).base_radius() * pair.face_width());
  }
  check.within("backlash_percentile", drawing.backlash_percentile, 0.0, 1.0, "");
  if (!findings.empty()) throw ModelError(std::move(findings));
  return options;
}

}  // namespace

GearMeshData gear_mesh_data(const GearDrawing& drawing, const std::string& place) {
  const GearPair pair(drawing.geometry, place);
  const MeshCycleOptions options = under_load(drawing, pair, place);
  Backlash backlash(pair, drawing.tolerances);
  return {pair, MeshCycle(pair, options), backlash};
}

GearMesh::Params gear_mesh_params(const GearDrawing& drawing, GearMesh::Params rest) {
  return gear_mesh_params(drawing, gear_mesh_data(drawing), std::move(rest));
}

GearMesh::Params gear_mesh_params(const GearDrawing& drawing, const GearMeshData& data,
                                  GearMesh::Params rest) {
  if (!drawing.cycle.pitch_deviations.empty())
    throw ModelError({{"gear pair", "pitch_deviations", std::to_string(drawing.cycle.pitch_deviations.size()),
                       "", "of several mesh periods cannot be repeated each mesh period"}});
  rest.base_radius_1 = data.pair.contour(0).base_radius();
  rest.base_radius_2 = data.pair.contour(1).base_radius();
  rest.teeth_1 = data.pair.gear(0).teeth;
  rest.teeth_2 = data.pair.gear(1).teeth;
  double MeshPoint::*const value = drawing.tangent ? &MeshPoint::tangent : &MeshPoint::secant;
  std::vector<double> phases, stiffnesses, errors;
  bool uneven = false;
  for (const MeshPoint& p : data.cycle.points()) {
    phases.push_back(p.phase);
    stiffnesses.push_back(p.*value * data.pair.face_width());
    errors.push_back(p.unloaded_error);
    uneven = uneven || p.unloaded_error != 0.0;
  }
  rest.stiffness = MeshStiffness::table(phases, std::move(stiffnesses));
  if (uneven) rest.transmission_error = TransmissionError::table(std::move(phases), std::move(errors));
  rest.normal_backlash = data.backlash.percentile(drawing.backlash_percentile);
  return rest;
}

}  // namespace drev
