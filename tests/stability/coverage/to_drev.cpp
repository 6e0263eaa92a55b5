#include "tests/stability/coverage/to_drev.hpp"

#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>

namespace coverage {

namespace {

std::string node(int i) { return "n" + std::to_string(i); }
std::string numbered(const char* name, std::size_t i) { return name + std::to_string(i); }

std::vector<drev::Harmonic> harmonics(const std::vector<Harmonic>& from) {
  std::vector<drev::Harmonic> all;
  for (const Harmonic& h : from) all.push_back({h.order, h.amplitude, h.phase});
  return all;
}

drev::MeshDamping damping_law(Law law) {
  switch (law) {
    case Law::proportional:
      return drev::MeshDamping::proportional;
    case Law::limited:
      return drev::MeshDamping::limited;
    case Law::contact_only:
      return drev::MeshDamping::contact_only;
    case Law::always:
      break;
  }
  return drev::MeshDamping::always;
}

drev::MeshStiffness stiffness(const Mesh& m) {
  switch (m.kind) {
    case Mesh::Stiffness::step:
      return drev::MeshStiffness::step(m.stiffness, m.both, m.ratio);
    case Mesh::Stiffness::fourier:
      return drev::MeshStiffness::fourier(m.stiffness, harmonics(m.stiffness_harmonics));
    case Mesh::Stiffness::table:
      return drev::MeshStiffness::table(m.stiffness_table.arguments, m.stiffness_table.values);
    case Mesh::Stiffness::constant:
      break;
  }
  return m.stiffness;
}

void add_mesh(drev::Model& model, const std::string& name, const Mesh& m) {
  drev::GearMesh::Params p{.base_radius_1 = m.radius_a,
                           .base_radius_2 = m.radius_b,
                           .teeth_1 = m.teeth,
                           .internal = m.internal,
                           .stiffness = stiffness(m),
                           .normal_backlash = m.backlash,
                           .damping = m.damping,
                           .damping_law = damping_law(m.law),
                           .mesh_phase = m.phase};
  if (m.reference_penetration > 0.0) p.reference_penetration = m.reference_penetration;
  if (!m.error_harmonics.empty()) p.transmission_error = harmonics(m.error_harmonics);
  if (!m.error_table.arguments.empty())
    p.transmission_error = drev::TransmissionError::table(m.error_table.arguments, m.error_table.values);
  model.add<drev::GearMesh>(name, {node(m.a), node(m.b)}, p);
}

void add_load(drev::Model& model, const std::string& name, const Load& l) {
  switch (l.kind) {
    case Load::Kind::table_in_time:
      model.add<drev::AppliedTorque>(name, {node(l.node)}, {.table = drev::TimeTable(l.times, l.torques)});
      break;
    case Load::Kind::harmonics_in_time:
      model.add<drev::AppliedTorque>(name, {node(l.node)}, {.harmonics = harmonics(l.harmonics)});
      break;
    case Load::Kind::table_in_angle:
      model.add<drev::CamTorque>(
          name, {node(l.node)},
          {.angle_table = drev::PeriodicTable(l.table.arguments, l.table.values, l.table.period),
           .phase = l.phase,
           .twist_feedback = l.actual_angle});
      break;
    case Load::Kind::harmonics_in_angle:
      model.add<drev::EngineOrderTorque>(
          name, {node(l.node)},
          {.harmonics = harmonics(l.harmonics), .mean = l.mean, .twist_feedback = l.actual_angle});
      break;
  }
}

void add_nominal(drev::Model& model, const Spec& spec) {
  const Nominal& n = spec.nominal;
  if (n.node < 0) return;
  if (n.runs_up())
    model.set_reference(node(n.node), drev::run_up(n.omega_0, n.omega_1, n.t_0, n.t_1));
  else
    model.set_reference(node(n.node), drev::constant_speed(n.omega_0));
}

}  // namespace

drev::System to_drev(const Spec& spec) {
  drev::Model model(spec.name);
  for (std::size_t i = 0; i < spec.nodes.size(); ++i) {
    const Node& n = spec.nodes[i];
    const std::string name = node(static_cast<int>(i));
    model.add_node(name);
    model.add<drev::Inertia>("J" + name, {name}, {.inertia = n.inertia});
    if (n.prescribed) model.hold(name);
    if (n.angle != 0.0 || n.speed != 0.0) model.set_initial(name, n.angle, n.speed);
  }
  for (std::size_t i = 0; i < spec.shafts.size(); ++i) {
    const Shaft& s = spec.shafts[i];
    model.add<drev::ShaftSpring>(numbered("shaft", i), {node(s.a), node(s.b)},
                                 {.stiffness = s.stiffness, .damping = s.damping});
  }
  for (std::size_t i = 0; i < spec.dashpots.size(); ++i) {
    const Shaft& s = spec.dashpots[i];
    if (s.b >= 0)
      model.add<drev::Dashpot>(numbered("dashpot", i), {node(s.a), node(s.b)}, {.damping = s.damping});
    else
      model.add<drev::Dashpot>(numbered("dashpot", i), {node(s.a)}, {.damping = s.damping});
  }
  for (std::size_t i = 0; i < spec.springs.size(); ++i)
    model.add<drev::GroundSpring>(
        numbered("spring", i), {node(spec.springs[i].a)},
        {.stiffness = spec.springs[i].stiffness, .damping = spec.springs[i].damping});
  for (std::size_t i = 0; i < spec.meshes.size(); ++i) add_mesh(model, numbered("mesh", i), spec.meshes[i]);
  for (std::size_t i = 0; i < spec.gears.size(); ++i)
    model.add<drev::IdealGear>(numbered("gear", i), {node(spec.gears[i].a), node(spec.gears[i].b)},
                               {.ratio = spec.gears[i].ratio});
  for (std::size_t i = 0; i < spec.polylines.size(); ++i) {
    const Polyline& p = spec.polylines[i];
    const drev::PolylineSpring::Params params{.x = p.x, .y = p.y, .damping = p.damping};
    if (p.b >= 0)
      model.add<drev::PolylineSpring>(numbered("polyline", i), {node(p.a), node(p.b)}, params);
    else
      model.add<drev::PolylineSpring>(numbered("polyline", i), {node(p.a)}, params);
  }
  for (std::size_t i = 0; i < spec.loads.size(); ++i) add_load(model, numbered("load", i), spec.loads[i]);
  if (spec.rayleigh_mass > 0.0 || spec.rayleigh_stiffness > 0.0)
    model.add<drev::RayleighDamping>(
        "rayleigh", {}, {.alpha_mass = spec.rayleigh_mass, .beta_stiffness = spec.rayleigh_stiffness});
  add_nominal(model, spec);
  return model.build();
}

}  // namespace coverage
