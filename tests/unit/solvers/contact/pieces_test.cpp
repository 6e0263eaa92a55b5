// Which piece of a law holds, on ties too, is one rule: for the call that steps use, for lanes and for exact
// propagation.
#include "solvers/contact/pieces.hpp"

#include <drev/core/ids.hpp>
#include <drev/core/law_element.hpp>
#include <drev/core/model.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/batch/simulate_many.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "solvers/batch/lane_laws.hpp"
#include "solvers/exact/law_series.hpp"
#include "tests/catch.hpp"
#include "tests/problems/twist_backlash.hpp"

using namespace drev;

namespace {

struct Stated {
  std::vector<LawPiece> all;
  const std::vector<LawPiece>& pieces() const { return all; }
};

/// Force `below` under x = 0.5 and `above` over it: which piece holds on the edge shows in the force.
Stated jump(double below, double above, bool lower_first) {
  LawPiece low{.y_0 = below, .bounds = {{0.5, -1.0, 0.0, lower_first ? 1 : 0}}};
  LawPiece high{.y_0 = above, .bounds = {{-0.5, 1.0, 0.0, lower_first ? 0 : 1}}};
  return lower_first ? Stated{{low, high}} : Stated{{high, low}};
}

/// The same over x_dot = 0: a dry friction.
Stated friction() {
  return {{{.y_0 = -2.0, .bounds = {{0.0, 0.0, -1.0, 1}}}, {.y_0 = 2.0, .bounds = {{0.0, 0.0, 1.0, 0}}}}};
}

Stated backlash(MeshDamping damping) {
  const BacklashLaw law(
      {.normal_backlash = 1.0, .damping = 3.0, .damping_law = damping, .reference_penetration = 0.25});
  return {law.pieces(200.0)};
}

System with(const Stated& law, double x = 0.0, double x_dot = 0.0) {
  Model m("tie");
  m.add_node("m", NodeKind::translational);
  m.add<Inertia>("mass", {"m"}, {.inertia = 1.0});
  m.add<LawElement<Stated>>("law", {"m"}, law);
  m.set_initial("m", x, x_dot);
  return m.build();
}

/// The force that lanes find where they are led to (x, x_dot), coming from (x_0, x_dot_0).
double lane_force(const System& system, double x_0, double x_dot_0, double x, double x_dot) {
  std::array<const System*, kLanes> systems;
  systems.fill(&system);
  LaneLaws laws(systems);
  LanePointLaws point;
  laws.prepare(point);
  const LaneArray none(1);
  laws.set_compliance(none, 0.0, 0.0);
  LaneRow lambda[1] = {}, iterations, scale;
  scale.v = Lanes{} + 1.0;
  for (const auto& [at, rate] : {std::pair{x_0, x_dot_0}, std::pair{x, x_dot}}) {
    LaneRow z[1], v[1], a[1] = {};
    z[0].v = Lanes{} + at;
    v[0].v = Lanes{} + rate;
    LaneMask open = ~LaneMask{};
    laws.solve({z, v, a, 0.0, 0.0}, 0.0, scale, 1e-9, open, lambda, point, iterations);
  }
  return point.y[0].v[3];
}

}  // namespace

TEST_CASE("Ties: on an edge, and at rest, the call, lanes and exact propagation take the same piece") {
  std::vector<Stated> laws = {jump(1.0, 4.0, true), jump(1.0, 4.0, false), friction()};
  for (const MeshDamping damping :
       {MeshDamping::proportional, MeshDamping::limited, MeshDamping::contact_only, MeshDamping::always})
    laws.push_back(backlash(damping));
  for (const Stated& law : laws) {
    const System system = with(law);
    const ScalarForce& force = *system.scalars().at(0).force;
    LawSeries series(system);
    for (const double x : {-0.75, -0.5, 0.0, 0.5, 0.75})
      for (const double x_dot : {-0.2, 0.0, 0.2}) {
        const LawPiece& p = law.all[idx(piece_at(law.all, x, x_dot))];
        const ScalarResponse r = force.evaluate({.x = x, .x_dot = x_dot});
        INFO("x = " << x << ", x_dot = " << x_dot);
        CHECK(r.y == Approx(p.force(x, x_dot)).margin(1e-12));
        CHECK(r.dy_dx == Approx(p.k + p.product * x_dot));
        CHECK(r.dy_dx_dot == Approx(p.c + p.product * x).margin(1e-12));
        if (is_linear(law.all)) {
          series.locate({{.x = x, .x_dot = x_dot}});
          CHECK(series.piece(0) == piece_at(law.all, x, x_dot));
        }
        // Whichever piece lanes were on before.
        for (const double x_0 : {-2.0, 0.1, 2.0})
          for (const double x_dot_0 : {-9.0, 9.0})
            CHECK(lane_force(system, x_0, x_dot_0, x, x_dot) == Approx(r.y).margin(1e-12));
      }
  }
}

TEST_CASE("Ties: a motion that starts at rest on the edge of a gap is the same by steps, lanes and exactly") {
  // From x = 0.5 the load 5 N presses into k = 200: x = 0.5 + (5/200) (1 - cos w t), w = sqrt(200).
  const double t_end = 0.3, expected = 0.5 + 0.025 * (1.0 - std::cos(std::sqrt(200.0) * t_end));
  Model m("tie");
  m.add_node("m", NodeKind::translational);
  m.add<Inertia>("mass", {"m"}, {.inertia = 1.0});
  m.add<LawElement<Stated>>("law", {"m"}, Stated{BacklashLaw({.normal_backlash = 1.0}).pieces(200.0)});
  m.add<AppliedTorque>("load", {"m"}, {.table = TimeTable({0.0}, {5.0})});
  m.set_initial("m", 0.5, 0.0);
  const System system = m.build();
  State stepped = State::initial(system), exact = State::initial(system);
  simulate(system, {.step = 1e-4, .t_end = t_end}, stepped);
  propagate(system, {.tolerance = 1e-13, .t_end = t_end}, exact);
  CHECK(exact.z[0] == Approx(expected).epsilon(1e-12));
  CHECK(stepped.z[0] == Approx(expected).epsilon(1e-6));
  const ManyResult many =
      simulate_many(kLanes, [&](std::size_t) { return m.build(); }, {.step = 1e-4, .t_end = t_end});
  for (const VariantResult& v : many.variants) {
    CHECK(v.in_lockstep);
    CHECK(v.state.z[0] == Approx(stepped.z[0]).epsilon(1e-13));
  }
}
