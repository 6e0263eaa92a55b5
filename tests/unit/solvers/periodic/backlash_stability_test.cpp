// Stability of periodic motions through a clearance for each damping law, whose pieces end at bounds in x and x', and
// heat of rubber beside it. Multipliers are those of a separate program: SciPy's DOP853 (relative tolerance 1e-13) for
// the motion and the variational equation, restarted at each located bound of the law, with the saltation matrix where
// the force jumps, and Newton's method for the periodic motion.
// Covers solvers/periodic/floquet.hpp, law_balance.hpp and motion_sections.hpp through sweep_nonlinear().
#include <drev/core/law_element.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/nonlinear_sweep.hpp>

#include <algorithm>
#include <cmath>
#include <complex>

#include "tests/catch.hpp"
#include "tests/problems/driven_gear.hpp"

using namespace drev;

namespace {

/// 2 x'' + 2 F(x, x') = mean + 100 cos wt Nm about 600 rpm: two inertias of 1 kg m^2 with a gap of 0.01 rad.
System loose_pair(MeshDamping law, double damping) {
  Model m("loose pair");
  m.add_node("a");
  m.add_node("b");
  m.set_reference("a", constant_speed(rpm(600)));
  m.add<Inertia>("J_a", {"a"}, {.inertia = 1.0});
  m.add<Inertia>("J_b", {"b"}, {.inertia = 1.0});
  m.add<DeadBandCoupling>("s", {"a", "b"},
                          {.stiffness = 1000.0, .gap = 0.01, .damping = damping, .damping_law = law});
  m.add<EngineOrderTorque>(
      "t", {"a"}, {.harmonics = {{.order = 1.0, .amplitude = 100.0}}, .mean = 10.0, .twist_feedback = false});
  m.add<EngineOrderTorque>("load", {"b"}, {.mean = -10.0, .twist_feedback = false});
  return m.build();
}

/// Of the motion on a curve asked for at a speed [rad/s] whose multiplier is nearest to `expected`.
const SweptMotion& nearest_motion(const NonlinearSweep& sweep, double speed, double expected) {
  const SweptMotion* best = nullptr;
  for (const SweptBranch& branch : sweep.branches)
    for (const SweptMotion& motion : branch.motions)
      if (std::abs(motion.speed - speed) < 1e-9 * speed &&
          (best == nullptr || std::abs(motion.multiplier - expected) < std::abs(best->multiplier - expected)))
        best = &motion;
  REQUIRE(best != nullptr);
  return *best;
}

/// y = x + c max(x', 0), which does not state where its slope jumps.
struct OneWayDamper {
  double c;
  template <class T>
  T force(const T& x, const T& x_dot) const {
    return x_dot > 0.0 ? x + c * x_dot : x + 0.0 * x_dot;
  }
};

}  // namespace

TEST_CASE("Motions through both flanks of a loose pair are stable, with the multipliers of shooting",
          "[nonlinear_sweep]") {
  struct Row {
    MeshDamping law;
    double damping, at_590, at_600;
  };
  for (const Row& row : {Row{MeshDamping::limited, 0.1, 0.990615479, 0.990824123},
                         {MeshDamping::limited, 1.0, 0.913299434, 0.915223016},
                         {MeshDamping::limited, 3.0, 0.779984835, 0.784880398},
                         {MeshDamping::contact_only, 0.1, 0.990595668, 0.990804307},
                         {MeshDamping::contact_only, 1.0, 0.911477162, 0.913397332},
                         {MeshDamping::contact_only, 3.0, 0.766239970, 0.771062730},
                         {MeshDamping::proportional, 0.1, 0.990604370, 0.990813529},
                         {MeshDamping::proportional, 1.0, 0.911557372, 0.913482486},
                         {MeshDamping::proportional, 3.0, 0.766443624, 0.771279676}}) {
    const NonlinearSweep sweep =
        sweep_nonlinear(loose_pair(row.law, row.damping), {.speeds = {rpm(590), rpm(600)}, .runs = false});
    INFO("law " << static_cast<int>(row.law) << ", damping " << row.damping);
    CHECK(sweep.changes.empty());
    REQUIRE(sweep.branches.size() == 1);
    for (const SweptMotion& motion : sweep.branches[0].motions) CHECK(motion.stable);
    CHECK(nearest_motion(sweep, rpm(590), row.at_590).multiplier == Approx(row.at_590).margin(1e-7));
    CHECK(nearest_motion(sweep, rpm(600), row.at_600).multiplier == Approx(row.at_600).margin(1e-7));
  }
}

TEST_CASE(
    "One inertia on a dead-band coupling with its default law is stable, with the multiplier of shooting",
    "[nonlinear_sweep]") {
  Model m("one inertia");
  m.add_node("w");
  m.add_node("a");
  m.constant_speed("w", rpm(600));
  m.add<Inertia>("J", {"a"}, {.inertia = 1.0});
  m.add<DeadBandCoupling>("s", {"w", "a"}, {.stiffness = 1000.0, .gap = 0.01, .damping = 5.0});
  m.add<EngineOrderTorque>(
      "t", {"a"}, {.harmonics = {{.order = 1.0, .amplitude = 100.0}}, .mean = 10.0, .twist_feedback = false});
  const NonlinearSweep sweep = sweep_nonlinear(m.build(), {.speeds = {rpm(590), rpm(600)}});
  CHECK(sweep.changes.empty());
  REQUIRE(sweep.branches.size() == 1);
  CHECK(nearest_motion(sweep, rpm(590), 1.0).multiplier == Approx(0.834698353).margin(1e-7));
  CHECK(nearest_motion(sweep, rpm(600), 1.0).multiplier == Approx(0.838905509).margin(1e-7));
}

