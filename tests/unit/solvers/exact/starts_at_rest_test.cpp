// What moves out of rest, where the first terms of a series vanish: loads at the top of their torque, knots at which the motion
// starts, trains that stand still (solvers/series/series_expansion.cpp, solvers/exact/expanded_loads.hpp, solvers/run/energy_monitor.hpp).
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>

#include <cmath>

#include "tests/catch.hpp"

using namespace drev;

namespace {

Model discs(std::initializer_list<std::pair<const char*, double>> inertias) {
  Model m("discs");
  for (const auto& [node, inertia] : inertias) {
    m.add_node(node);
    m.add<Inertia>(std::string("J_") + node, {node}, {.inertia = inertia});
  }
  return m;
}

void check_end(const Model& model, double t, std::initializer_list<double> z,
               std::initializer_list<double> v) {
  const System s = model.build();
  for (const double tolerance : {1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
    State state = State::initial(s);
    const RunSummary run = propagate(s, {.tolerance = tolerance, .t_end = t}, state);
    INFO(tolerance << ": " << run.brief_report());
    CHECK(run.ok());
    // Of the largest angle and speed.
    const double most = std::max(2.0 * tolerance, 1e-11), fastest = state.v.cwiseAbs().maxCoeff();
    int i = 0;
    for (const double expected : z) CHECK(std::abs(state.z[i++] - expected) <= most);
    i = 0;
    for (const double expected : v) CHECK(std::abs(state.v[i++] - expected) <= most * fastest);
  }
}

}  // namespace

// Expected values by SciPy's DOP853 at a relative tolerance of 1e-13.

TEST_CASE("A disc at rest where an order of torque is largest moves as the order says") {
  // theta = s^2 a/2 + ..., so that cos(2 theta) first differs from its tangent by s^4, the next term by s^8.
  Model m = discs({{"a", 10.0}});
  m.add<EngineOrderTorque>("f", {"a"}, {.harmonics = {{.order = 2.0, .amplitude = 20.0}}});
  check_end(m, 0.2, {0.03999146939627756}, {0.3997441364594354});
}

TEST_CASE("A clutch that slips moves a disc from the top of its torque on") {
  Model m = discs({{"a", 1.0}, {"fly", 100.0}});
  m.set_initial("fly", 0.0, 100.0);
  m.add<Clutch>("joint", {"fly", "a"}, {.torque = 10.0});
  m.add<EngineOrderTorque>("f", {"a"}, {.harmonics = {{.order = 1.0, .amplitude = 5.0}}});
  check_end(m, 0.3, {0.6716367449302337}, {4.433442861560319});
}

TEST_CASE("A cubic cam at rest on a knot beside a torque that is called") {
  Model m = discs({{"a", 1.0}, {"b", 1.0}});
  m.add<ShaftSpring>("s", {"a", "b"}, {.stiffness = 1000.0});
  m.add<AppliedTorque>("t", {"a"}, {.torque = [](double) { return 10.0; }});
  m.add<CamTorque>("cam", {"b"},
                   {.angle_table = {{0.0, deg(90), deg(180), deg(270)}, {0.0, 10.0, 0.0, -10.0}},
                    .interpolation = Interpolation::cubic});
  m.add<Propeller>("p", {"b"}, {.rated_torque = 10.0, .rated_speed = 10.0});
  check_end(m, 0.2, {0.10569411259927432, 0.09669577272925851}, {1.0769626573833964, 0.9761146506010927});
}

TEST_CASE("Two cubic cams at rest on a knot each leave it to the side to which the motion goes") {
  Model m = discs({{"a", 1.0}, {"b", 1.0}});
  m.add<ShaftSpring>("s", {"a", "b"}, {.stiffness = 1000.0});
  m.add<AppliedTorque>("t", {"a"}, {.table = TimeTable({0.0}, {10.0})});
  for (const char* node : {"a", "b"})
    m.add<CamTorque>(std::string("cam_") + node, {node},
                     {.angle_table = {{0.0, deg(90), deg(180), deg(270)}, {0.0, 10.0, 0.0, -10.0}},
                      .interpolation = Interpolation::cubic});
  check_end(m, 0.2, {0.10793708106000588, 0.09850874475182486}, {1.1187612876544495, 1.010936374186733});
}

TEST_CASE("A train that stands still at an angle has no energy but rounding") {
  const auto run = [](double twist) {
    Model m = discs({{"a", 0.1}, {"b", 1.0}, {"c", 1.0}});
    for (const char* node : {"a", "b"}) m.set_initial(node, 0.5 * kPi, 0.0);
    m.set_initial("c", 0.5 * kPi + twist, 0.0);
    m.add<ShaftSpring>("soft", {"a", "b"}, {.stiffness = 1.0, .damping = 0.1});
    m.add<ShaftSpring>("stiff", {"b", "c"}, {.stiffness = 1e4, .damping = 0.1});
    m.add<Propeller>("p", {"b"}, {.rated_torque = 100.0, .rated_speed = 10.0});
    return propagate(m.build(), {.t_end = 0.5});
  };
  const RunSummary still = run(0.0), twisted = run(1e-6);
  INFO(still.brief_report());
  CHECK(still.ok());
  CHECK(still.energy.relative_error() == 0.0);
  // A millionth of a radian is energy.
  CHECK(twisted.energy.scale == Approx(0.5 * 1e4 * 1e-12).epsilon(1e-2));
  CHECK(twisted.energy.scale > twisted.energy.rounding);
}
