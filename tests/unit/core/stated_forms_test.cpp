// What loads, laws and elements say besides their call (harmonics, knots and curves, curves scaled by the speed,
// frequencies, the formula of a scale, parts) is compared with it by check_element(): each is right once, and is found
// where it is spoilt. Covers core/law/agreement.hpp.
#include <drev/core/element.hpp>
#include <drev/core/law/angle_scaled_force.hpp>
#include <drev/core/law/harmonic_load.hpp>
#include <drev/core/law/knotted_load.hpp>
#include <drev/core/law/piecewise_law.hpp>
#include <drev/core/law/speed_scaled_load.hpp>
#include <drev/core/model.hpp>
#include <drev/core/system.hpp>
#include <drev/core/units.hpp>
#include <drev/core/verify.hpp>
#include <drev/elements/catalogue.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/catch.hpp"
#include "tests/unit/elements/checks.hpp"

using namespace drev;
using namespace drev::test;

namespace {

/// An element of one load.
template <class L>
class LoadOnly : public Element, public L {
 public:
  std::string_view type() const override { return "load of a test"; }
  int min_nodes() const override { return 1; }
  void check(ParameterCheck&) const override {}
  void describe(int, Terms& terms) const override { terms.loads.push_back({0, this}); }
};

/// 3 + 2 cos(theta) + 1.5 sin(2.5 theta).
struct Wave final : LoadOnly<HarmonicLoad> {
  double mean = 3.0;
  std::vector<LoadOrder> stated = {{1.0, 2.0, 0.0}, {2.5, 0.0, 1.5}};
  LoadResponse evaluate(const LoadInput& in) const override {
    const double a = in.nominal_angle + in.deviation;
    return {.torque = 3.0 + 2.0 * std::cos(a) + 1.5 * std::sin(2.5 * a),
            .dtorque_dangle = -2.0 * std::sin(a) + 3.75 * std::cos(2.5 * a)};
  }
  LoadOrders orders() const override { return {mean, stated}; }
};

/// P S + G w^2 with P = 1 + |theta mod 2 pi - pi|, S = 2 + sin(order theta), G = 0.3 cos(theta).
class Ridge final : public LoadOnly<Load>, public KnottedLoad {
 public:
  std::function<void(CubicPiece&)> spoil_piece = {};
  std::function<void(Curves&)> spoil_curves = {};
  int told_turns = 1;
  double order = 1.0;

  LoadResponse evaluate(const LoadInput& in) const override {
    const double a = in.nominal_angle + in.deviation, w = in.speed, u = phase(a) - kPi;
    const double p = 1.0 + std::abs(u), s = 2.0 + std::sin(order * a), g = 0.3 * std::cos(a);
    return {.torque = p * s + g * w * w,
            .dtorque_dangle =
                (u > 0.0 ? 1.0 : -1.0) * s + p * order * std::cos(order * a) - 0.3 * std::sin(a) * w * w,
            .dtorque_dspeed = 2.0 * g * w};
  }
  CubicPiece piece(double angle, double direction, double) const override {
    double u = phase(angle);
    const double near = 1e-12 * std::max(1.0, std::abs(angle));
    if (direction > 0.0 && kTwoPi - u <= near) u -= kTwoPi;
    if (direction < 0.0 && u <= near) u += kTwoPi;
    const bool falls = direction > 0.0 ? u < kPi - near : u <= kPi + near;
    CubicPiece p{.low = angle - (falls ? u : u - kPi), .high = angle + (falls ? kPi : kTwoPi) - u};
    p.terms = {1.0 + std::abs(u - kPi), falls ? -1.0 : 1.0, 0.0, 0.0};
    if (spoil_piece) spoil_piece(p);
    return p;
  }
  bool piece_follows_speed() const override { return false; }
  Curves curves(double angle) const override {
    Curves c{2.0 + std::sin(order * angle), 0.3 * std::cos(angle)};
    if (spoil_curves) spoil_curves(c);
    return c;
  }
  int turns() const override { return told_turns; }