TEST_CASE("A slope that jumps where its law does not say it costs digits of a multiplier, not all of them",
          "[nonlinear_sweep][once]") {
  // x'' + c max(x', 0) + x = cos t: the panel in which the slope jumps is bridged by a polynomial.
  struct Row {
    double damping, multiplier;
  };
  for (const Row& row : {Row{20.0, 0.403903835}, {100.0, 0.141175025}}) {
    Model m("one-way damper");
    m.add_node("clock");
    m.add_node("disc");
    m.constant_speed("clock", 1.0);
    m.add<Inertia>("J", {"disc"}, {.inertia = 1.0});
    m.add<LawElement<OneWayDamper>>("damper", {"clock", "disc"}, {row.damping});
    m.add<EngineOrderTorque>("t", {"disc"},
                             {.harmonics = {{.order = 1.0, .amplitude = 1.0}}, .twist_feedback = false});
    const NonlinearSweep sweep = sweep_nonlinear(m.build(), {.speeds = {1.0, 1.01}, .runs = false});
    INFO("damping " << row.damping);
    CHECK(nearest_motion(sweep, 1.0, row.multiplier).multiplier == Approx(row.multiplier).margin(0.05));
  }
}

TEST_CASE("A mesh whose stiffness varies has its bounds where the stiffness of the moment puts them",
          "[nonlinear_sweep]") {
  // x'' + F(x, x', k(t)) = 0.1 + 0.2 w^2 cos wt, w = 0.8, half gap 1, k = 1 + 0.2 cos wt, c = 0.3, p_ref = 0.05.
  struct Row {
    MeshDamping law;
    double multiplier;
  };
  for (const Row& row : {Row{MeshDamping::limited, 0.6542942788},
                         {MeshDamping::contact_only, 0.6262521417},
                         {MeshDamping::proportional, 0.6319922595}}) {
    const problems::DrivenGear gear{.speed = 0.8,
                                    .stiffness = MeshStiffness::fourier(1.0, {{1.0, 0.2, 0.0}}),
                                    .half_gap = 1.0,
                                    .damping = 0.3,
                                    .mean = 0.1,
                                    .transmission_error = std::vector<Harmonic>{{1.0, 0.2, 0.0}},
                                    .damping_law = row.law,
                                    .reference_penetration = 0.05};
    const NonlinearSweep sweep = sweep_nonlinear(gear.build(), {.speeds = {0.8, 0.82}, .turns = 1.0});
    INFO("law " << static_cast<int>(row.law));
    const SweptMotion& motion = nearest_motion(sweep, 0.8, row.multiplier);
    CHECK(motion.separates);
    CHECK(motion.stable);
    CHECK(motion.multiplier == Approx(row.multiplier).margin(1e-6));
  }
}

TEST_CASE("Sweeps of contacts state the heat of rubber, which its inner dashpots turn", "[nonlinear_sweep]") {
  // J x'' + G x + c x' = T cos wt: heat w/2 (Im G + c w) |x|^2, G(i w) of the chain. The mesh stands beside it.
  const double inertia = 1.0, torque = 100.0, damping = 2.0, w = rpm(450);
  ViscoelasticStiffness::Params rubber{.stiffness = 1000.0, .loss_factor = 0.2};
  rubber.lowest_frequency = 5.0, rubber.highest_frequency = 10.0;
  Model m("rubber and a mesh");
  for (const char* node : {"shaft", "disc", "wheel"}) m.add_node(node);
  m.constant_speed("shaft", w);
  m.add<Inertia>("J", {"disc"}, {.inertia = inertia});
  m.add<ElasticCoupling>("rubber", {"shaft", "disc"}, {.material = rubber, .damping = damping});
  m.add<EngineOrderTorque>("t", {"disc"},
                           {.harmonics = {{.order = 1.0, .amplitude = torque}}, .twist_feedback = false});
  m.add<Inertia>("J_w", {"wheel"}, {.inertia = 1.0});
  m.add<DeadBandCoupling>("gap", {"shaft", "wheel"}, {.stiffness = 1000.0, .gap = 0.01, .damping = 1.0});
  m.add<EngineOrderTorque>("load", {"wheel"}, {.mean = 10.0, .twist_feedback = false});
  const NonlinearSweep sweep = sweep_nonlinear(m.build(), {.speeds = {w, 1.1 * w}, .runs = false});
  const std::complex<double> g =
      ViscoelasticStiffness(rubber).chain(w) + std::complex<double>(0.0, damping * w);
  const double heat = 0.5 * w * g.imag() * std::norm(torque / (g - inertia * w * w));
  REQUIRE_FALSE(sweep.branches.empty());
  const auto section = std::find_if(sweep.sections.begin(), sweep.sections.end(),
                                    [](const auto& s) { return s.name == "rubber.torque_Nm"; });
  REQUIRE(section != sweep.sections.end());
  CHECK(nearest_motion(sweep, w, 0.0).heat[section - sweep.sections.begin()] == Approx(heat).epsilon(1e-9));
}
