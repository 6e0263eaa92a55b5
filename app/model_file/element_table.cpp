#include <drev/app/model_file/element_table.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/models/shafts/contour_shaft.hpp>

#include <cmath>
#include <set>

#include "app/model_file/shared_fields.hpp"

namespace drev::app {

namespace {

using D = Dimension;

const Quantity kInertia("inertia", D::inertia, "mass", D::mass);
const Quantity kStiffness("stiffness", D::torsional_stiffness, D::stiffness);
const Quantity kDamping("damping", D::torsional_damping, D::damping);
const Quantity kTorque("torque", D::torque, "force", D::force);
const Quantity kAmplitude("amplitude", D::torque, D::force);
const Quantity kDeflection("deflection", D::angle, D::length);

void list(Fields& f, Inertia::Params& p) { f.number(kInertia, p.inertia, Need::required); }

void list(Fields& f, ShaftSpring::Params& p) {
  f.number(kStiffness, p.stiffness, Need::required);
  f.number(kDamping, p.damping);
}

void list(Fields& f, DistributedShaft::Params& p) {
  f.number({"shear_modulus", D::pressure}, p.shear_modulus, Need::required);
  f.number({"density", D::density}, p.density, Need::required);
  f.number({"outer_diameter", D::length}, p.outer_diameter, Need::required);
  f.number({"inner_diameter", D::length}, p.inner_diameter);
  f.number({"length", D::length}, p.length, Need::required);
  f.whole("segments", p.segments);
  int mass = static_cast<int>(p.mass);
  f.choice("mass", {"lumped", "consistent", "averaged"}, mass);
  p.mass = static_cast<SegmentMass>(mass);
}

void list(Fields& f, Dashpot::Params& p) { f.number(kDamping, p.damping, Need::required); }

void list(Fields& f, GroundSpring::Params& p) {
  f.number(kStiffness, p.stiffness, Need::required);
  f.number(kDamping, p.damping);
}

void list(Fields& f, RayleighDamping::Params& p) {
  f.number({"alpha_mass", D::rate}, p.alpha_mass);
  f.number({"beta_stiffness", D::time}, p.beta_stiffness);
  if (!f.reading()) return;
  double f_1 = 0.0, f_2 = 0.0, xi_1 = 0.0, xi_2 = 0.0;
  if (f.group("from_two_modes", [&](Fields& g) {
        g.number({"frequency_1", D::frequency}, f_1, Need::required);
        g.number({"damping_ratio_1", D::none}, xi_1, Need::required);
        g.number({"frequency_2", D::frequency}, f_2, Need::required);
        g.number({"damping_ratio_2", D::none}, xi_2, Need::required);
      }))
    f.guarded([&] { p = RayleighDamping::from_two_modes(hz(f_1), xi_1, hz(f_2), xi_2); });
  const auto one = [&](Fields& g) {
    g.number({"frequency", D::frequency}, f_1, Need::required);
    g.number({"damping_ratio", D::none}, xi_1, Need::required);
  };
  if (f.group("mass_proportional", one))
    f.guarded([&] { p = RayleighDamping::mass_proportional(hz(f_1), xi_1); });
  if (f.group("stiffness_proportional", one))
    f.guarded([&] { p = RayleighDamping::stiffness_proportional(hz(f_1), xi_1); });
}

void list(Fields& f, DeadBandCoupling::Params& p) {
  f.number({"stiffness", D::torsional_stiffness, D::stiffness}, p.stiffness, Need::required);
  f.number({"gap", D::angle, D::length}, p.gap);
  f.number({"damping", D::torsional_damping, D::damping}, p.damping);
  int law = static_cast<int>(p.damping_law);
  f.choice("damping_law", {"proportional", "limited", "contact_only", "always"}, law);
  p.damping_law = static_cast<MeshDamping>(law);
  f.number({"reference_penetration", D::angle, D::length}, p.reference_penetration);
}

void list(Fields& f, ModalDamping::Params& p) {
  f.number({"ratio", D::none}, p.ratio);
  if (f.reading() || !p.ratios.empty()) f.columns("by_mode", {{{"ratio", D::none}, &p.ratios}});
}

void list(Fields& f, PolylineSpring::Params& p) {
  int given = f.columns("points", {{kDeflection, &p.x}, {kTorque, &p.y}}) ? 1 : 0;
  f.number(kDamping, p.damping);
  if (!f.reading()) return;
  double k = kNotGiven, half_gap = kNotGiven, travel = kNotGiven, stop = kNotGiven;
  if (f.group("dead_band", [&](Fields& g) {
        g.number(kStiffness, k, Need::required);
        g.number({"half_gap", D::angle, D::length}, half_gap, Need::required);
      })) {
    ++given;
    p = PolylineSpring::dead_band(k, half_gap, p.damping);
  }
  if (f.group("with_stops", [&](Fields& g) {
        g.number(kStiffness, k, Need::required);
        g.number({"travel", D::angle, D::length}, travel, Need::required);
        g.number({"stop_stiffness", D::torsional_stiffness, D::stiffness}, stop, Need::required);
      })) {
    ++given;
    p = PolylineSpring::with_stops(k, travel, stop, p.damping);
  }
  if (given != 1) f.fault("needs exactly one of points, dead_band and with_stops");
}

void list(Fields& f, IdealGear::Params& p) { f.number({"ratio", D::none}, p.ratio, Need::required); }

void list(Fields& f, AppliedTorque::Params& p) {
  const bool read = f.reading();
  std::vector<double> times, values;
  if (p.table) times = p.table->times(), values = p.table->values();
  // A constant is a table of one point.
  const bool constant = times.size() == 1 && times[0] == 0.0;
  double torque = constant ? values[0] : kNotGiven;
  int given = 0;
  if (read || constant) f.number(kTorque, torque);
  if (read && !std::isnan(torque)) ++given, p.table = TimeTable({0.0}, {torque});
  if ((read || (p.table && !constant)) &&
      f.columns("table", {{{"time", D::time}, &times}, {kTorque, &values}}))
    ++given, p.table = TimeTable(times, values);
  if (list_harmonics(f, "harmonics", {"frequency", D::frequency}, kAmplitude, p.harmonics)) ++given;
  if (read && given != 1)
    f.fault("needs exactly one of " + spellings(kTorque.name(f.kind), kTorque.dimension(f.kind)) +
            ", table and harmonics");
}

void list(Fields& f, CamTorque::Params& p) {
  double period = p.angle_table.period();
  f.number({"period", D::angle}, period);
  if (!list_periodic(f, "table", {"angle", D::angle}, kTorque, period, p.angle_table) && f.reading())
    f.fault("lacks table");
  f.number({"phase", D::angle}, p.phase);
  f.flag("twist_feedback", p.twist_feedback);
  list_interpolation(f, p.interpolation);
  f.number({"scale", D::none}, p.scale);
}

void list(Fields& f, EngineOrderTorque::Params& p) {
  f.number({"mean", D::torque, D::force}, p.mean);
  list_harmonics(f, "harmonics", {"order", D::none}, kAmplitude, p.harmonics);
  f.flag("twist_feedback", p.twist_feedback);
}

template <class E>
ElementType row(const char* name) {
  return element_type<E>(name, [](Fields& f, typename E::Params& p) { list(f, p); });
}

std::vector<ElementType>& table() {
  static std::vector<ElementType> types{row<Inertia>("inertia"),
                                        row<ShaftSpring>("shaft_spring"),
                                        row<DistributedShaft>("distributed_shaft"),
                                        row<ContourShaft>("contour_shaft"),
                                        row<Dashpot>("dashpot"),
                                        row<GroundSpring>("ground_spring"),
                                        row<RayleighDamping>("rayleigh_damping"),
                                        row<ModalDamping>("modal_damping"),
                                        row<PolylineSpring>("polyline_spring"),
                                        row<DeadBandCoupling>("dead_band_coupling"),
                                        row<GearMesh>("gear_mesh"),
                                        row<LateralGearMesh>("lateral_gear_mesh"),
                                        row<IdealGear>("ideal_gear"),
                                        row<AppliedTorque>("applied_torque"),
                                        row<CamTorque>("cam_torque"),
                                        row<EngineOrderTorque>("engine_order_torque"),
                                        row<EngineCylinders>("engine_cylinders"),
                                        row<ElasticCoupling>("elastic_coupling"),
                                        row<TorsionalDamper>("torsional_damper"),
                                        row<AbsoluteDamper>("absolute_damper"),
                                        row<Propeller>("propeller"),
                                        row<TorqueCurve>("torque_curve"),
                                        row<TorqueFunction>("torque_function"),
                                        row<Generator>("generator"),
                                        row<SpeedGovernor>("speed_governor"),
                                        row<PlanetarySet>("planetary_set"),
                                        row<Clutch>("clutch"),
                                        row<Brake>("brake"),
                                        row<CoulombJoint>("coulomb_joint"),
                                        row<BearingFriction>("bearing_friction"),
                                        row<Freewheel>("freewheel"),
                                        row<LossyGear>("lossy_gear")};
  return types;
}

/// What is wrong with the keys of a type that is to be registered.
void check_keys(const ElementType& type, std::vector<Finding>& findings) {
  for (const NodeKind kind : {NodeKind::rotational, NodeKind::translational}) {
    FieldKeys keys(kind);
    type.make([&](const ListFields& list) { list(keys); });
    std::set<std::string> taken{"type", "node", "nodes"};
    for (const FieldKeys::Key& key : keys.keys())
      if (!taken.insert(key.name).second && findings.empty())
        findings.push_back({"element type " + type.name, "key", key.name, "",
                            "is there twice, or is one that every element has (type, node, nodes)"});
  }
}

}  // namespace

void register_element_type(ElementType type) {
  std::vector<Finding> findings;
  const auto refuse = [&](std::string why) {
    findings.push_back({"element types", "type", type.name, "", std::move(why)});
  };
  if (type.name.empty()) refuse("must have a name");
  if (const ElementType* same = find_element_type(type.name))
    refuse("is registered already, by " + (same->plugin.empty() ? "drev itself" : same->plugin));
  check_keys(type, findings);
  if (!findings.empty()) throw ModelError(std::move(findings));
  table().push_back(std::move(type));
}

void register_from(const std::string& plugin, const std::function<void()>& add) {
  const std::size_t before = table().size();
  try {
    add();
  } catch (...) {
    table().erase(table().begin() + static_cast<std::ptrdiff_t>(before), table().end());
    throw;
  }
  for (std::size_t i = before; i < table().size(); ++i) table()[i].plugin = plugin;
}

std::span<const ElementType> element_types() { return table(); }

const ElementType* find_element_type(const std::string& name) {
  for (const ElementType& type : table())
    if (name == type.name) return &type;
  return nullptr;
}

std::vector<std::string> element_type_names() {
  std::vector<std::string> names;
  for (const ElementType& type : table()) names.push_back(type.name);
  return names;
}

}  // namespace drev::app
