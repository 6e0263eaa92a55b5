#include "advice/simplify.hpp"

#include <drev/core/assembler.hpp>
#include <drev/core/system.hpp>
#include <drev/elements/catalogue.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "advice/closed_flank.hpp"
#include "core/kinematics.hpp"

namespace drev {

namespace {

using ElementPtr = std::shared_ptr<const Element>;

std::vector<std::string> names_of(const Model& model, const ElementInstance& p) {
  std::vector<std::string> names;
  for (const NodeRef& ref : p.nodes) names.push_back(model.name_of(ref));
  return names;
}

/// Adds elements that stand for one of the model's.
using Place = std::function<void(Model& to, const ElementInstance&, const std::vector<NodeRef>& nodes)>;

void place_same(Model& to, const ElementInstance& p, const std::vector<NodeRef>& nodes) {
  to.add(p.name, nodes, p.element);
}

/// The model with each element placed again, and without the nodes `gone` and what touches them.
Model copy(const Model& model, const Place& place, const std::set<std::string>& gone = {}) {
  Model to(model.name());
  std::set<std::string> internal;
  for (const ElementInstance& p : model.element_instances())
    for (const NodeId id : p.internal) internal.insert(model.node_names().at(idx(index(id))));
  const auto& names = model.node_names();
  for (std::size_t i = 0; i < names.size(); ++i)
    if (!internal.contains(names[i]) && !gone.contains(names[i]))
      to.add_node(names[i], model.node_kinds()[i]);
  const auto is_gone = [&](const std::string& name) { return gone.contains(name); };
  for (const ElementInstance& p : model.element_instances()) {
    const std::vector<std::string> nodes = names_of(model, p);
    if (std::none_of(nodes.begin(), nodes.end(), is_gone)) place(to, p, {nodes.begin(), nodes.end()});
  }
  for (const Model::Prescription& p : model.prescriptions()) {
    const std::string node = model.name_of(p.node);
    if (is_gone(node)) continue;
    if (p.omega)
      to.constant_speed(node, *p.omega);
    else if (p.deviation)
      to.given_motion(node, *p.deviation);
    else
      to.hold(node);
  }
  for (const auto& [node, motion] : model.references())
    if (!is_gone(model.name_of(node))) to.set_reference(model.name_of(node), motion);
  return to;
}

/// Deviation and rate of each node at the start; empty where the model sets none.
struct NodeStart {
  double q = 0.0, v = 0.0;
};
using Starts = std::map<std::string, NodeStart>;

Starts starts_of(const Model& model) {
  if (model.initials().empty()) return {};
  const System system = model.build();
  const State state = State::initial(system);
  Assembler assembler(system);
  assembler.set_time(state.t);
  Starts starts;
  for (int i = 0; i < system.node_count(); ++i) {
    const MotionPoint p = assembler.node_motion(i, state);
    starts[system.node_names()[idx(i)]] = {p.value, p.rate};
  }
  return starts;
}

/// Sets them once for each unknown of the model.
void set_starts(Model& to, const Starts& starts) {
  if (starts.empty()) return;
  const System system = to.build();
  std::vector<bool> set(idx(system.size()), false);
  for (int i = 0; i < system.node_count(); ++i) {
    const int unknown = system.node_map(i).unknown;
    const auto start = starts.find(system.node_names()[idx(i)]);
    if (unknown < 0 || start == starts.end() || set[idx(unknown)]) continue;
    set[idx(unknown)] = true;
    to.set_initial(start->first, start->second.q, start->second.v);
  }
}

/// Parts of the model that the elements with `ties` hold together, per node.
std::vector<int> parts_of(const Model& model, const System& system,
                          const std::function<bool(const ElementInstance&)>& ties) {
  std::vector<RatioRow> speed_ratio_constraints;
  for (const ElementInstance& p : model.element_instances()) {
    if (!ties(p)) continue;
    std::vector<int> nodes;
    for (const NodeRef& ref : p.nodes) nodes.push_back(system.node_of(ref));
    for (const NodeId id : p.internal) nodes.push_back(index(id));
    for (std::size_t k = 1; k < nodes.size(); ++k)
      speed_ratio_constraints.push_back({.first = nodes[0], .second = nodes[k]});
  }
  return connected_components(system.node_count(), speed_ratio_constraints, true);
}

double turning(const System& system, int node) {
  const double n = system.ratio(node);
  return n == 0.0 ? 1.0 : n;
}

/// Turns a part as a rigid body, so that `node` starts at q, v.
void turn_part(const System& system, const std::vector<int>& part, int node, NodeStart to, Starts& starts) {
  const NodeStart from = starts.at(system.node_names()[idx(node)]);
  for (int i = 0; i < system.node_count(); ++i) {
    if (part[idx(i)] != part[idx(node)]) continue;
    const double n = turning(system, i) / turning(system, node);
    NodeStart& start = starts.at(system.node_names()[idx(i)]);
    start.q += n * (to.q - from.q), start.v += n * (to.v - from.v);
  }
}

/// The copy in which `change` replaces elements (null: left as they are); nothing if it replaces none.
std::optional<Model> replace(const Model& model,
                             const std::function<ElementPtr(const ElementInstance&)>& change) {
  bool any = false;
  Model to = copy(model, [&](Model& m, const ElementInstance& p, const std::vector<NodeRef>& nodes) {
    const ElementPtr changed = change(p);
    any |= changed != nullptr;
    m.add(p.name, nodes, changed ? changed : p.element);
  });
  if (!any) return {};
  for (const Model::Initial& i : model.initials()) to.set_initial(model.name_of(i.node), i.deviation, i.rate);
  return to;
}

template <class E>
const E* as(const ElementInstance& p) {
  return dynamic_cast<const E*>(p.element.get());
}

/// The points beyond the gap, moved together to its middle or to the flank at `to`.
ElementPtr closed_polyline(const PolylineSpring& spring, int flank) {
  const Gap gap = *spring.gap();
  if (!std::isfinite(gap.low) || !std::isfinite(gap.high)) return nullptr;
  const double to = flank > 0 ? gap.high : flank < 0 ? gap.low : 0.5 * (gap.low + gap.high);
  PolylineSpring::Params closed{.x = {}, .y = {}, .damping = spring.params().damping};
  const auto &x = spring.params().x, &y = spring.params().y;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (x[i] > gap.low && x[i] <= gap.high) continue;  // one point stands for the gap
    closed.x.push_back(x[i] + to - (x[i] > gap.high ? gap.high : gap.low));
    closed.y.push_back(y[i]);
  }
  return std::make_shared<const PolylineSpring>(std::move(closed));
}

/// Nodes whose motion is given.
std::vector<int> driven_nodes(const Model& model, const System& system) {
  std::vector<int> nodes;
  for (const Model::Prescription& p : model.prescriptions()) nodes.push_back(system.node_of(p.node));
  for (const auto& [node, motion] : model.references()) nodes.push_back(system.node_of(node));
  return nodes;
}

bool gapped(const GearMesh& mesh) { return mesh.params().normal_backlash > 0.0; }

}  // namespace

