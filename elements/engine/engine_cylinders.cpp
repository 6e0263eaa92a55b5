#include <drev/core/element.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/engine/engine_cylinders.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace drev {

namespace {

double cycle(int strokes) { return strokes == 2 ? kTwoPi : 2.0 * kTwoPi; }

}  // namespace

EngineCylinders::EngineCylinders(Params params)
    : params_(std::move(params)),
      crank_{0.5 * params_.stroke, params_.rod},
      area_(0.25 * kPi * params_.bore * params_.bore),
      mean_inertia_(params_.oscillating_mass * crank_.mean_square()),
      gas_(params_.gas, cycle(params_.strokes)) {
  for (std::size_t k = 0; k < params_.firing_angles.size(); ++k)
    cylinders_.emplace_back(*this, static_cast<int>(k));
  constexpr int kAngles = 720;
  constexpr double kBetween = 1.01;  // of a curve as smooth as this, between as many
  for (int i = 0; i < kAngles; ++i) {
    const CrankSlider::Derivatives x = crank_.at(kTwoPi * i / kAngles);
    most_by_speed_squared_ =
        std::max(most_by_speed_squared_, kBetween * std::abs(params_.oscillating_mass * x.first * x.second));
  }
}

namespace {

/// The numbers of cylinders in a firing order; none where it cannot be read.
std::vector<int> firing_sequence(const std::string& order) {
  std::vector<int> sequence;
  bool readable = !order.empty();
  for (std::size_t i = 0; readable && i <= order.size();) {
    int number = 0;
    const auto result = std::from_chars(order.data() + i, order.data() + order.size(), number);
    i = static_cast<std::size_t>(result.ptr - order.data());
    readable = result.ec == std::errc{} && (i == order.size() || order[i] == '-');
    sequence.push_back(number);
    ++i;
  }
  std::vector<int> sorted = sequence;
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t k = 0; k < sorted.size(); ++k) readable = readable && sorted[k] == static_cast<int>(k) + 1;
  return readable ? sequence : std::vector<int>{};
}

}  // namespace

std::string EngineCylinders::why_no_order(const std::string& order) {
  return firing_sequence(order).empty()
             ? "must name each cylinder from 1 on once, separated by '-', as in 1-5-3-6-2-4"
             : "";
}

std::size_t EngineCylinders::cylinders_of(const std::string& order) {
  std::size_t count = 0;
  bool inside = false;
  for (const char c : order) {
    const bool digit = c >= '0' && c <= '9';
    count += digit && !inside ? 1 : 0;
    inside = digit;
  }
  return count;
}

std::vector<double> EngineCylinders::even_firing(const std::string& order, int strokes, double first) {
  const std::vector<int> sequence = firing_sequence(order);
  if (const std::string why = why_no_order(order); !why.empty())
    throw ModelError({{"engine", "firing_order", order, "", why}});
  std::vector<double> angles(sequence.size());
  const double interval = cycle(strokes) / static_cast<double>(sequence.size());
  for (std::size_t i = 0; i < sequence.size(); ++i)
    angles[static_cast<std::size_t>(sequence[i] - 1)] = first + interval * static_cast<double>(i);
  return angles;
}

void EngineCylinders::check(ParameterCheck& check) const {
  const Params& p = params_;
  check.positive("bore", p.bore, "m");
  check.positive("stroke", p.stroke, "m");
  check.positive("rod", p.rod, "m");
  if (p.rod <= 0.6 * p.stroke)
    check.fail("rod", to_text(p.rod), "m",
               "must be longer than 0.6 stroke, " + to_text(0.6 * p.stroke) + " m");
  check.non_negative("oscillating_mass", p.oscillating_mass, "kg");
  check.non_negative("rotating_mass", p.rotating_mass, "kg");
  check.finite("crankcase_pressure", p.crankcase_pressure, "Pa");
  check.finite("mean_tangential_pressure", p.mean_tangential_pressure, "Pa");
  if (p.strokes != 2 && p.strokes != 4)
    check.fail("strokes", std::to_string(p.strokes), "", "must be 2 or 4");
  check.all_finite("firing_angles", p.firing_angles, "rad");
  if (!p.unread_firing_order.empty())
    check.fail("firing_order", p.unread_firing_order, "", why_no_order(p.unread_firing_order));
  if (p.firing_angles.empty()) check.fail("firing_angles", "none", "rad", "each cylinder needs one");
  if (!gas_.empty() || !p.gas.pressure.empty()) gas_.check(check);
  if (gas_.empty() && p.gas.firing.gated())
    check.fail("speed_ramp", to_text(p.gas.firing.speed_ramp), "rad/s",
               "needs curves of pressure: harmonics do not tell the compression");
  check_harmonics(check, "tangential_pressure", p.tangential_pressure, "Pa", false);
  if (p.varying_inertia && !p.twist_feedback)
    check.fail("varying_inertia", "true", "", "needs twist_feedback: it follows the actual angle");
  const bool tangential = !p.tangential_pressure.empty() || p.mean_tangential_pressure != 0.0;
  if (tangential && !gas_.empty())
    check.fail("tangential_pressure", "given", "",
               "must not be given together with pressure; give one of them");
  const int count = static_cast<int>(p.firing_angles.size());
  if (p.misfiring_cylinder < 0 || p.misfiring_cylinder > count)
    check.fail("misfiring_cylinder", std::to_string(p.misfiring_cylinder), "",
               "must be the number of a cylinder, 1 to " + std::to_string(count) + ", or 0 for none");
  if (p.misfiring_cylinder > 0 && tangential)
    check.fail("misfiring_cylinder", std::to_string(p.misfiring_cylinder), "",
               "needs curves of pressure: harmonics do not tell the compression");
}

