// What an element says twice and differently is refused with the place: when the model is built, and by
// check_element(), which looks everywhere.
#include "core/contradictions.hpp"

#include <drev/core/ids.hpp>
#include <drev/core/law_element.hpp>
#include <drev/core/model.hpp>
#include <drev/core/system.hpp>
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

/// A dead zone of +-0.1, k = 200, damper 3 in contact, whose call and pieces can be spoilt.
struct DeadZone {
  double k_of_pieces = 200.0;
  std::function<void(std::vector<LawPiece>&)> spoil = {};
  std::function<void(const ScalarInput&, ScalarResponse&)> spoil_call = {};
  std::vector<double> told_kinks = {-0.1, 0.1};
  Gap told_gap = {-0.1, 0.1};
  double told_stiffness = 200.0, told_damping = 3.0;

  ScalarResponse operator()(const ScalarInput& in) const {
    const double p = in.x - std::clamp(in.x, -0.1, 0.1), k = 200.0, c = p != 0.0 ? 3.0 : 0.0;
    ScalarResponse r{.y = k * p + c * in.x_dot,
                     .dy_dx = p != 0.0 ? k : 0.0,
                     .dy_dx_dot = c,
                     .stored_energy = 0.5 * k * p * p,
                     .dissipated_power = c * in.x_dot * in.x_dot};
    if (spoil_call) spoil_call(in, r);
    return r;
  }
  std::vector<LawPiece> pieces() const {
    const double k = k_of_pieces, b = 0.1;
    std::vector<LawPiece> all = {{.bounds = {{b, -1.0, 0.0, 1}, {b, 1.0, 0.0, 2}}},
                                 {-k * b, k, 3.0, -k * b, k, {{-b, 1.0, 0.0, 0}}},
                                 {k * b, k, 3.0, k * b, k, {{-b, -1.0, 0.0, 0}}}};
    if (spoil) spoil(all);
    return all;
  }
  std::span<const double> kinks() const { return told_kinks; }
  std::optional<Gap> gap() const { return told_gap; }
  double closed_stiffness() const { return told_stiffness; }
  double closed_damping() const { return told_damping; }
};

std::string report(DeadZone law) { return check_element(LawElement<DeadZone>(std::move(law)), 2).text(); }

/// y = k (1 + 0.3 sin(50 t)) x.
template <bool stated>
struct Pulsating {
  static constexpr bool varies = stated;
  ScalarResponse operator()(const ScalarInput& in) const {
    const double k = 1e3 * (1.0 + 0.3 * std::sin(50.0 * in.t));
    return {.y = k * in.x, .dy_dx = k, .stored_energy = 0.5 * k * in.x * in.x};
  }
};

template <class Law>
std::string refusal(Law law) {
  Model m("contradictory");
  m.add_node("m", NodeKind::translational);
  m.add<Inertia>("mass", {"m"}, {.inertia = 1.0});
  m.add<LawElement<Law>>("stop", {"m"}, std::move(law));
  try {
    m.build();
  } catch (const ModelError& e) {
    return e.what();
  }
  return "";
}

/// y = 7 (x - 0.5) beyond 0.5, and a gap that a test tells.
struct Stop {
  Gap told;
  template <class T>
  T force(const T& x, const T&) const {
    return x > 0.5 ? 7.0 * (x - 0.5) : T(0.0);
  }
  double stored_energy(double x) const { return x > 0.5 ? 3.5 * (x - 0.5) * (x - 0.5) : 0.0; }
  double edge = 0.5;
  std::span<const double> kinks() const { return {&edge, 1}; }
  std::optional<Gap> gap() const { return told; }
};

/// A saw tooth of period 2, -1 at 0 and 1 at 1, with the table and the stretch that a test gives it.
class Saw final : public Element, public Load {
 public:
  Saw(std::optional<LoadTable> table, std::function<std::optional<LoadStretch>(double)> stretch)
      : table_(table), stretch_(std::move(stretch)) {}
  std::string_view type() const override { return "saw"; }
  int min_nodes() const override { return 1; }
  void check(ParameterCheck&) const override {}
  void describe(int, Terms& terms) const override { terms.loads.push_back({0, this}); }
  LoadResponse evaluate(const LoadInput& in) const override {
    const double u = in.nominal_angle + in.deviation, w = u - 2.0 * std::floor(0.5 * u);
    return {.torque = w < 1.0 ? 2.0 * w - 1.0 : 3.0 - 2.0 * w, .dtorque_dangle = w < 1.0 ? 2.0 : -2.0};
  }
  std::optional<LoadTable> table() const override { return table_; }
  std::optional<LoadStretch> stretch(double t, double angle, double direction) const override {
    return stretch_ ? stretch_(angle) : Load::stretch(t, angle, direction);
  }

