// Channels of the reference model, by the names and signs of docs/conventions.md.
#include "tests/stability/coverage/reference_model.hpp"

namespace coverage {

using Kind = ChannelId::Kind;

const char* to_text(Kind kind) {
  switch (kind) {
    case Kind::angle:
      return "angle";
    case Kind::speed:
      return "speed";
    case Kind::acceleration:
      return "acceleration";
    case Kind::twist:
      return "twist";
    case Kind::shaft_torque:
      return "shaft torque";
    case Kind::dashpot_torque:
      return "dashpot torque";
    case Kind::spring_torque:
      return "ground spring torque";
    case Kind::mesh_force:
      return "mesh force";
    case Kind::mesh_deflection:
      return "mesh deflection";
    case Kind::gear_torque:
      return "ideal gear torque";
    case Kind::polyline_torque:
      return "polyline torque";
    case Kind::polyline_deflection:
      return "polyline deflection";
    case Kind::reaction:
      return "reaction";
    case Kind::load:
      return "load torque";
  }
  return "";
}

std::string node_name(int i) { return "n" + std::to_string(i); }

void ReferenceModel::list_channels() {
  const auto add = [&](Kind kind, std::size_t index, std::size_t second, std::string name) {
    channels_.push_back({kind, static_cast<int>(index), static_cast<int>(second), std::move(name)});
  };
  const auto number = [](std::size_t i) { return std::to_string(i); };
  for (std::size_t i = 0; i < spec_.nodes.size(); ++i) {
    const std::string n = node_name(static_cast<int>(i));
    if (unknown_[i] >= 0) {
      add(Kind::angle, i, 0, n + ".angle_rad");
      add(Kind::speed, i, 0, n + ".speed_rad_per_s");
      add(Kind::acceleration, i, 0, n + ".acceleration_rad_per_s2");
    }
    if (spec_.nodes[i].prescribed) add(Kind::reaction, i, 0, n + ".reaction_Nm");
  }
  for (std::size_t i = 0; i < spec_.shafts.size(); ++i) {
    const Shaft& s = spec_.shafts[i];
    add(Kind::shaft_torque, i, 0, "shaft" + number(i) + ".torque_Nm");
    add(Kind::twist, at(s.b), at(s.a), node_name(s.b) + "-" + node_name(s.a) + ".twist_rad");
  }
  for (std::size_t i = 0; i < spec_.dashpots.size(); ++i)
    add(Kind::dashpot_torque, i, 0, "dashpot" + number(i) + ".torque_Nm");
  for (std::size_t i = 0; i < spec_.springs.size(); ++i)
    add(Kind::spring_torque, i, 0, "spring" + number(i) + ".torque_Nm");
  for (std::size_t i = 0; i < spec_.meshes.size(); ++i) {
    add(Kind::mesh_force, i, 0, "mesh" + number(i) + ".force_N");
    add(Kind::mesh_deflection, i, 0, "mesh" + number(i) + ".deflection_m");
  }
  for (std::size_t i = 0; i < spec_.gears.size(); ++i)
    add(Kind::gear_torque, i, 0, "gear" + number(i) + ".torque_Nm");
  for (std::size_t i = 0; i < spec_.polylines.size(); ++i) {
    add(Kind::polyline_torque, i, 0, "polyline" + number(i) + ".torque_Nm");
    add(Kind::polyline_deflection, i, 0, "polyline" + number(i) + ".deflection_rad");
  }
  for (std::size_t i = 0; i < spec_.loads.size(); ++i)
    add(Kind::load, i, 0, "load" + number(i) + ".torque_Nm");
}

/// Torque that balances these nodes, as seen at the node `unit`.
Poly ReferenceModel::sum_of_residuals(const std::vector<bool>& nodes, int unit) const {
  Poly sum;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (nodes[i]) sum.add(factor_[i] / factor_[at(unit)], poly(residual_[i]));
  return sum;
}

Poly ReferenceModel::channel(const ChannelId& id) const {
  const std::size_t i = at(id.index);
  Poly y;
  const auto node_rate = [&](int node) { return poly(rate_[at(node)]); };
  const auto twist = [&](const Shaft& s) {
    Poly x;
    if (s.b >= 0) x.add(1, poly(q_[at(s.b)]));
    x.add(s.b >= 0 ? -1 : 1, poly(q_[at(s.a)]));
    return x;
  };
  const auto linear = [&](const Shaft& s) {
    y.add(s.stiffness, twist(s));
    if (s.b >= 0) y.add(s.damping, node_rate(s.b));
    y.add(s.b >= 0 ? -s.damping : s.damping, node_rate(s.a));
    return y;
  };
  switch (id.kind) {
    case Kind::angle:
    case Kind::speed:
    case Kind::acceleration: {
      y.add(factor_[i], Poly{z_[at(unknown_[i])], degree_ + 2});
      if (id.kind == Kind::angle) return y;
      return id.kind == Kind::speed ? y.derivative() : y.derivative().derivative();
    }
    case Kind::twist:
      return twist({.a = id.second, .b = id.index});
    case Kind::shaft_torque:
      return linear(spec_.shafts[i]);
    case Kind::dashpot_torque:
      return linear(spec_.dashpots[i]);
    case Kind::spring_torque:
      return linear(spec_.springs[i]);
    case Kind::mesh_force:
      return poly(meshes_[i].y);
    case Kind::mesh_deflection:
      return poly(meshes_[i].x);
    case Kind::polyline_torque:
      return poly(polylines_[i].y);
    case Kind::polyline_deflection:
      return poly(polylines_[i].x);
    case Kind::load:
      return poly(loads_[i].torque);
    case Kind::reaction: {
      std::vector<bool> group(root_.size());
      for (std::size_t n = 0; n < root_.size(); ++n) group[n] = root_[n] == id.index;
      return sum_of_residuals(group, id.index);
    }
    case Kind::gear_torque: {  // all that hangs on the second node
      const int second = spec_.gears[i].b;
      std::vector<bool> behind(root_.size());
      behind[at(second)] = true;
      for (const Gear& g : spec_.gears)
        if (behind[at(g.a)]) behind[at(g.b)] = true;
      return sum_of_residuals(behind, second);
    }
  }
  return y;
}

}  // namespace coverage
