#include <drev/elements/involute.hpp>
#include <drev/elements/not_given.hpp>
#include <drev/models/gears/gear_drawing.hpp>

#include <cmath>
#include <optional>

#include "app/model_file/shared_fields.hpp"
#include "models/gears/gear_element.hpp"

namespace drev::app {

namespace {

using D = Dimension;

/// The contact ratio, or the gears that it follows from.
void list_contact_ratio(Fields& f, double& ratio) {
  f.number({"contact_ratio", D::none}, ratio);
  if (!f.reading()) return;
  int given = std::isnan(ratio) ? 0 : 1;
  const auto from = [&](const std::function<double()>& involute) {
    ++given;
    f.guarded([&] { ratio = involute(); });
  };
  InvolutePair pair{kNotGiven, kNotGiven, kNotGiven, kNotGiven, kNotGiven, 0};
  if (f.group("gears", [&](Fields& g) {
        g.number({"base_radius_1", D::length}, pair.base_radius_1, Need::required);
        g.number({"tip_radius_1", D::length}, pair.tip_radius_1, Need::required);
        g.number({"base_radius_2", D::length}, pair.base_radius_2, Need::required);
        g.number({"tip_radius_2", D::length}, pair.tip_radius_2, Need::required);
        g.number({"centre_distance", D::length}, pair.centre_distance, Need::required);
        g.whole("teeth_1", pair.teeth_1, Need::required);
      }))
    from([&] { return involute_contact_ratio(pair); });
  int teeth_1 = 0, teeth_2 = 0;
  double angle = kNotGiven, addendum = 1.0;
  if (f.group("standard_gears", [&](Fields& g) {
        g.whole("teeth_1", teeth_1, Need::required);
        g.whole("teeth_2", teeth_2, Need::required);
        g.number({"pressure_angle", D::angle}, angle, Need::required);
        g.number({"addendum", D::none}, addendum);
      }))
    from([&] { return involute_contact_ratio(1.0, teeth_1, teeth_2, angle, addendum); });
  if (given != 1) f.fault("needs exactly one of contact_ratio, gears and standard_gears");
}

/// drawn: a geometry gives the stiffness.
void list_stiffness(Fields& f, MeshStiffness& stiffness, bool drawn) {
  const Quantity along("stiffness", D::stiffness), mean("mean", D::stiffness);
  const Quantity single("single", D::stiffness), both("double", D::stiffness);
  const Quantity amplitude("amplitude", D::stiffness), phase("phase", D::mesh_periods);
  const MeshStiffness::Law& law = stiffness.law();
  double k = kNotGiven;
  MeshStiffness::Step step{kNotGiven, kNotGiven, kNotGiven};
  MeshStiffness::Fourier series{kNotGiven, {}};
  PeriodicTable table;
  if (const auto* constant = std::get_if<double>(&law)) k = *constant;
  if (const auto* held = std::get_if<MeshStiffness::Step>(&law)) step = *held;
  if (const auto* held = std::get_if<MeshStiffness::Fourier>(&law)) series = *held;
  if (const auto* held = std::get_if<PeriodicTable>(&law)) table = *held;
  const bool read = f.reading();
  const auto list_step = [&](Fields& g) {
    g.number(single, step.single, Need::required);
    g.number(both, step.both, Need::required);
    list_contact_ratio(g, step.contact_ratio);
  };
  int given = drawn ? 1 : 0;
  if (read || std::holds_alternative<double>(law)) {
    f.number(along, k);
    if (!std::isnan(k)) ++given, stiffness = MeshStiffness(k);
  }
  if ((read || std::holds_alternative<MeshStiffness::Step>(law)) && f.group("stiffness_step", list_step))
    ++given, stiffness = MeshStiffness::step(step.single, step.both, step.contact_ratio);
  if ((read || std::holds_alternative<MeshStiffness::Fourier>(law)) &&
      f.group("stiffness_fourier", [&](Fields& g) {
        g.number(mean, series.mean, Need::required);
        list_harmonics(g, "harmonics", Quantity("order", D::none), amplitude, series.harmonics);
      }))
    ++given, stiffness = MeshStiffness::fourier(series.mean, series.harmonics);
  int harmonics = 10;
  if (read && f.group("stiffness_fourier_of_step", [&](Fields& g) {
        list_step(g);
        g.whole("harmonics", harmonics);
        if (harmonics < 1 || harmonics > 1000) g.fault("harmonics must be from 1 to 1000");
      }))
    ++given,
        stiffness = MeshStiffness::fourier_of_step(step.single, step.both, step.contact_ratio, harmonics);
  if ((read || std::holds_alternative<PeriodicTable>(law)) &&
      list_periodic(f, "stiffness_table", phase, along, 1.0, table))
    ++given, stiffness = MeshStiffness::table(table.arguments(), table.values());
  if (read && given != 1)
    f.fault("needs exactly one of " + spellings("stiffness", D::stiffness) +
            ", stiffness_step, stiffness_fourier, stiffness_fourier_of_step, stiffness_table and geometry");
}

void list_error(Fields& f, TransmissionError& error) {
  const Quantity amplitude("amplitude", D::length), phase("phase", D::mesh_periods), e("error", D::length);
  std::vector<Harmonic> harmonics;
  PeriodicTable table;
  if (const auto* held = std::get_if<std::vector<Harmonic>>(&error.law())) harmonics = *held;
  if (const auto* held = std::get_if<PeriodicTable>(&error.law())) table = *held;
  const bool by_table = std::holds_alternative<PeriodicTable>(error.law());
  const bool first =
      list_harmonics(f, "transmission_error", Quantity("order", D::none), amplitude, harmonics);
  if (first) error = TransmissionError(harmonics);
  if ((f.reading() || by_table) && list_periodic(f, "transmission_error_table", phase, e, 1.0, table)) {
    error = TransmissionError::table(table.arguments(), table.values());
    if (first) f.fault("has transmission_error and transmission_error_table; give one of them");
  }
}

void list_gear(Fields& f, GearDrawing& drawing, std::size_t i) {
  GearData& g = i == 0 ? drawing.geometry.gear_1 : drawing.geometry.gear_2;
  f.whole("teeth", g.teeth, Need::required);
  f.number({"profile_shift", D::none}, g.profile_shift);
  f.number({"tip_diameter", D::length}, g.tip_diameter);
  f.number({"tip_alteration", D::none}, g.tip_alteration);
  f.number({"tip_chamfer", D::length}, g.tip_chamfer);
  f.number({"width", D::length}, g.width);
  f.number({"bore_diameter", D::length}, g.bore_diameter);
  f.number({"outer_diameter", D::length}, g.outer_diameter);
  f.number({"rim_inner_diameter", D::length}, g.rim_inner_diameter);
  f.number({"hub_diameter", D::length}, g.hub_diameter);
  f.number({"web_thickness", D::length}, g.web_thickness);
  f.number({"youngs_modulus", D::pressure}, g.material.youngs_modulus);
  f.number({"poisson_ratio", D::none}, g.material.poisson_ratio);
  f.number({"density", D::density}, g.material.density);
  f.number({"upper_allowance", D::length}, drawing.tolerances.thickness[i].upper_allowance);
  f.number({"thickness_tolerance", D::length}, drawing.tolerances.thickness[i].tolerance);
  f.number({"temperature_rise_K", D::none}, drawing.tolerances.temperature_rise[i]);
  f.number({"expansion_per_K", D::none}, drawing.tolerances.expansion[i]);
  f.number({"tip_relief", D::length}, drawing.cycle.tip_relief[i].depth);
  f.number({"tip_relief_length", D::length}, drawing.cycle.tip_relief[i].length);
}

}  // namespace

void list(Fields& f, GearDrawing& drawing) {
  GearGeometry& g = drawing.geometry;
  f.number({"module", D::length}, g.module, Need::required);
  f.number({"pressure_angle", D::angle}, g.pressure_angle);
  f.number({"helix_angle", D::angle}, g.helix_angle);
  f.number({"centre_distance", D::length}, g.centre_distance);
  f.flag("internal", g.internal);
  f.group("rack", [&](Fields& r) {
    r.number({"addendum", D::none}, g.rack.addendum);
    r.number({"dedendum", D::none}, g.rack.dedendum);
    r.number({"root_radius", D::none}, g.rack.root_radius);
  });
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
    const std::string name = i == 0 ? "gear_1" : "gear_2";
    if (!f.group(name, [&](Fields& r) { list_gear(r, drawing, i); }) && f.reading() &&
        (i == 0 ? g.gear_1 : g.gear_2).teeth == 0)
      f.fault("needs " + name + " = { teeth = ... }, in order");
  }
  f.number({"load", D::stiffness}, drawing.cycle.load);
  f.number({"torque_1", D::torque}, drawing.torque_1);
  f.number({"centre_distance_tolerance", D::length}, drawing.tolerances.centre_distance);
  f.number({"housing_temperature_rise_K", D::none}, drawing.tolerances.housing_temperature_rise);
  f.number({"housing_expansion_per_K", D::none}, drawing.tolerances.housing_expansion);
  f.number({"backlash_percentile", D::none}, drawing.backlash_percentile);
  f.columns("loads", {{{"load", D::stiffness}, &drawing.loads}});
  f.flag("tangent", drawing.tangent);
  f.flag("corner_contact", drawing.cycle.corner_contact);
  f.flag("windup", drawing.cycle.windup);
  f.whole("points", drawing.cycle.points);
  f.whole("level", drawing.cycle.level);
  f.columns("pitch_deviations", {{{"deviation", D::length}, &drawing.cycle.pitch_deviations}});
}