Flanks flanks_at_start(const System& system) {
  Flanks flanks;
  const State state = State::initial(system);
  Assembler assembler(system);
  assembler.set_time(state.t);
  for (const ScalarTerm& term : system.scalars()) {
    const auto gap = term.force->gap();
    if (!gap) continue;
    const double x = assembler.input(term, state.z, state.v).x;
    flanks[system.element_instances()[idx(index(term.element))].name] = x >= gap->high  ? 1
                                                                        : x <= gap->low ? -1
                                                                                        : 0;
  }
  return flanks;
}

std::optional<Model> without_backlash(const Model& model, const Flanks& flanks) {
  return replace(model, [&](const ElementInstance& p) -> ElementPtr {
    const auto found = flanks.find(p.name);
    const int flank = found == flanks.end() ? 0 : found->second;
    if (const auto* mesh = as<GearMesh>(p); mesh != nullptr && gapped(*mesh)) {
      GearMesh::Params params = mesh->params();
      const double offset = 0.5 * flank * params.normal_backlash;
      params.normal_backlash = 0.0;
      auto closed = std::make_shared<const GearMesh>(std::move(params));
      if (flank == 0) return closed;
      return std::make_shared<const ClosedFlank>(std::move(closed), offset);
    }
    if (const auto* spring = as<PolylineSpring>(p); spring != nullptr && spring->gap())
      return closed_polyline(*spring, flank);
    return nullptr;
  });
}

std::optional<Model> with_mean_stiffness(const Model& model) {
  return replace(model, [](const ElementInstance& p) -> ElementPtr {
    const auto* mesh = as<GearMesh>(p);
    if (mesh == nullptr || !mesh->params().stiffness.varies()) return nullptr;
    GearMesh::Params params = mesh->params();
    params.stiffness = params.stiffness.mean();
    return std::make_shared<const GearMesh>(std::move(params));
  });
}