 private:
  static double phase(double angle) { return angle - kTwoPi * std::floor(angle / kTwoPi); }
};

/// w^2 sin(theta) + 5 cos(2 theta), by two curves.
class Scaled final : public LoadOnly<Load>, public SpeedScaledLoad {
 public:
  double factor = 5.0;
  LoadResponse evaluate(const LoadInput& in) const override {
    const double a = in.nominal_angle + in.deviation, w = in.speed;
    return {.torque = w * w * std::sin(a) + 5.0 * std::cos(2.0 * a),
            .dtorque_dangle = w * w * std::cos(a) - 10.0 * std::sin(2.0 * a),
            .dtorque_dspeed = 2.0 * w * std::sin(a)};
  }
  std::vector<double> speed_factors(double speed) const override { return {speed * speed, factor}; }
  double curve(int k, double angle) const override {
    return k == 0 ? std::sin(angle) : std::cos(2.0 * angle);
  }
};

/// 7 + 4 sin(2 pi 3 t) + cos(2 pi 0.7 t).
struct Hum final : LoadOnly<Load> {
  std::vector<double> stated = {0.7, 3.0};
  LoadResponse evaluate(const LoadInput& in) const override {
    return {.torque = 7.0 + 4.0 * std::sin(kTwoPi * 3.0 * in.t) + std::cos(kTwoPi * 0.7 * in.t)};
  }
  bool depends_on_motion() const override { return false; }
  std::vector<double> frequencies() const override { return stated; }
};

/// 2 cos(5 theta) - 0.3 w |w| + sin(40 t), with bounds of its slopes.
struct Fan final : LoadOnly<Load> {
  double by_angle = 10.0, by_speed = 0.6, by_time = 40.0;
  LoadResponse evaluate(const LoadInput& in) const override {
    const double a = in.nominal_angle + in.deviation, w = in.speed;
    return {.torque = 2.0 * std::cos(5.0 * a) - 0.3 * w * std::abs(w) + std::sin(40.0 * in.t),
            .dtorque_dangle = -10.0 * std::sin(5.0 * a),
            .dtorque_dspeed = -0.6 * std::abs(w)};
  }
  std::optional<LoadSlopes> steepest(const LoadRanges& over) const override {
    return LoadSlopes{by_time, by_angle,
                      by_speed * std::max(std::abs(over.speed.low), std::abs(over.speed.high))};
  }
};

/// k r(theta) x with r = 1 + 0.2 cos(3 theta), k = 50 N m/rad.
class Pulsating final : public Element, public ScalarForce, public AngleScaledForce {
 public:
  double share = 0.2, offset = 0.0, reach = 1e9;

  std::string_view type() const override { return "pulsating spring"; }
  int min_nodes() const override { return 2; }
  void check(ParameterCheck&) const override {}
  void describe(int nodes, Terms& terms) const override {
    terms.scalars.push_back({.b = relative_motion(nodes), .force = this, .phase_node = 0});
    terms.speed_ratio_constraints.push_back({.b = relative_motion(nodes)});
  }
  ScalarResponse evaluate(const ScalarInput& in) const override {
    return law_.evaluate(in.x, in.x_dot, pieces_scale(in.angle), -0.6 * std::sin(3.0 * in.angle));
  }
  bool varies() const override { return true; }
  double closed_stiffness() const override { return law_.closed_stiffness(); }
  std::span<const LawPiece> pieces() const override { return law_.pieces(); }
  double pieces_scale(double angle) const override { return 1.0 + 0.2 * std::cos(3.0 * angle); }
  ScaleStretch scale_stretch(double angle, double) const override {
    orders_[0].cosine = share;
    return {.value = 1.0 + offset, .low = angle - reach, .high = angle + reach, .orders = orders_};
  }
  mutable std::vector<ScaleOrder> orders_ = {{3.0, 0.2, 0.0}};

 private:
  PiecewiseLaw law_{{{0.0, 50.0, 0.0, 0.0, 50.0, {}}}};
};

/// Two springs in a row over three nodes, as a whole and as two parts.
class Row final : public Element {
 public:
  double of_parts = 100.0;
  int last_node = 2;
  bool part_reports = false;

  std::string_view type() const override { return "row of springs"; }
  int min_nodes() const override { return 3; }
  void check(ParameterCheck&) const override {}
  void describe(int, Terms& terms) const override {
    terms.stiffness << 100.0, -100.0, 0.0, -100.0, 200.0, -100.0, 0.0, -100.0, 100.0;
    for (int i = 0; i < 2; ++i) {
      LocalRow b = LocalRow::Zero(3);
      b[i] = -1.0, b[i + 1] = 1.0;
      terms.speed_ratio_constraints.push_back({.b = b});
    }
  }
  int part_count() const override { return 2; }
  std::vector<int> part_nodes(int part) const override { return {part, part == 1 ? last_node : 1}; }
  void describe_part(int, Terms& terms) const override {
    terms.stiffness << of_parts, -of_parts, -of_parts, of_parts;
    if (part_reports)
      terms.outputs.push_back({.suffix = {}, .stiffness = relative_motion(2), .damping = LocalRow::Zero(2)});
  }
};

template <class E>
std::string report_of(const std::function<void(E&)>& spoil, int nodes) {
  E element;
  if (spoil) spoil(element);
  return check_element(element, nodes).text();
}

}  // namespace

TEST_CASE("Harmonics of a load that are not its torque are found") {
  CHECK(report_of<Wave>({}, 1) == "");
  CHECK(contains(report_of<Wave>([](Wave& w) { w.mean = 3.001; }, 1), "orders: gives torque = "));
  CHECK(contains(report_of<Wave>([](Wave& w) { w.stated[1].sine = -1.5; }, 1), "orders: gives torque = "));
  CHECK(contains(report_of<Wave>([](Wave& w) { w.stated.pop_back(); }, 1), "orders: gives torque = "));
}