void EngineCylinders::describe(int nodes, Terms& terms) const {
  double inertia = params_.rotating_mass * crank_.radius * crank_.radius;
  if (params_.mean_oscillating_inertia || params_.varying_inertia) inertia += mean_inertia_;
  const int count = std::min(nodes, static_cast<int>(cylinders_.size()));
  for (int k = 0; k < nodes; ++k) terms.mass(k, k) = inertia;
  for (int k = 0; k < count; ++k)
    terms.loads.push_back(
        {k, &cylinders_[static_cast<std::size_t>(k)], count > 1 ? std::to_string(k + 1) : std::string()});
}

LoadResponse EngineCylinders::Cylinder::evaluate(const LoadInput& in) const {
  const Params& p = engine_.params_;
  if (!p.twist_feedback) {
    const double angle = in.nominal_angle - p.firing_angles[static_cast<std::size_t>(number_)];
    return {.torque = torque(Dual(angle), Dual(in.nominal_speed), in.nominal_speed).value};
  }
  return response_of(in, [&](const Dual& angle, const Dual& speed) {
    const Dual of_gas = in.nominal_speed != 0.0 ? Dual(in.nominal_speed) : speed;
    return torque(angle - p.firing_angles[static_cast<std::size_t>(number_)], speed, of_gas);
  });
}

std::optional<LoadSlopes> EngineCylinders::Cylinder::steepest(const LoadRanges& over) const {
  LoadSlopes slopes{.by_angle = std::numeric_limits<double>::infinity()};
  if (!engine_.params_.twist_feedback) return slopes;
  const double fastest = std::max(std::abs(over.speed.low), std::abs(over.speed.high));
  slopes.by_speed = 2.0 * engine_.most_by_speed_squared_ * fastest;
  // Under a nominal motion the gas follows its speed, and not the actual one.
  if (over.nominal_speed.low > 0.0 || over.nominal_speed.high < 0.0) return slopes;
  const double firing = engine_.params_.firing_angles[static_cast<std::size_t>(number_)];
  const Interval angle{over.angle.low - firing, over.angle.high - firing};
  const double middle = 0.5 * (angle.low + angle.high), half = 0.5 * (angle.high - angle.low);
  const CrankSlider::Derivatives most = engine_.crank_.most();
  const double first = std::min(most.first, std::abs(engine_.crank_.at(middle).first) + half * most.second);
  const double slowest = std::max({0.0, over.speed.low, -over.speed.high});
  slopes.by_speed += engine_.area_ * first *
                     engine_.gas_.steepest_by_speed(angle, {slowest, fastest},
                                                    engine_.params_.misfiring_cylinder == number_ + 1);
  return slopes;
}

Dual EngineCylinders::Cylinder::torque(const Dual& angle, const Dual& speed, const Dual& speed_of_gas) const {
  const Params& p = engine_.params_;
  const CrankSlider::Derivatives d = engine_.crank_.at(angle.value);
  const Dual first = Dual::chain(angle, d.first, d.second), second = Dual::chain(angle, d.second, d.third);
  const Dual inertia = inertia_by_speed_squared(first, second) * (speed * speed);
  if (engine_.gas_.empty()) return inertia + tangential(angle);
  const GasPressure::Point gas =
      engine_.gas_.at(angle.value, speed_of_gas.value, p.misfiring_cylinder == number_ + 1);
  const Dual pressure = gas.pressure + (angle - angle.value) * gas.angle_slope +
                        (speed_of_gas - speed_of_gas.value) * gas.speed_slope;
  return inertia + (pressure - p.crankcase_pressure) * by_pressure(first);
}

