#include <drev/core/error.hpp>
#include <drev/models/gears/gear_drawing.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "models/gears/gear_element.hpp"

namespace drev {
namespace {

/// What can be said of the drawing without its gears.
void check_rest(const GearDrawing& drawing, ParameterCheck check) {
  if (std::isnan(drawing.cycle.load) == std::isnan(drawing.torque_1))
    check.fail("load", std::isnan(drawing.torque_1) ? "" : to_text(drawing.cycle.load), "N/m",
               "or torque_1 must be given, one of them: the contacts depend on it");
  else if (std::isnan(drawing.cycle.load))
    check.positive("torque_1", drawing.torque_1, "N m");
  else
    check.positive("load", drawing.cycle.load, "N/m");
  check.within("backlash_percentile", drawing.backlash_percentile, 0.0, 1.0, "");
  if (drawing.tangent && !drawing.loads.empty())
    check.fail("tangent", "true", "",
               "must not be given together with loads, whose law has its slope at each load");
}

/// The pair and the options of its cycle, under the load that a torque may give. Throws ModelError with all that is wrong
/// with both.
std::pair<GearPair, MeshCycleOptions> under_load(const GearDrawing& drawing, const std::string& place) {
  std::vector<Finding> findings;
  const ParameterCheck check(place, findings);
  std::optional<GearPair> pair;
  try {
    pair.emplace(drawing.geometry, place);
    // A width that is wrong has been refused with its gear.
    ParameterCheck(check).positive("width", pair->face_width(), "m");
  } catch (const ModelError& error) {
    findings.insert(findings.end(), error.findings().begin(), error.findings().end());
  }
  check_rest(drawing, check);
  if (!findings.empty()) throw ModelError(std::move(findings));
  MeshCycleOptions options = drawing.cycle;
  if (std::isnan(options.load))
    options.load = drawing.torque_1 / (pair->contour(0).base_radius() * pair->face_width());
  return {std::move(*pair), options};
}

constexpr double kCurveError = 1e-3;  // of a curve's largest value: below what its finite elements leave open

struct Curve {
  std::vector<double> phases, values;
};

/// The periodic curve by the fewest of its points, going on from each as far as straight lines leave all points
/// between within kCurveError: each point kept is a knot of every run.
Curve thinned(const Curve& curve) {
  const std::size_t n = curve.values.size();
  double largest = 0.0;
  for (const double v : curve.values) largest = std::max(largest, std::abs(v));
  const auto phase = [&](std::size_t i) { return curve.phases[i % n] + static_cast<double>(i / n); };
  const auto straight = [&](std::size_t from, std::size_t to) {
    const double slope = (curve.values[to % n] - curve.values[from % n]) / (phase(to) - phase(from));
    for (std::size_t i = from + 1; i < to; ++i)
      if (std::abs(curve.values[from % n] + slope * (phase(i) - phase(from)) - curve.values[i % n]) >
          kCurveError * largest)
        return false;
    return true;
  };
  // From the sharpest bend on, which no line passes.
  std::size_t start = 0;
  double sharpest = -1.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double bend =
        std::abs(curve.values[(i + 1) % n] - 2.0 * curve.values[i] + curve.values[(i + n - 1) % n]);
    if (bend > sharpest) sharpest = bend, start = i;
  }
  std::vector<std::size_t> kept;
  for (std::size_t from = start; from < start + n;) {
    kept.push_back(from % n);
    std::size_t to = from + 1;
    while (to < start + n && straight(from, to + 1)) ++to;
    from = to;
  }
  std::sort(kept.begin(), kept.end());
  Curve result;
  for (const std::size_t i : kept) {
    result.phases.push_back(curve.phases[i]);
    result.values.push_back(curve.values[i]);
  }
  return result;
}

}  // namespace

GearMeshData gear_mesh_data(const GearDrawing& drawing, const std::string& place) {
  const auto [pair, options] = under_load(drawing, place);
  Backlash backlash(pair, drawing.tolerances);
  MeshCycle cycle(pair, options);
  std::optional<GearLoadLaw> law;
  if (!drawing.loads.empty()) law = gear_load_law(cycle, drawing.loads);
  return {pair, std::move(cycle), backlash, std::move(law)};
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
  rest.internal = data.pair.geometry().internal;
  double MeshPoint::*const value = drawing.tangent ? &MeshPoint::tangent : &MeshPoint::secant;
  Curve stiffness, error;
  bool uneven = false;
  for (const MeshPoint& p : data.cycle.points()) {
    stiffness.phases.push_back(p.phase);
    stiffness.values.push_back(p.*value * data.pair.face_width());
    error.values.push_back(p.unloaded_error);
    uneven = uneven || p.unloaded_error != 0.0;
  }
  error.phases = stiffness.phases;
  if (data.load_law) {
    for (std::size_t i = 0; i < data.load_law->phases.size(); ++i)
      stiffness.values[i] = data.load_law->stiffness[i] * data.pair.face_width();
    rest.stiffening = {data.load_law->penetrations, data.load_law->slopes};
  }
  stiffness = thinned(stiffness);
  rest.stiffness = MeshStiffness::table(std::move(stiffness.phases), std::move(stiffness.values));
  if (uneven) {
    error = thinned(error);
    rest.transmission_error = TransmissionError::table(std::move(error.phases), std::move(error.values));
  }
  rest.normal_backlash = data.backlash.percentile(drawing.backlash_percentile);
  return rest;
}

}  // namespace drev
