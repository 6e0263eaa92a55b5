#pragma once
/// Simpler models made from a model: one thing left out at a time, the rest as it was. Each returns nothing
/// where the model has nothing of the kind. Initial conditions go along: parts that a simplification ties
/// again start turned as rigid bodies, so that every shaft starts with its twist. What cannot be built then (a
/// load on a node that is gone) says so in Model::build().
#include <drev/core/system.hpp>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace drev {

/// Flank that each law with a gap is closed on, by element: 1 front, -1 back, 0 or absent: mid gap.
using Flanks = std::map<std::string, int>;

/// The flanks that the system starts on.
Flanks flanks_at_start(const System& system);

/// Gear meshes without their gap: y = k (x - flank b) + c x', both ways; b: half the gap. Polyline springs
/// with a gap and stiffness on both sides of it: both parts moved together.
std::optional<Model> without_backlash(const Model& model, const Flanks& flanks = {});

/// Gear meshes at the mean of their stiffness over the mesh phase.
std::optional<Model> with_mean_stiffness(const Model& model);

/// Gear meshes as ideal gears: no compliance, backlash, damping or transmission error.
std::optional<Model> with_rigid_meshes(const Model& model);

/// Nodes that channels speak of: of the node or nodes named, or of the element's.
std::vector<std::string> nodes_of(const Model& model, const std::vector<std::string>& channels);

/// Cut at the gear mesh nearest to the nodes given that parts them from what is driven: the gear on their
/// side is held at its nominal motion, and what lies beyond is left out.
std::optional<Model> with_drive_held(const Model& model, const std::vector<std::string>& nodes);

/// A model in which channels have other names: of the full model, of this one.
struct RenamedModel {
  Model model;
  std::map<std::string, std::string> renamed;
};

/// Distributed shafts with fewer segments, `finest` in the shaft that has most and in proportion in the
/// others, rounded up. Torques of segments are those of the segment at the same place; internal nodes are
/// others.
std::optional<RenamedModel> with_coarser_shafts(const Model& model, int finest);
/// Distributed shafts as massless springs with half of their inertia at each end.
std::optional<RenamedModel> with_lumped_shafts(const Model& model);
/// Segments of the finest distributed shaft with inertia; 0: none.
int finest_shaft(const Model& model);

}  // namespace drev
