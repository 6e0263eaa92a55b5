#include <drev/core/element.hpp>
#include <drev/core/law/orders.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/gear_mesh.hpp>
#include <drev/elements/involute.hpp>

#include <cmath>

namespace drev {

namespace {

constexpr double kRadiusTolerance = 1e-3;  // printed radii are rounded; a tooth too many is more

bool given(double value) { return !std::isnan(value); }

bool agree(double a, double b) { return std::abs(a - b) <= kRadiusTolerance * std::abs(b); }

double radius(double base_radius, double module, int teeth, double pressure_angle) {
  return given(base_radius) ? base_radius : involute_base_radius(module, teeth, pressure_angle);
}

}  // namespace

GearMesh::GearMesh(Params params)
    : params_(std::move(params)),
      law_({.normal_backlash = params_.normal_backlash,
            .damping = params_.damping,
            .damping_law = params_.damping_law,
            .reference_penetration = params_.reference_penetration,
            .stiffening = params_.stiffening}),
      radius_1_(radius(params_.base_radius_1, params_.module, params_.teeth_1, params_.pressure_angle)),
      radius_2_(radius(params_.base_radius_2, params_.module, params_.teeth_2, params_.pressure_angle)),
      teeth_per_radian_(params_.teeth_1 / kTwoPi),
      mean_stiffness_(params_.stiffness.mean()) {
  pieces_ = law_.pieces(mean_stiffness_);
  if (const auto* series = std::get_if<MeshStiffness::Fourier>(&params_.stiffness.law()))
    for (const Harmonic& h : series->harmonics) {
      // cos(n (z_1 theta + 2 pi mesh_phase) + phase)
      const double phase = kTwoPi * h.order * params_.mesh_phase + h.phase, part = h.amplitude / series->mean;
      orders_.push_back({h.order * params_.teeth_1, part * std::cos(phase), -part * std::sin(phase)});
    }
}

CurvePoint GearMesh::stiffness(double angle) const {
  if (orders_.empty()) {
    const CurvePoint k = params_.stiffness.at(phase(angle));
    return {k.value, k.slope * teeth_per_radian_};
  }
  CurvePoint part{1.0, 0.0};
  for_each_order(std::span(orders_), angle, [&](const ScaleOrder& o, double c, double s) {
    part.value += o.cosine * c + o.sine * s;
    part.slope += o.order * (o.sine * c - o.cosine * s);
  });
  return {mean_stiffness_ * part.value, mean_stiffness_ * part.slope};
}

double GearMesh::pieces_scale(double angle) const { return stiffness(angle).value / mean_stiffness_; }

ScaleStretch GearMesh::scale_stretch(double angle, double direction) const {
  const double at = phase(angle);
  const TableStretch k = params_.stiffness.stretch(at, direction);
  return {k.value / mean_stiffness_, k.slope * teeth_per_radian_ / mean_stiffness_,
          angle + (k.low - at) / teeth_per_radian_, angle + (k.high - at) / teeth_per_radian_, orders_};
}

std::optional<double> GearMesh::angle_of(std::optional<double> knot, double angle) const {
  if (!knot) return std::nullopt;
  return angle + (*knot - phase(angle)) / teeth_per_radian_;
}

std::optional<double> GearMesh::next_knot(double angle, double direction) const {
  return angle_of(params_.stiffness.next_knot(phase(angle), direction), angle);
}

std::optional<double> GearMesh::next_offset_knot(double nominal_angle, double direction) const {
  return angle_of(params_.transmission_error.next_knot(phase(nominal_angle), direction), nominal_angle);
}

void GearMesh::check(ParameterCheck& check) const {
  check_radii(check);
  params_.stiffness.check(check, "stiffness");
  law_.check(check);
  params_.transmission_error.check(check, "transmission_error");
  check.finite("mesh_phase", params_.mesh_phase, "mesh periods");
  if (params_.teeth_1 < 0 || params_.teeth_2 < 0)
    check.fail(params_.teeth_1 < 0 ? "teeth_1" : "teeth_2",
               std::to_string(params_.teeth_1 < 0 ? params_.teeth_1 : params_.teeth_2), "",
               "must be > 0 where given");
  if ((params_.stiffness.varies() || params_.transmission_error.varies()) && params_.teeth_1 <= 0)
    check.fail("teeth_1", std::to_string(params_.teeth_1), "",
               "must be given where the stiffness or the transmission error follows the mesh phase");
}

void GearMesh::check_radii(ParameterCheck& check) const {
  const Params& p = params_;
  const bool radii = given(p.base_radius_1) || given(p.base_radius_2);
  const bool teeth = given(p.module) || given(p.pressure_angle);
  if (!radii && !teeth) {
    check.fail("base_radius_1", "NaN", "m",
               "must be given, with base_radius_2; or module, teeth_1, teeth_2 and pressure_angle");
    return;
  }
  if (radii) {
    check.positive("base_radius_1", p.base_radius_1, "m");
    check.positive("base_radius_2", p.base_radius_2, "m");
  }
  if (teeth) {
    check.positive("module", p.module, "m");
    check.positive("teeth_1", p.teeth_1, "");
    check.positive("teeth_2", p.teeth_2, "");
    if (!(p.pressure_angle >= 0.0 && p.pressure_angle < kPi / 2))
      check.fail("pressure_angle", to_text(p.pressure_angle), "rad", "must be >= 0 and < pi/2");
  }
  if (p.internal && radius_2_ <= radius_1_)
    check.fail("base_radius_2", to_text(radius_2_), "m",
               "must exceed base_radius_1, " + to_text(radius_1_) + ", of the gear inside the ring");
  if (!radii) return;
  if (teeth) {
    const double from_1 = involute_base_radius(p.module, p.teeth_1, p.pressure_angle);
    const double from_2 = involute_base_radius(p.module, p.teeth_2, p.pressure_angle);
    if (given(p.base_radius_1) && given(from_1) && !agree(p.base_radius_1, from_1))
      check.fail("base_radius_1", to_text(p.base_radius_1), "m",
                 "contradicts module, teeth_1 and pressure_angle, which give " + to_text(from_1));
    if (given(p.base_radius_2) && given(from_2) && !agree(p.base_radius_2, from_2))
      check.fail("base_radius_2", to_text(p.base_radius_2), "m",
                 "contradicts module, teeth_2 and pressure_angle, which give " + to_text(from_2));
  } else if (p.teeth_1 > 0 && p.teeth_2 > 0 && given(p.base_radius_1) && given(p.base_radius_2) &&
             !agree(p.base_radius_2 * p.teeth_1, p.base_radius_1 * p.teeth_2)) {
    check.fail("base_radius_2", to_text(p.base_radius_2), "m",
               "contradicts base_radius_1 and the teeth, which give " +
                   to_text(p.base_radius_1 * p.teeth_2 / p.teeth_1));
  }
}

void GearMesh::describe(int nodes, Terms& terms) const {
  LocalRow b(nodes);
  b[0] = radius_1_;
  b[1] = params_.internal ? -radius_2_ : radius_2_;
  if (nodes == 3) b[2] = -(b[0] + b[1]);  // all turn together: the mesh does not move
  const bool phased = params_.stiffness.varies() || params_.transmission_error.varies();
  terms.scalars.push_back(
      {.b = b, .force = this, .phase_node = phased ? 0 : -1, .along_line_of_action = true});
  terms.speed_ratio_constraints.push_back({.b = b, .only_in_contact = law_.has_gap()});
}

ScalarResponse GearMesh::evaluate(const ScalarInput& in) const {
  return law_.evaluate(in.x, in.x_dot, stiffness(in.angle));
}

Offset GearMesh::offset(double nominal_angle) const {
  const CurvePoint e = params_.transmission_error.at(phase(nominal_angle));
  return {e.value, e.slope * teeth_per_radian_};
}

void LateralGearMesh::check(ParameterCheck& check) const { mesh_.check(check); }

void LateralGearMesh::describe(int nodes, Terms& terms) const {
  Terms pair(2);
  mesh_.describe(2, pair);
  for (ScalarSpec& scalar : pair.scalars) {
    const LocalRow gears = scalar.b;
    scalar.b = LocalRow::Zero(nodes);
    scalar.b.head(2) = gears;
    scalar.b[2] = 1.0;
    scalar.b[3] = gears[1] < 0.0 ? -1.0 : 1.0;
    terms.scalars.push_back(scalar);
  }
  for (SpeedRatioConstraint& tie : pair.speed_ratio_constraints) {
    const LocalRow gears = tie.b;
    tie.b = LocalRow::Zero(nodes);
    tie.b.head(2) = gears;
    terms.speed_ratio_constraints.push_back(tie);
  }
  for (const Eigen::Index centre : {2, 3}) {  // no nominal motion, and no stiffness by that
    LocalRow alone = LocalRow::Zero(nodes);
    alone[centre] = 1.0;
    terms.speed_ratio_constraints.push_back({.b = alone, .ratio_only = true});
  }
}

}  // namespace drev
