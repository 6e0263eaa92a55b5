#include "app/model_file/node_fields.hpp"

#include <drev/core/units.hpp>
#include <drev/elements/not_given.hpp>

#include <cmath>

namespace drev::app {

namespace {

using D = Dimension;

}  // namespace

NodeParams::NodeParams()
    : constant_speed(kNotGiven),
      initial_value(kNotGiven),
      initial_rate(kNotGiven),
      nominal_speed(kNotGiven),
      run_up{kNotGiven, kNotGiven, 0.0, kNotGiven},
      given{kNotGiven, kNotGiven, 0.0, 0.0} {}

MotionPoint NodeParams::Given::operator()(double t) const {
  const double w = hz(frequency), c = amplitude * std::cos(w * t + phase),
               s = amplitude * std::sin(w * t + phase);
  return {offset + c, -w * s, -w * w * c};
}

const std::vector<std::string>& node_kind_names() {
  static const std::vector<std::string> names{"rotational", "translational"};
  return names;
}

void list_fields(Fields& f, NodeParams& p) {
  const bool read = f.reading();
  f.choice("kind", node_kind_names(), p.kind);
  f.flag("hold", p.hold);
  f.number({"constant_speed", D::angular_speed, D::speed}, p.constant_speed);
  f.number({"nominal_speed", D::angular_speed, D::speed}, p.nominal_speed);
  f.number({"nominal_angle", D::angle, "nominal_position", D::length}, p.nominal_angle);
  if (read || p.has_run_up)
    p.has_run_up |= f.group("run_up", [&](Fields& g) {
      g.number({"speed_0", D::angular_speed, D::speed}, p.run_up.speed_0, Need::required);
      g.number({"speed_1", D::angular_speed, D::speed}, p.run_up.speed_1, Need::required);
      g.number({"time_0", D::time}, p.run_up.time_0);
      g.number({"time_1", D::time}, p.run_up.time_1, Need::required);
    });
  if (read || p.has_given)
    p.has_given |= f.group("given_motion", [&](Fields& g) {
      g.number({"amplitude", D::angle, D::length}, p.given.amplitude, Need::required);
      g.number({"frequency", D::frequency}, p.given.frequency, Need::required);
      g.number({"phase", D::angle}, p.given.phase);
      g.number({"offset", D::angle, D::length}, p.given.offset);
    });
  f.number({"initial_angle", D::angle, "initial_position", D::length}, p.initial_value);
  f.number({"initial_speed", D::angular_speed, "initial_velocity", D::speed}, p.initial_rate);
}

}  // namespace drev::app