std::optional<Model> with_rigid_meshes(const Model& model) {
  const auto is_mesh = [](const ElementInstance& p) { return as<GearMesh>(p) != nullptr; };
  if (std::none_of(model.element_instances().begin(), model.element_instances().end(), is_mesh)) return {};
  const auto ratio_of = [](const ElementInstance& p) {
    const GearMesh& mesh = *as<GearMesh>(p);
    const double ratio = mesh.base_radius_1() / mesh.base_radius_2();
    return mesh.params().internal ? ratio : -ratio;
  };
  Model to = copy(model, [&](Model& m, const ElementInstance& p, const std::vector<NodeRef>& nodes) {
    if (!is_mesh(p)) return place_same(m, p, nodes);
    m.add(p.name, nodes, std::make_shared<const IdealGear>(IdealGear::Params{.ratio = ratio_of(p)}));
  });
  Starts starts = starts_of(model);
  if (starts.empty()) return to;
  // What the meshes' compliance and gaps had turned, part by part from what is driven.
  const System system = model.build();
  const std::vector<int> part =
      parts_of(model, system, [&](const ElementInstance& p) { return !is_mesh(p); });
  std::set<int> settled;
  for (const int node : driven_nodes(model, system)) settled.insert(part[idx(node)]);
  if (settled.empty()) settled.insert(part.front());
  for (bool going_on = true; going_on;) {
    going_on = false;
    for (const ElementInstance& p : model.element_instances()) {
      if (!is_mesh(p)) continue;
      int a = system.node_of(p.nodes[0]), b = system.node_of(p.nodes[1]);
      double ratio = ratio_of(p);
      if (settled.contains(part[idx(a)]) == settled.contains(part[idx(b)])) continue;
      if (settled.contains(part[idx(b)])) std::swap(a, b), ratio = 1.0 / ratio;
      const NodeStart from = starts.at(system.node_names()[idx(a)]);
      turn_part(system, part, b, {ratio * from.q, ratio * from.v}, starts);
      settled.insert(part[idx(b)]);
      going_on = true;
    }
  }
  set_starts(to, starts);
  return to;
}

std::vector<std::string> nodes_of(const Model& model, const std::vector<std::string>& channels) {
  const std::set<std::string> nodes(model.node_names().begin(), model.node_names().end());
  std::set<std::string> found;
  for (const std::string& channel : channels) {
    const std::string name = channel.substr(0, channel.rfind('.'));
    if (nodes.contains(name)) found.insert(name);
    for (std::size_t cut = name.find('-'); cut != std::string::npos; cut = name.find('-', cut + 1))
      if (nodes.contains(name.substr(0, cut)) && nodes.contains(name.substr(cut + 1)))
        found.insert({name.substr(0, cut), name.substr(cut + 1)});
    for (const ElementInstance& p : model.element_instances())
      if (name == p.name || (p.internal.count > 0 && name.starts_with(p.name + "_")))
        for (const std::string& node : names_of(model, p)) found.insert(node);
  }
  return {found.begin(), found.end()};
}

std::optional<Model> with_drive_held(const Model& model, const std::vector<std::string>& wanted) {
  const System system = model.build();
  const std::vector<int> driven = driven_nodes(model, system);
  if (driven.empty() || wanted.empty()) return {};

  std::set<std::string> best;
  int held = -1;
  for (std::size_t cut = 0; cut < model.element_instances().size(); ++cut) {
    if (as<GearMesh>(model.element_instances()[cut]) == nullptr) continue;
    const std::vector<int> part = parts_of(
        model, system, [&](const ElementInstance& p) { return &p != &model.element_instances()[cut]; });
    const int kept = part[idx(system.node(wanted.front()))];
    const auto inside = [&](int node) { return part[idx(node)] == kept; };
    const bool all_wanted = std::all_of(wanted.begin(), wanted.end(),
                                        [&](const std::string& node) { return inside(system.node(node)); });
    if (!all_wanted || std::any_of(driven.begin(), driven.end(), inside)) continue;
    const std::vector<std::string> ends = names_of(model, model.element_instances()[cut]);
    const int a = system.node(ends[0]), b = system.node(ends[1]);
    if (inside(a) == inside(b)) continue;
    std::set<std::string> gone;
    for (int i = 0; i < system.node_count(); ++i)
      if (!inside(i)) gone.insert(system.node_names()[idx(i)]);
    if (gone.size() <= best.size()) continue;
    best = std::move(gone);
    held = inside(a) ? a : b;
  }
  if (held < 0) return {};

  Model to = copy(model, place_same, best);
  const std::string& node = system.node_names()[idx(held)];
  to.hold(node);
  if (system.reference()) {
    const double ratio = system.ratio(held);
    Motion motion = *system.reference();
    motion.at = [at = motion.at, ratio](double t) {
      const MotionPoint p = at(t);
      return MotionPoint{ratio * p.value, ratio * p.rate, ratio * p.acceleration};
    };
    to.set_reference(node, std::move(motion));
  }
  if (Starts starts = starts_of(model); !starts.empty()) {
    turn_part(system, std::vector<int>(idx(system.node_count()), 0), held, {}, starts);
    set_starts(to, starts);
  }
  return to;
}