 private:
  std::optional<LoadTable> table_;
  std::function<std::optional<LoadStretch>(double)> stretch_;
};

const double kArguments[] = {0.0, 1.0}, kValues[] = {-1.0, 1.0}, kSlopes[] = {2.0, -2.0};
const LoadTable kTable{
    .arguments = kArguments, .values = kValues, .slopes = kSlopes, .period = 2.0, .evenly_spaced = true};

std::string report(const LoadTable& table) { return check_element(Saw(table, {}), 1).text(); }

std::string refusal(std::optional<LoadTable> table,
                    std::function<std::optional<LoadStretch>(double)> stretch) {
  Model m("contradictory");
  m.add_node("m");
  m.add<Inertia>("J", {"m"}, {.inertia = 1.0});
  m.add("saw", {"m"}, std::make_shared<Saw>(table, std::move(stretch)));
  try {
    m.build();
  } catch (const ModelError& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST_CASE("A sound law with pieces beside its call passes") {
  CHECK(report(DeadZone{}) == "");
  CHECK(refusal(DeadZone{}) == "");
}

TEST_CASE("A law whose pieces have another stiffness than its call is refused with the place") {
  const DeadZone law{.k_of_pieces = 250.0};
  CHECK(contains(report(law), "pieces: piece 1 gives y = "));
  CHECK(contains(report(law), ", the call "));
  CHECK(contains(report(law), " at x = "));
  CHECK(contains(report(law), ", x_dot = "));
  const std::string why = refusal(law);
  CHECK(contains(why, "contradictory/stop: describe(): law 0, pieces = piece 1 gives y = "));
  CHECK(contains(why, "must agree with its call"));
}

TEST_CASE("Each quantity of a piece that contradicts the call is found") {
  const auto spoilt = [](auto f) {
    return report(DeadZone{.spoil = [f](std::vector<LawPiece>& all) { f(all[2]); }});
  };
  CHECK(contains(spoilt([](LawPiece& p) { p.c = 4.0; }), "piece 2 gives y = "));
  CHECK(contains(spoilt([](LawPiece& p) { p.elastic_k = 150.0; }), "piece 2 gives dissipated_power = "));
  CHECK(contains(spoilt([](LawPiece& p) { p.product = 0.1; }), "piece 2 gives y = "));
  CHECK(contains(spoilt([](LawPiece& p) { p.bounds[0].next = 3; }), "leads to piece 3, which is none"));
  CHECK(contains(refusal(DeadZone{.spoil = [](auto& all) { all[0].bounds[1].next = -1; }}),
                 "leads to piece -1"));
  const auto called = [](auto f) { return report(DeadZone{.spoil_call = f}); };
  CHECK(contains(
      called([](const ScalarInput& in, ScalarResponse& r) { r.dy_dx = in.x > 0.1 ? 190.0 : r.dy_dx; }),
      "piece 1 gives dy_dx = 200, the call 190"));
  CHECK(contains(
      called([](const ScalarInput& in, ScalarResponse& r) { r.dy_dx_dot *= in.x > 0.1 ? 2.0 : 1.0; }),
      "piece 1 gives dy_dx_dot = 3, the call 6"));
  CHECK(contains(called([](const ScalarInput&, ScalarResponse& r) { r.stored_energy *= 1.1; }),
                 "gives stored_energy = "));
}

TEST_CASE("Pieces that overlap, leave a hole or have a bound elsewhere are found") {
  const auto bound = [](int piece, double a) {
    return report(DeadZone{.spoil = [=](std::vector<LawPiece>& all) { all[idx(piece)].bounds[0].a = a; }});
  };
  CHECK(contains(bound(1, -0.09), "2 of them hold at x = "));
  CHECK(contains(bound(1, -0.11), "0 of them hold at x = "));
  // Gap and flank both change at 0.1001 where the call changes at 0.1.
  CHECK(contains(report(DeadZone{.spoil =
                                     [](std::vector<LawPiece>& all) {
                                       all[0].bounds[0].a = 0.1001;
                                       all[1].bounds[0].a = -0.1001;
                                     }}),
                 "piece 0 gives y = 0, the call "));
}

TEST_CASE("Kinks, gap and closed slopes that contradict the pieces are found") {
  CHECK(contains(report(DeadZone{.told_kinks = {-0.1}}), "kinks: none is stated at x = 0.1"));
  CHECK(contains(report(DeadZone{.told_kinks = {-0.1, 0.1, 0.2}}), "kinks: one is stated at x = 0.2"));
  CHECK(contains(report(DeadZone{.told_gap = {-0.1, 0.09}}),
                 "gap: the pieces have -0.1 to 0.1, stated is -0.1 to 0.09"));
  CHECK(contains(report(DeadZone{.told_stiffness = 300.0}),
                 "closed_stiffness: 300 is stated, the pieces have 0 to 200"));
  CHECK(contains(report(DeadZone{.told_damping = 4.0}), "closed_damping: 4 is stated"));
}

TEST_CASE("A gap that contradicts the call of a law without pieces is found") {
  const auto with = [](double high) {
    return check_element(LawElement<Stop>(Stop{{-std::numeric_limits<double>::infinity(), high}}), 2).text();
  };
  CHECK(with(0.5) == "");
  CHECK(contains(with(0.6), "gap: the call gives y = "));
  CHECK(contains(with(0.4), "gap: the call gives y = 0 beyond it"));
}

TEST_CASE("A law whose energy follows the time must say so") {
  const std::string text = refusal(Pulsating<false>());
  CHECK(contains(text, "law 0, varies = not stated, but the stored energy is 0.0005 J at t = 0 s and"));
  CHECK(contains(text, "at t = 0.001 s at x = 0.001"));
  CHECK(refusal(Pulsating<true>()) == "");
  CHECK(check_element(LawElement<Pulsating<true>>({}), 2).text() == "");
}

TEST_CASE("A load's table is its stretch, and contradictions with the call are refused") {
  CHECK(report(kTable) == "");
  CHECK(refusal(kTable, {}) == "");
  const std::optional<LoadStretch> s = Saw(kTable, {}).stretch(0.0, 2.25, 1.0);
  REQUIRE(s);
  CHECK(s->torque == Approx(-0.5));
  CHECK(s->angle_slope == 2.0);
  CHECK(s->low == Approx(2.0));
  CHECK(s->high == Approx(3.0));

  const double other[] = {-1.0, 1.5}, steeper[] = {2.5, -2.5};
  LoadTable wrong = kTable;
  wrong.values = other;
  CHECK(
      contains(report(wrong), "table: knot 0 at 0 rad: slope 2 N m/rad, but the values rise by 2.5 N m/rad"));
  wrong.slopes = steeper;
  CHECK(contains(report(wrong), "table: gives a torque of "));
  CHECK(contains(refusal(wrong, {}), "contradictory/saw: describe(): load 0, table = gives a torque of "));
  wrong = kTable;
  wrong.phase = 0.1;
  CHECK(contains(report(wrong), "table: gives a torque of "));
  const double uneven[] = {0.0, 1.4};
  wrong = kTable;
  wrong.arguments = uneven;
  CHECK(contains(report(wrong), "rad: "));
}

TEST_CASE("A load's own stretch that contradicts the call is refused") {
  const auto report_stretch = [](std::function<std::optional<LoadStretch>(double)> f) {
    return check_element(Saw({}, std::move(f)), 1).text();
  };
  const auto right = [](double angle) { return kTable.stretch(angle, 1.0); };
  CHECK(report_stretch(right) == "");
  CHECK(contains(report_stretch([&](double angle) {
                   LoadStretch s = right(angle);
                   s.high += 0.5;
                   return s;
                 }),
                 "stretch: gives a torque of "));
  CHECK(contains(report_stretch([&](double angle) {
                   LoadStretch s = right(angle);
                   s.time_slope = 1.0;
                   return s;
                 }),
                 "stretch: gives a torque of "));
  CHECK(contains(report_stretch([&](double angle) {
                   LoadStretch s = right(angle);
                   s.low = angle + 0.1;
                   return s;
                 }),
                 "stretch: reaches from "));
  CHECK(contains(report_stretch([&](double angle) -> std::optional<LoadStretch> {
                   if (angle > 5.0) return std::nullopt;
                   return right(angle);
                 }),
                 "stretch: is stated at"));
  CHECK(contains(refusal({}, [](double) { return LoadStretch{.torque = 3.0}; }),
                 "contradictory/saw: describe(): load 0, stretch = gives a torque of 3, the call "));
}