Dual EngineCylinders::Cylinder::inertia_by_speed_squared(const Dual& first, const Dual& second) const {
  return -engine_.params_.oscillating_mass * second * first;
}

Dual EngineCylinders::Cylinder::by_pressure(const Dual& first) const { return -engine_.area_ * first; }

Dual EngineCylinders::Cylinder::tangential(const Dual& angle) const {
  const Params& p = engine_.params_;
  return engine_.area_ * engine_.crank_.radius *
         (p.mean_tangential_pressure + sum_at(p.tangential_pressure, angle));
}

std::vector<double> EngineCylinders::Cylinder::speed_factors(double speed) const {
  std::vector<double> factors{speed * speed, 1.0};
  if (engine_.gas_.empty()) return factors;
  const std::vector<double> gas = engine_.gas_.factors(speed);
  factors.insert(factors.end(), gas.begin(), gas.end());
  return factors;
}

double EngineCylinders::Cylinder::curve(int k, double angle) const {
  const Params& p = engine_.params_;
  angle -= p.firing_angles[static_cast<std::size_t>(number_)];
  const CrankSlider::Derivatives x = engine_.crank_.at(angle);
  if (k == 0) return inertia_by_speed_squared(x.first, x.second).value;
  if (k > 1)
    return engine_.gas_.curve(k - 2, angle, p.misfiring_cylinder == number_ + 1) * by_pressure(x.first).value;
  if (!engine_.gas_.empty()) return -p.crankcase_pressure * by_pressure(x.first).value;
  return tangential(angle).value;
}

SpeedScaledLoad::Family EngineCylinders::Cylinder::family() const {
  const Params& p = engine_.params_;
  const double start = p.firing_angles[static_cast<std::size_t>(number_)];
  if (p.misfiring_cylinder == number_ + 1) return {this, start};
  return {&engine_, start};
}

CubicPiece EngineCylinders::Cylinder::piece(double angle, double direction, double nominal_speed) const {
  if (engine_.gas_.empty()) return {.terms = {1.0, 0.0, 0.0, 0.0}};
  const Params& p = engine_.params_;
  const double firing = p.firing_angles[static_cast<std::size_t>(number_)];
  CubicPiece found =
      engine_.gas_.piece(angle - firing, direction, nominal_speed, p.misfiring_cylinder == number_ + 1);
  found.low += firing;
  found.high += firing;
  found.terms[0] -= p.crankcase_pressure;
  return found;
}

KnottedLoad::Curves EngineCylinders::Cylinder::curves(double angle) const {
  const Params& p = engine_.params_;
  angle -= p.firing_angles[static_cast<std::size_t>(number_)];
  const CrankSlider::Derivatives x = engine_.crank_.at(angle);
  return {(engine_.gas_.empty() ? tangential(angle) : by_pressure(x.first)).value,
          inertia_by_speed_squared(x.first, x.second).value};
}

int EngineCylinders::Cylinder::turns() const {
  const Params& p = engine_.params_;
  for (const int turns : {1, p.strokes / 2})
    if (std::all_of(p.tangential_pressure.begin(), p.tangential_pressure.end(),
                    [&](const Harmonic& h) { return h.order * turns == std::floor(h.order * turns); }))
      return turns;
  return 0;
}

double EngineCylinders::Cylinder::inertia_beyond(double angle) const {
  const Params& p = engine_.params_;
  const double first = engine_.crank_.at(angle - p.firing_angles[static_cast<std::size_t>(number_)]).first;
  return p.oscillating_mass * first * first - engine_.mean_inertia_;
}

double EngineCylinders::torque(int k, double angle, double speed) const {
  return cylinders_.at(static_cast<std::size_t>(k))
      .evaluate({.nominal_angle = angle, .speed = speed, .nominal_speed = speed})
      .torque;
}

double EngineCylinders::mean_torque(int k, double speed) const {
  constexpr int kPoints = 1 << 16;
  const double period = cycle(params_.strokes);
  double sum = 0.0;
  for (int i = 0; i < kPoints; ++i) sum += torque(k, period * (i + 0.5) / kPoints, speed) / kPoints;
  return sum;
}

}  // namespace drev