void list(Fields& f, GearMesh::Params& p) {
  GearDrawing drawing;
  std::optional<GearMesh::Params> drawn;
  if (f.reading() && f.group("geometry", [&](Fields& g) { list(g, drawing); })) {
    f.guarded([&] { drawn = gear_mesh_params(drawing); });
    if (!drawn) drawn.emplace();  // what is wrong has been said
    p.normal_backlash = drawn->normal_backlash;
  }
  static const std::vector<std::string> laws{"proportional", "limited", "contact_only", "always"};
  f.number({"base_radius_1", D::length}, p.base_radius_1);
  f.number({"base_radius_2", D::length}, p.base_radius_2);
  f.number({"module", D::length}, p.module);
  f.whole("teeth_1", p.teeth_1);
  f.whole("teeth_2", p.teeth_2);
  f.number({"pressure_angle", D::angle}, p.pressure_angle);
  f.flag("internal", p.internal);
  list_stiffness(f, p.stiffness, drawn.has_value());
  f.number({"normal_backlash", D::length}, p.normal_backlash);
  f.number({"damping", D::damping}, p.damping);
  int law = static_cast<int>(p.damping_law);
  f.choice("damping_law", laws, law);
  p.damping_law = static_cast<MeshDamping>(law);
  f.number({"reference_penetration", D::length}, p.reference_penetration);
  f.columns("stiffening", {{{"penetration", D::length}, &p.stiffening.penetrations},
                           {{"slope", D::none}, &p.stiffening.slopes}});
  list_error(f, p.transmission_error);
  f.number({"mesh_phase", D::mesh_periods}, p.mesh_phase);
  if (!drawn) return;
  if (!std::isnan(p.base_radius_1) || !std::isnan(p.base_radius_2) || !std::isnan(p.module) ||
      !std::isnan(p.pressure_angle) || p.teeth_1 != 0 || p.teeth_2 != 0 || p.internal)
    f.fault(
        "has geometry beside base radii, module, teeth, pressure_angle or internal; the geometry alone says "
        "them");
  if (p.transmission_error.varies() && drawn->transmission_error.varies())
    f.fault("has a transmission error beside the tip relief of its geometry; give one of them");
  p.base_radius_1 = drawn->base_radius_1;
  p.base_radius_2 = drawn->base_radius_2;
  p.teeth_1 = drawn->teeth_1;
  p.teeth_2 = drawn->teeth_2;
  p.internal = drawn->internal;
  p.stiffness = drawn->stiffness;
  if (!drawn->stiffening.slopes.empty()) {
    if (!p.stiffening.slopes.empty())
      f.fault("has stiffening beside the loads of its geometry; give one of them");
    p.stiffening = drawn->stiffening;
  }
  if (drawn->transmission_error.varies()) p.transmission_error = drawn->transmission_error;
}

}  // namespace drev::app
