// Modal damping ratios as an input. Covers models/modal_damping.hpp.
#include <drev/core/channel.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/models/modal_damping.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/modes/damped_modes.hpp>
#include <drev/solvers/modes/modes.hpp>

#include <cmath>

#include "tests/catch.hpp"

using namespace drev;

namespace {

/// A pipe of segments, a gear pair and a branch; free, turning at a nominal speed.
Model branched_train() {
  Model m("branched");
  for (const char* n : {"motor", "table", "pinion", "wheel", "load"}) m.add_node(n);
  m.add<Inertia>("J_motor", {"motor"}, {.inertia = 0.8});
  m.add<Inertia>("J_table", {"table"}, {.inertia = 0.3});
  m.add<Inertia>("J_wheel", {"wheel"}, {.inertia = 2.0});
  m.add<Inertia>("J_load", {"load"}, {.inertia = 5.0});
  m.add<DistributedShaft>(
      "pipe", {"motor", "table"},
      {.shear_modulus = 8e10, .density = 7850.0, .outer_diameter = 0.06, .length = 3.0, .segments = 4});
  m.add<ShaftSpring>("shaft", {"table", "pinion"}, {.stiffness = 4e4});
  m.add<IdealGear>("gear", {"pinion", "wheel"}, {.ratio = -0.4});
  m.add<ShaftSpring>("end", {"wheel", "load"}, {.stiffness = 9e4});
  m.set_reference("motor", constant_speed(150.0));
  return m;
}

}  // namespace

TEST_CASE("Modal damping: each elastic mode has its ratio, the rigid one none", "[damped_modes]") {
  const ModeSet undamped = solve_modes(branched_train().build(), {.count = 6});
  for (const std::vector<double>& ratios : {std::vector<double>{}, {0.01, 0.05, 0.02}}) {
    Model m = branched_train();
    add_modal_damping(
        m, "modal",
        ratios.empty() ? ModalDamping::Params{.ratio = 0.03} : ModalDamping::Params{.ratios = ratios});
    const System system = m.build();
    const DampedModeSet damped = solve_damped_modes(system);
    CHECK(damped.rigid_modes == 1);
    REQUIRE(damped.modes.size() >= 6);
    for (std::size_t j = 0; j < 6; ++j) {
      INFO(j);
      const double xi = ratios.empty() ? 0.03 : ratios[std::min<std::size_t>(j, 2)];
      const std::complex<double> lambda = damped.modes[j].lambda;
      CHECK(std::abs(lambda) == Approx(hz(undamped.frequency_Hz[j])).epsilon(1e-9));
      CHECK(-lambda.real() / std::abs(lambda) == Approx(xi).epsilon(1e-8));
    }
    CHECK(system.nominal_drag().cwiseAbs().maxCoeff() == 0.0);
    // All of what is lost is lost there.
    const ModeEnergy energy = mode_energy(system, damped);
    for (std::size_t e = 0; e < energy.elements.size(); ++e)
      if (energy.elements[e] == "modal") CHECK(energy.dissipated(Eigen::Index(e), 0) == Approx(1.0));
  }
}

TEST_CASE("Modal damping in time: free decay in closed form, exactly and by steps", "[damped_modes]") {
  Model m("two discs");
  m.add_node("a"), m.add_node("b");
  m.add<Inertia>("J_a", {"a"}, {.inertia = 2.0});
  m.add<Inertia>("J_b", {"b"}, {.inertia = 3.0});
  m.add<ShaftSpring>("k", {"a", "b"}, {.stiffness = 1.2e4});
  m.set_initial("a", 0.01, 0.5);
  m.set_initial("b", -0.01, 0.5);
  add_modal_damping(m, "modal", {.ratio = 0.1});
  const System system = m.build();
  const double w = std::sqrt(1.2e4 * (1.0 / 2.0 + 1.0 / 3.0)), xi = 0.1, t = 0.07, x_0 = -0.02;
  const double w_d = w * std::sqrt(1.0 - xi * xi),
               twist = x_0 * std::exp(-xi * w * t) * (std::cos(w_d * t) + xi * w / w_d * std::sin(w_d * t));
  State exact = State::initial(system), stepped = exact;
  CHECK(propagate(system, {.tolerance = 1e-13, .t_end = t, .energy_tolerance = 1e-10}, exact).ok());
  CHECK(exact.z[1] - exact.z[0] == Approx(twist).epsilon(1e-11));
  CHECK(0.4 * exact.v[0] + 0.6 * exact.v[1] == Approx(0.5).epsilon(1e-13));  // rigid motion loses nothing
  CHECK(run_method(system, {.step = 1e-5}, {.t_end = t}, stepped).ok());
  CHECK(stepped.z[1] - stepped.z[0] == Approx(twist).epsilon(1e-5));
}

TEST_CASE("Modal damping: what is refused", "[damped_modes]") {
  const auto text = [](Model m, const ModalDamping::Params& p) {
    try {
      add_modal_damping(m, "modal", p);
    } catch (const ModelError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const auto has = [](const std::string& all, const char* part) {
    return all.find(part) != std::string::npos;
  };
  CHECK(has(text(branched_train(), {}), "exactly one of ratio and ratios"));
  CHECK(has(text(branched_train(), {.ratio = -0.1}), "ratio"));
  CHECK(has(text(branched_train(), {.ratios = {0.1, 2.0}}), "ratios"));
  Model moved = branched_train();
  moved.add_node("flange");
  moved.add<ShaftSpring>("drive", {"flange", "motor"}, {.stiffness = 1e5});
  moved.given_motion("flange", {[](double t) {
                       return MotionPoint{0.01 * std::sin(t), 0.01 * std::cos(t), 0.0};
                     }});
  CHECK(has(text(moved, {.ratio = 0.1}), "given motion"));
  Model alone = branched_train();
  alone.add<ModalDamping>("modal", {}, {.ratio = 0.1});
  CHECK_THROWS_AS(alone.build(), ModelError);
}
