// Fields of the elements that real trains are made of: engines, couplings and dampers, machines, gear sets.
#include <drev/core/units.hpp>

#include <cmath>

#include "app/model_file/shared_fields.hpp"

namespace drev::app {

namespace {

using D = Dimension;

void list_gate(Fields& f, SpeedGate& gate) {
  f.number({"from_speed", D::angular_speed, D::speed}, gate.from_speed);
  f.number({"to_speed", D::angular_speed, D::speed}, gate.to_speed);
  f.number({"speed_ramp", D::angular_speed, D::speed}, gate.speed_ramp);
}

/// The firing angles, or the order that they follow from.
void list_firing(Fields& f, EngineCylinders::Params& p) {
  const Quantity angle("angle", D::angle);
  if (f.reading()) {
    std::string order;
    double first = 0.0;
    f.text("firing_order", order);
    f.number({"first_firing", D::angle}, first);
    const bool columns = f.columns("firing", {{angle, &p.firing_angles}});
    if (columns == !order.empty()) f.fault("needs exactly one of firing_order and firing");
    if (columns) f.without_effect("first_firing", "firing gives the angle of each cylinder");
    if (order.empty() || columns) return;
    if (EngineCylinders::why_no_order(order).empty()) {
      p.firing_angles = EngineCylinders::even_firing(order, p.strokes, first);
    } else {
      // Then the element says so, with all else that is wrong with it.
      p.unread_firing_order = order;
      p.firing_angles.assign(EngineCylinders::cylinders_of(order), first);
    }
  } else {
    f.columns("firing", {{angle, &p.firing_angles}});
  }
}

/// The curves of pressure and what belongs to them.
void list_curves(Fields& f, GasPressure::Params& p, double& crankcase) {
  const Quantity pressure("pressure", D::pressure), speed("speed", D::angular_speed);
  std::vector<double> at_speed = p.speed, at_load = p.load;
  const bool given = f.columns("pressure", {{{"angle", D::angle}, &p.angle},
                                            {pressure, &p.pressure},
                                            {speed, &at_speed, Need::optional},
                                            {{"load", D::none}, &at_load, Need::optional}});
  const auto several = [](const std::vector<double>& all) {
    for (const double value : all)
      if (value != all.front()) return true;
    return false;
  };
  if (given) p.speed = several(at_speed) ? at_speed : std::vector<double>{};
  if (given) p.load = several(at_load) ? at_load : std::vector<double>{};
  if (f.reading() || !p.load.empty()) f.number({"load", D::none}, p.at_load);
  f.number({"firing_tdc", D::angle}, p.firing_tdc);
  list_interpolation(f, p.interpolation);
  if (f.reading() || !p.peak_speed.empty()) {
    f.columns("peak_pressure", {{speed, &p.peak_speed}, {pressure, &p.peak_pressure}});
    f.number({"reference_pressure", D::pressure}, p.reference_pressure);
  }
  f.number({"crankcase_pressure", D::pressure}, crankcase);
  if (given) {
    if (p.load.empty()) f.without_effect("load", "pressure has no curves of several loads");
    if (p.peak_speed.empty()) f.without_effect("reference_pressure", "it belongs to peak_pressure");
    return;
  }
  for (const char* name :
       {"load", "firing_tdc", "interpolation", "peak_pressure", "reference_pressure", "crankcase_pressure"})
    f.without_effect(name, "it belongs to pressure, which is not given");
}

}  // namespace

void list(Fields& f, EngineCylinders::Params& p) {
  f.number({"bore", D::length}, p.bore, Need::required);
  f.number({"stroke", D::length}, p.stroke, Need::required);
  f.number({"rod", D::length}, p.rod, Need::required);
  f.number({"oscillating_mass", D::mass}, p.oscillating_mass);
  f.number({"rotating_mass", D::mass}, p.rotating_mass);
  f.flag("mean_oscillating_inertia", p.mean_oscillating_inertia);
  f.flag("varying_inertia", p.varying_inertia);
  f.whole("strokes", p.strokes);
  list_firing(f, p);
  if (f.reading() || !p.gas.angle.empty()) list_curves(f, p.gas, p.crankcase_pressure);
  list_gate(f, p.gas.firing);
  list_harmonics(f, "tangential_pressure", {"order", D::none}, {"amplitude", D::pressure},
                 p.tangential_pressure);
  f.number({"mean_tangential_pressure", D::pressure}, p.mean_tangential_pressure);
  f.whole("misfiring_cylinder", p.misfiring_cylinder);
  f.flag("twist_feedback", p.twist_feedback);
}

namespace {

void list_viscoelastic(Fields& f, ViscoelasticStiffness::Params& p) {
  f.number({"stiffness", D::torsional_stiffness}, p.stiffness);
  f.number({"loss_factor", D::none}, p.loss_factor);
  if (f.reading() || !p.frequencies.empty())
    f.columns("by_frequency", {{{"frequency", D::frequency}, &p.frequencies},
                               {{"stiffness", D::torsional_stiffness}, &p.stiffnesses},
                               {{"loss_factor", D::none}, &p.loss_factors}});
  const auto list_table = [&](const char* name, const Quantity& argument, ViscoelasticStiffness::Table& t) {
    if (f.reading() || !t.at.empty())
      f.columns(name, {{argument, &t.at},
                       {{"stiffness", D::torsional_stiffness}, &t.stiffnesses},
                       {{"loss_factor", D::none}, &t.loss_factors}});
  };
  list_table("by_mean_torque", {"mean_torque", D::torque}, p.by_mean_torque);
  list_table("by_amplitude", {"amplitude", D::angle}, p.by_amplitude);
  f.number({"at_mean_torque", D::torque}, p.at_mean_torque);
  f.number({"at_amplitude", D::angle}, p.at_amplitude);
  f.number({"lowest_frequency", D::frequency}, p.lowest_frequency);
  f.number({"highest_frequency", D::frequency}, p.highest_frequency);
  f.whole("branches", p.branches);
  f.number({"permitted_error", D::none}, p.permitted_error);
}

}  // namespace

void list(Fields& f, ElasticCoupling::Params& p) {
  list_viscoelastic(f, p.material);
  f.number({"damping", D::torsional_damping}, p.damping);
}

void list(Fields& f, TorsionalDamper::Params& p) {
  f.number({"hub_inertia", D::inertia}, p.hub_inertia);
  f.number({"ring_inertia", D::inertia}, p.ring_inertia, Need::required);
  f.number({"natural_frequency", D::frequency}, p.natural_frequency);
  list_viscoelastic(f, p.spring);
  f.number({"damping", D::torsional_damping}, p.damping);
  f.number({"damping_ratio", D::none}, p.damping_ratio);
  if (!f.reading() && !p.film) return;
  FluidFilm film = p.film.value_or(FluidFilm{});
  if (f.group("film", [&](Fields& g) {
        g.number({"viscosity_Pas", D::none}, film.viscosity, Need::required);
        g.number({"outer_radius", D::length}, film.outer_radius, Need::required);
        g.number({"inner_radius", D::length}, film.inner_radius);
        g.number({"width", D::length}, film.width, Need::required);
        g.number({"side_gap", D::length}, film.side_gap);
        g.number({"outer_gap", D::length}, film.outer_gap);
        g.number({"inner_gap", D::length}, film.inner_gap);
      }))
    p.film = film;
}

void list(Fields& f, AbsoluteDamper::Params& p) {
  f.number({"damping", D::torsional_damping, D::damping}, p.damping, Need::required);
}

void list(Fields& f, Propeller::Params& p) {
  f.number({"rated_torque", D::torque}, p.rated_torque, Need::required);
  f.number({"rated_speed", D::angular_speed}, p.rated_speed, Need::required);
  f.number({"damping_factor", D::none}, p.damping_factor);
  list_harmonics(f, "harmonics", {"order", D::none}, {"amplitude", D::none}, p.harmonics);
  f.flag("twist_feedback", p.twist_feedback);
}

void list(Fields& f, TorqueCurve::Params& p) {
  f.columns("curve", {{{"speed", D::angular_speed}, &p.speeds}, {{"torque", D::torque}, &p.torques}});
  f.number({"scale", D::none}, p.scale);
  list_gate(f, p.gate);
}

void list(Fields& f, TorqueFunction::Params& p) {
  // Numbers of the formula's variables: 0 angle, 1 speed, 2 time, in SI.
  const bool turns = f.kind == NodeKind::rotational;
  const std::vector<FormulaVariable> of_turning{{"angle_rad", 0, 1.0},
                                                {"angle_deg", 0, to_deg(1.0)},
                                                {"speed_rad_per_s", 1, 1.0},
                                                {"speed_rpm", 1, to_rpm(1.0)},
                                                {"time_s", 2, 1.0}};
  const std::vector<FormulaVariable> of_moving{
      {"position_m", 0, 1.0}, {"speed_m_per_s", 1, 1.0}, {"time_s", 2, 1.0}};
  f.formula("expression", turns ? of_turning : of_moving, turns ? "Nm" : "N", p.formula);
  list_gate(f, p.gate);
}

void list(Fields& f, Generator::Params& p) {
  f.number({"torque", D::torque}, p.torque);
  f.number({"synchronous_stiffness", D::torsional_stiffness}, p.synchronous_stiffness);
  f.number({"synchronous_damping", D::torsional_damping}, p.synchronous_damping);
  f.number({"fault_time", D::time}, p.fault_time);
  f.number({"fault_torque", D::torque}, p.fault_torque);
  f.number({"fault_torque_double", D::torque}, p.fault_torque_double);
  f.number({"grid_frequency", D::frequency}, p.grid_frequency);
  f.number({"fault_decay", D::time}, p.fault_decay);
}

void list(Fields& f, SpeedGovernor::Params& p) {
  f.number({"proportional_gain", D::torsional_damping}, p.proportional_gain);
  f.number({"integral_gain", D::torsional_stiffness}, p.integral_gain);
  f.number({"actuator_lag", D::time}, p.actuator_lag);
  f.number({"droop", D::none}, p.droop);
  f.number({"rated_torque", D::torque}, p.rated_torque);
  f.number({"rated_speed", D::angular_speed}, p.rated_speed);
}

void list(Fields& f, PlanetarySet::Params& p) {
  f.number({"ratio", D::none}, p.ratio);
  f.whole("teeth_sun", p.teeth_sun);
  f.whole("teeth_ring", p.teeth_ring);
  f.flag("together", p.together);
}

namespace {

void list_groove(Fields& f, ShaftGroove& g) {
  f.number({"position", D::length}, g.position, Need::required);
  f.number({"depth", D::length}, g.depth, Need::required);
  f.number({"radius", D::length}, g.radius, Need::required);
}

void list_keyway(Fields& f, ShaftKeyway& k) {
  f.number({"width", D::length}, k.width, Need::required);
  f.number({"depth", D::length}, k.depth, Need::required);
  f.number({"corner_radius", D::length}, k.corner_radius, Need::required);
}

void list_spline(Fields& f, ShaftSpline& s) {
  f.whole("teeth", s.teeth, Need::required);
  f.number({"minor_diameter", D::length}, s.minor_diameter, Need::required);
  f.number({"tooth_width", D::length}, s.tooth_width, Need::required);
  f.number({"root_radius", D::length}, s.root_radius, Need::required);
}

void list_cam(Fields& f, ShaftCam& c) {
  constexpr double kTurn = 6.283185307179586;
  if (!list_periodic(f, "lift", {"angle", D::angle}, {"lift", D::length}, kTurn, c.lift) && f.reading())
    f.fault("lacks lift");
  list_interpolation(f, c.interpolation);
}

/// A feature that a station may have: read where it is given, written where it is there.
template <class Feature, class List>
void list_feature(Fields& f, const char* name, std::optional<Feature>& feature, const List& list) {
  if (!f.reading() && !feature) return;
  Feature held = feature.value_or(Feature{});
  if (f.group(name, [&](Fields& g) { list(g, held); })) feature = held;
}

void list_station(Fields& f, ShaftStation& s) {
  f.text("name", s.name);
  f.number({"length", D::length}, s.length, Need::required);
  f.number({"outer_diameter", D::length}, s.outer_diameter, Need::required);
  f.number({"end_diameter", D::length}, s.end_diameter);
  f.number({"inner_diameter", D::length}, s.inner_diameter);
  f.number({"fillet_start", D::length}, s.fillet_start);
  f.number({"fillet_end", D::length}, s.fillet_end);
  f.number({"hub_diameter", D::length}, s.hub_diameter);
  list_feature(f, "groove", s.groove, list_groove);
  list_feature(f, "keyway", s.keyway, list_keyway);
  list_feature(f, "spline", s.spline, list_spline);
  list_feature(f, "cam", s.cam, list_cam);
}

}  // namespace

void list(Fields& f, ShaftContour& p) {
  f.number({"shear_modulus", D::pressure}, p.shear_modulus, Need::required);
  f.number({"density", D::density}, p.density, Need::required);
  const bool given = f.rows(
      "stations", p.stations.size(), [&](std::size_t count) { p.stations.resize(count); },
      [&](Fields& g, std::size_t i) { list_station(g, p.stations[i]); });
  if (f.reading() && !given) f.fault("lacks stations, an array of tables");
  f.number({"accuracy", D::none}, p.accuracy);
  f.number({"up_to_frequency", D::frequency}, p.up_to_frequency);
  f.number({"frequency_accuracy", D::none}, p.frequency_accuracy);
  int mass = static_cast<int>(p.mass);
  f.choice("mass", {"lumped", "consistent", "averaged"}, mass);
  p.mass = static_cast<SegmentMass>(mass);
}

void list(Fields& f, DryFriction::Params& p) {
  const Quantity slip("slip_speed", D::angular_speed, D::speed),
      torque("torque", D::torque, "force", D::force);
  const bool read = f.reading();
  if (read || !std::isnan(p.torque)) f.number(torque, p.torque);
  if (read || !p.sliding_torques.empty())
    f.columns("sliding", {{slip, &p.slip_speeds}, {torque, &p.sliding_torques}});
  if (read || !std::isnan(p.normal_force)) {
    f.number({"normal_force", D::force}, p.normal_force);
    f.number({"geometry", D::length}, p.geometry);
  }
  if (read || !std::isnan(p.friction_coefficient))
    f.number({"friction_coefficient", D::none}, p.friction_coefficient);
  if (read || !p.friction_coefficients.empty())
    f.columns("coefficients", {{slip, &p.slip_speeds}, {{"coefficient", D::none}, &p.friction_coefficients}});
  f.number({"break_away_ratio", D::none}, p.break_away_ratio);
  std::vector<double> times, values;
  if (p.engagement) times = p.engagement->times(), values = p.engagement->values();
  if ((read || p.engagement) &&
      f.columns("engagement", {{{"time", D::time}, &times}, {{"part", D::none}, &values}}))
    p.engagement = TimeTable(times, values);
  if (!read && !p.engagement_formula) return;
  TimeCurve::Params curve = p.engagement_formula ? p.engagement_formula->params() : TimeCurve::Params{};
  if (f.group("engagement_formula", [&](Fields& g) {
        g.formula("expression", {{"time_s", 0, 1.0}}, "", curve.formula);
        g.number({"from", D::time}, curve.from, Need::required);
        g.number({"to", D::time}, curve.to, Need::required);
        if (read || !curve.breakpoints.empty())
          g.columns("breakpoints", {{{"time", D::time}, &curve.breakpoints}});
        g.number({"accuracy", D::none}, curve.accuracy);
      }))
    p.engagement_formula = TimeCurve(std::move(curve));
}

void list(Fields& /*f*/, Freewheel::Params& /*p*/) {}

void list(Fields& f, LossyGear::Params& p) {
  const bool read = f.reading();
  f.number({"ratio", D::none}, p.ratio, Need::required);
  if (read || p.speeds.empty()) {
    f.number({"efficiency_forward", D::none}, p.efficiency_forward);
    f.number({"efficiency_backward", D::none}, p.efficiency_backward);
    f.number({"bearing_torque_forward", D::torque}, p.bearing_torque_forward);
    f.number({"bearing_torque_backward", D::torque}, p.bearing_torque_backward);
  }
  if (read || !p.speeds.empty())
    f.columns("losses", {{{"speed", D::angular_speed}, &p.speeds},
                         {{"efficiency_forward", D::none}, &p.efficiencies_forward},
                         {{"efficiency_backward", D::none}, &p.efficiencies_backward},
                         {{"bearing_torque_forward", D::torque}, &p.bearing_torques_forward},
                         {{"bearing_torque_backward", D::torque}, &p.bearing_torques_backward}});
}

}  // namespace drev::app