TEST_CASE("Knots and curves of a load that are not its torque are found") {
  CHECK(report_of<Ridge>({}, 1) == "");
  const auto piece = [](std::function<void(CubicPiece&)> spoil) {
    return report_of<Ridge>([&](Ridge& r) { r.spoil_piece = spoil; }, 1);
  };
  CHECK(contains(piece([](CubicPiece& p) { p.terms[1] *= 1.01; }), "piece: gives torque = "));
  CHECK(contains(piece([](CubicPiece& p) { p.terms[3] = 0.01; }), "piece: gives torque = "));
  CHECK(contains(piece([](CubicPiece& p) { p.high += 0.5; }), "piece: gives torque = "));
  CHECK(contains(piece([](CubicPiece& p) { p.low = p.high; }), "piece: reaches from "));
  const auto curves = [](std::function<void(KnottedLoad::Curves&)> spoil) {
    return report_of<Ridge>([&](Ridge& r) { r.spoil_curves = spoil; }, 1);
  };
  CHECK(contains(curves([](auto& c) { c.factor *= 1.001; }), "piece: gives torque = "));
  CHECK(contains(curves([](auto& c) { c.by_speed_squared = 0.3; }), "piece: gives torque = "));
  const auto slow = [](int turns) {
    return report_of<Ridge>([=](Ridge& r) { r.order = 0.5, r.told_turns = turns; }, 1);
  };
  CHECK(slow(2) == "");
  CHECK(contains(slow(1), "curves: factor is "));
  // Curves of no period: only the ends of the pieces are compared.
  CHECK(report_of<Ridge>([](Ridge& r) { r.told_turns = 0; }, 1) == "");
}

TEST_CASE("Curves scaled by the speed that are not the torque are found") {
  CHECK(report_of<Scaled>({}, 1) == "");
  CHECK(contains(report_of<Scaled>([](Scaled& s) { s.factor = 5.01; }, 1), "speed_factors: gives torque = "));
}

TEST_CASE("Frequencies that do not make up a load are found") {
  CHECK(report_of<Hum>({}, 1) == "");
  CHECK(contains(report_of<Hum>([](Hum& h) { h.stated = {3.0}; }, 1), "frequencies: leave "));
  CHECK(contains(report_of<Hum>([](Hum& h) { h.stated = {0.7, 3.1}; }, 1), "frequencies: leave "));
}

TEST_CASE("Bounds of a load's slopes that it exceeds are found") {
  CHECK(report_of<Fan>({}, 1) == "");
  CHECK(
      contains(report_of<Fan>([](Fan& f) { f.by_angle = 9.0; }, 1), "steepest: bounds dtorque_dangle by 9"));
  CHECK(contains(report_of<Fan>([](Fan& f) { f.by_speed = 0.5; }, 1), "steepest: bounds dtorque_dspeed by "));
  CHECK(contains(report_of<Fan>([](Fan& f) { f.by_time = 30.0; }, 1),
                 "steepest: bounds the slope by the time by 30"));
}

TEST_CASE("The formula of a law's scale that is not the scale is found") {
  CHECK(report_of<Pulsating>({}, 2) == "");
  CHECK(contains(report_of<Pulsating>([](Pulsating& p) { p.share = 0.21; }, 2),
                 "scale_stretch: gives a scale of "));
  CHECK(contains(report_of<Pulsating>([](Pulsating& p) { p.offset = 0.01; }, 2),
                 "scale_stretch: gives a scale of "));
  CHECK(contains(report_of<Pulsating>([](Pulsating& p) { p.reach = -1.0; }, 2),
                 "scale_stretch: reaches from "));
}

TEST_CASE("Parts of an element that are not its description are found") {
  CHECK(report_of<Row>({}, 3) == "");
  CHECK(contains(report_of<Row>([](Row& r) { r.of_parts = 101.0; }, 3),
                 "parts: sum to another stiffness matrix than describe()'s: off by 2"));
  CHECK(
      contains(report_of<Row>([](Row& r) { r.last_node = 0; }, 3), "parts: sum to another stiffness matrix"));
  CHECK(contains(report_of<Row>([](Row& r) { r.last_node = 3; }, 3),
                 "parts: have nodes that are none of the element's"));
  CHECK(contains(report_of<Row>([](Row& r) { r.part_reports = true; }, 3),
                 "parts: have 2 outputs together, describe() has 0"));
  Model m("parts");
  for (const char* node : {"a", "b", "c"}) m.add_node(node);
  const auto row = std::make_shared<Row>();
  row->last_node = 3;
  m.add("row", {"a", "b", "c"}, row);
  CHECK_THROWS_WITH(m.build(), Catch::Contains("parts/row: part_nodes()") &&
                                   Catch::Contains("must name nodes of the element, 0 to 2"));
  CHECK(check_element(DistributedShaft({.shear_modulus = 8e10,
                                        .density = 7850.0,
                                        .outer_diameter = 0.08,
                                        .length = 2.0,
                                        .segments = 7}),
                      2)
            .text() == "");
}
