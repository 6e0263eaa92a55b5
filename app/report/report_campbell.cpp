#include "app/report/report_campbell.hpp"

#include <drev/elements/gear_mesh.hpp>

#include <cmath>
#include <map>

#include "app/run/excitation.hpp"

namespace drev::app {

namespace {

constexpr std::size_t kCrossings = 400;
constexpr double kFarthest = 4.0;  // largest speed of crossings relative to the fastest of the run [-]

/// One node for each distinct speed.
Json shafts_object(const System& system, const std::string& reference) {
  const auto key_of = [](double ratio) { return std::lround(ratio * 1e6); };
  std::map<long, std::string> shafts;
  shafts[key_of(1.0)] = reference;
  for (int i = 0; i < system.node_count(); ++i)
    if (const double ratio = std::abs(system.ratio(i)); ratio > 0.0)
      shafts.try_emplace(key_of(ratio), system.node_names()[static_cast<std::size_t>(i)]);
  Json list = Json::array({{{"name", reference}, {"ratio", 1.0}}});
  for (const auto& [key, name] : shafts)
    if (name != reference)
      list.push_back({{"name", name}, {"ratio", std::abs(system.ratio(system.node(name)))}});
  return list;
}

}  // namespace

std::string reference_name(const Model& model) {
  const std::string node = reference_node(model);
  return node.empty() ? "reference shaft" : node;
}

Json campbell_object(const Model& model, const System& system, const ModeSet& modes, double duration) {
  const SpeedRange range = speed_range(system, duration);
  if (!(range.fastest > 0.0)) return nullptr;
  Excitation excitation = find_excitation(system, modes, range);
  std::vector<Crossing>& all = excitation.crossings;
  const std::vector<double> shown = chief_orders(all, range);
  std::erase_if(all, [&](const Crossing& c) { return c.speed > kFarthest * range.fastest; });

  Json list = Json::array();
  for (const double order : shown) list.push_back({{"order", order}, {"of", "loads"}});
  for (const ElementInstance& placement : system.element_instances()) {
    const auto* mesh = dynamic_cast<const GearMesh*>(placement.element.get());
    if (const auto* lateral = dynamic_cast<const LateralGearMesh*>(placement.element.get()))
      mesh = &lateral->mesh();
    if (mesh != nullptr && mesh->params().teeth_1 > 0) {
      const int gear = system.node_of(placement.nodes.front());
      list.push_back(
          {{"order", mesh->params().teeth_1 * std::abs(system.ratio(gear))}, {"of", placement.name}});
    }
  }
  if (all.size() > kCrossings) all.resize(kCrossings);
  Json crossings = Json::array();
  for (const Crossing& c : all)
    crossings.push_back(
        {{"mode", c.mode}, {"order", c.order}, {"speed", c.speed}, {"static", number(c.answer)}});
  const std::string name = reference_name(model);
  return {{"shaft", name},
          {"speed", {range.slowest, range.fastest}},
          {"orders", std::move(list)},
          {"crossings", std::move(crossings)},
          {"unknown", excitation.unknown},
          {"shafts", shafts_object(system, name)}};
}

}  // namespace drev::app
