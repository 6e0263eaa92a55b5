// Fields of the elements that real trains are made of: engines, couplings and dampers, machines, gear sets.
#include "app/model_file/shared_fields.hpp"

namespace drev::app {

namespace {

using D = Dimension;

}  // namespace

namespace {

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
    if (!order.empty())
      f.guarded([&] { p.firing_angles = EngineCylinders::even_firing(order, p.strokes, first); });
  } else {
    f.columns("firing", {{angle, &p.firing_angles}});
  }
}

void list_gas(Fields& f, GasPressure::Params& p) {
  const Quantity pressure("pressure", D::pressure), speed("speed", D::angular_speed);
  if (f.reading() || !p.angle.empty()) {
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
  }
  f.number({"load", D::none}, p.at_load);
  f.number({"firing_tdc", D::angle}, p.firing_tdc);
  list_interpolation(f, p.interpolation);
  if (f.reading() || !p.peak_speed.empty())
    f.columns("peak_pressure", {{speed, &p.peak_speed}, {pressure, &p.peak_pressure}});
  f.number({"reference_pressure", D::pressure}, p.reference_pressure);
}

}  // namespace

void list(Fields& f, EngineCylinders::Params& p) {
  f.number({"bore", D::length}, p.bore, Need::required);
  f.number({"stroke", D::length}, p.stroke, Need::required);
  f.number({"rod", D::length}, p.rod, Need::required);
  f.number({"oscillating_mass", D::mass}, p.oscillating_mass);
  f.number({"rotating_mass", D::mass}, p.rotating_mass);
  f.flag("mean_oscillating_inertia", p.mean_oscillating_inertia);
  f.whole("strokes", p.strokes);
  list_firing(f, p);
  list_gas(f, p.gas);
  f.number({"crankcase_pressure", D::pressure}, p.crankcase_pressure);
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

}  // namespace drev::app