namespace {

bool has_inertia(const DistributedShaft& shaft) { return shaft.params().density > 0.0; }

std::string torque_of(const std::string& shaft, int segment) {
  return shaft + "_" + std::to_string(segment) + ".torque_Nm";
}

/// Its node at a position from 0 to `segments`.
std::string node_at(const Model& model, const ElementInstance& p, int position, int segments) {
  if (position == 0) return model.name_of(p.nodes[0]);
  if (position == segments) return model.name_of(p.nodes[1]);
  return p.name + "_" + std::to_string(position);
}

}  // namespace

std::optional<RenamedModel> with_coarser_shafts(const Model& model, int finest) {
  const int most = finest_shaft(model);
  if (finest < 1 || finest >= most) return {};
  const Starts before = starts_of(model);
  Starts starts = before;
  std::map<std::string, std::string> renamed;
  Model to = copy(model, [&](Model& m, const ElementInstance& p, const std::vector<NodeRef>& nodes) {
    const auto* shaft = as<DistributedShaft>(p);
    if (shaft == nullptr || shaft->params().segments == 1) return place_same(m, p, nodes);
    DistributedShaft::Params params = shaft->params();
    const int n = params.segments;
    const int fewer = static_cast<int>((static_cast<long>(n) * finest + most - 1) / most);
    params.segments = fewer;
    m.add(p.name, nodes, std::make_shared<const DistributedShaft>(params));
    for (int k = 1; k <= n; ++k)  // the middle of segment k lies in this one
      renamed[torque_of(p.name, k)] =
          torque_of(p.name, static_cast<int>((2L * k - 1) * fewer / (2L * n)) + 1);
    for (int k = 1; k < fewer && !before.empty(); ++k) {
      const double position = static_cast<double>(k) * n / fewer;
      const int low = static_cast<int>(position);
      const double part = position - low;
      const NodeStart &a = before.at(node_at(model, p, low, n)),
                      &b = before.at(node_at(model, p, std::min(low + 1, n), n));
      starts[p.name + "_" + std::to_string(k)] = {(1 - part) * a.q + part * b.q,
                                                  (1 - part) * a.v + part * b.v};
    }
  });
  set_starts(to, starts);
  return RenamedModel{std::move(to), std::move(renamed)};
}

std::optional<RenamedModel> with_lumped_shafts(const Model& model) {
  std::map<std::string, std::string> renamed;
  Model to = copy(model, [&](Model& m, const ElementInstance& p, const std::vector<NodeRef>& nodes) {
    const auto* shaft = as<DistributedShaft>(p);
    if (shaft == nullptr || !has_inertia(*shaft)) return place_same(m, p, nodes);
    const int n = shaft->params().segments;
    m.add(p.name, nodes,
          std::make_shared<const ShaftSpring>(
              ShaftSpring::Params{.stiffness = shaft->segment_stiffness() / n}));
    for (const std::size_t end : {0, 1})
      m.add(p.name + (end == 0 ? "_inertia_a" : "_inertia_b"), {nodes[end]},
            std::make_shared<const Inertia>(Inertia::Params{.inertia = 0.5 * n * shaft->segment_inertia()}));
    for (int k = 1; k <= n; ++k) renamed[torque_of(p.name, k)] = p.name + ".torque_Nm";
  });
  if (renamed.empty()) return {};
  set_starts(to, starts_of(model));
  return RenamedModel{std::move(to), std::move(renamed)};
}

int finest_shaft(const Model& model) {
  int finest = 0;
  for (const ElementInstance& p : model.element_instances())
    if (const auto* shaft = as<DistributedShaft>(p); shaft != nullptr && has_inertia(*shaft))
      finest = std::max(finest, shaft->params().segments);
  return finest;
}

}  // namespace drev
