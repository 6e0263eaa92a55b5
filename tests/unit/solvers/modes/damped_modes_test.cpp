/// Damped modes against closed forms.
#include <drev/core/units.hpp>
#include <drev/elements/dashpot.hpp>
#include <drev/elements/gear_mesh.hpp>
#include <drev/elements/ground_spring.hpp>
#include <drev/elements/inertia.hpp>
#include <drev/elements/rayleigh_damping.hpp>
#include <drev/elements/shaft_spring.hpp>
#include <drev/solvers/modes/damped_modes.hpp>
#include <drev/solvers/modes/modes.hpp>

#include <cmath>
#include <string>
#include <vector>

#include "tests/catch.hpp"

using namespace drev;

namespace {

Model free_chain(int n) {
  Model model("chain");
  for (int i = 0; i < n; ++i) {
    const std::string node = "n" + std::to_string(i);
    model.add_node(node);
    model.add<Inertia>("J" + std::to_string(i), {node}, {.inertia = 0.5});
    if (i > 0)
      model.add<ShaftSpring>("k" + std::to_string(i), {"n" + std::to_string(i - 1), node},
                             {.stiffness = 1000.0});
  }
  return model;
}

}  // namespace

TEST_CASE("One oscillator, under- and overdamped", "[damped_modes]") {
  const auto solve = [](double damping) {
    Model model("oscillator");
    model.add_node("n");
    model.add<Inertia>("m", {"n"}, {.inertia = 1.6});
    model.add<GroundSpring>("k", {"n"}, {.stiffness = 4000.0, .damping = damping});
    return solve_damped_modes(model.build());
  };
  const DampedModeSet under = solve(8.0);
  REQUIRE(under.modes.size() == 1);
  CHECK(under.rigid_modes == 0);
  CHECK(under.modes[0].lambda.real() == Approx(-2.5).epsilon(1e-14));
  CHECK(under.modes[0].lambda.imag() == Approx(std::sqrt(2500.0 - 6.25)).epsilon(1e-14));
  CHECK(under.modes[0].natural_frequency_Hz == Approx(50.0 / kTwoPi).epsilon(1e-14));
  CHECK(under.modes[0].frequency_Hz == Approx(std::sqrt(2493.75) / kTwoPi).epsilon(1e-14));
  CHECK(under.modes[0].damping_ratio == Approx(0.05).epsilon(1e-13));
  CHECK(under.shapes(0, 0) == std::complex<double>(1.0, 0.0));

  const DampedModeSet over = solve(200.0);  // xi = 1.25: lambda = 50 (-1.25 +- 0.75)
  CHECK(over.modes.empty());
  REQUIRE(over.real_lambda.size() == 2);
  CHECK(over.real_lambda[0] == Approx(-25.0).epsilon(1e-13));
  CHECK(over.real_lambda[1] == Approx(-100.0).epsilon(1e-13));
}

TEST_CASE("Rayleigh damping of a free chain: every mode's ratio", "[damped_modes]") {
  const int n = 30;
  const double a = 3.0, b = 2e-4;
  Model model = free_chain(n);
  model.add<RayleighDamping>("rayleigh", {}, {.alpha_mass = a, .beta_stiffness = b});
  const DampedModeSet set = solve_damped_modes(model.build());
  CHECK(set.rigid_modes == 1);
  REQUIRE(set.modes.size() == 29);
  for (int j = 1; j < n; ++j) {
    const double w = 2.0 * std::sqrt(2000.0) * std::sin(j * kPi / (2 * n));
    const DampedMode& mode = set.modes[static_cast<std::size_t>(j - 1)];
    CHECK(mode.natural_frequency_Hz == Approx(w / kTwoPi).epsilon(1e-11));
    CHECK(mode.damping_ratio == Approx(a / (2 * w) + b * w / 2).epsilon(1e-11));
  }
  // the rigid-body motion's rate decays with a
  REQUIRE(set.real_lambda.size() == 1);
  CHECK(set.real_lambda[0] == Approx(-a).epsilon(1e-12));
}

TEST_CASE("A free chain without damping: the double zero does not split", "[damped_modes]") {
  const DampedModeSet set = solve_damped_modes(free_chain(50).build());
  CHECK(set.modes.size() == 49);
  REQUIRE(set.real_lambda.size() == 1);
  CHECK(std::abs(set.real_lambda[0]) < 1e-10);
  for (const DampedMode& mode : set.modes) {
    CHECK(mode.lambda.real() == 0.0);
    CHECK(mode.damping_ratio == 0.0);
    CHECK_FALSE(std::signbit(mode.damping_ratio));
  }
}

TEST_CASE("Trains that nothing ties to each other: no mode of a multiple real lambda", "[damped_modes]") {
  // Rounding splits it into a pair +- 1e-16 i, at which the numbers chosen here did so.
  Model model("two trains");
  const auto train = [&](const std::string& name, const std::vector<double>& inertia,
                         const std::vector<double>& stiffness, const std::vector<double>& damping) {
    for (std::size_t i = 0; i < inertia.size(); ++i) {
      const std::string node = name + std::to_string(i);
      model.add_node(node);
      model.add<Inertia>("J_" + node, {node}, {.inertia = inertia[i]});
      if (i > 0)
        model.add<ShaftSpring>("k_" + node, {name + std::to_string(i - 1), node},
                               {.stiffness = stiffness[i - 1], .damping = damping[i - 1]});
    }
  };
  SECTION("a double zero") {
    train("a", {2.0, 0.5, 0.1}, {100.0, 1000.0}, {0.5, 1.0});
    train("b", {3.0, 3.0, 2.0}, {100.0, 10.0}, {1.0, 0.3});
    const DampedModeSet set = solve_damped_modes(model.build());
    CHECK(set.rigid_modes == 2);
    CHECK(set.modes.size() == 4);
    REQUIRE(set.real_lambda.size() == 2);
    for (const double lambda : set.real_lambda) CHECK(std::abs(lambda) < 1e-13);
  }
  SECTION("a double rate of decay") {
    train("a", {2.0, 0.1}, {300.0}, {0.0});
    train("b", {3.0, 2.0}, {300.0}, {0.0});
    model.add<RayleighDamping>("rayleigh", {}, {.alpha_mass = 1.0, .beta_stiffness = 1e-3});
    const DampedModeSet set = solve_damped_modes(model.build());
    CHECK(set.modes.size() == 2);
    REQUIRE(set.real_lambda.size() == 2);
    for (const double lambda : set.real_lambda) CHECK(lambda == Approx(-1.0).epsilon(1e-12));
  }
}

TEST_CASE("Damping elsewhere leaves no rounding as the damping of an undamped mode", "[damped_modes]") {
  // Two oscillators that nothing ties to each other, one with a damper.
  Model model("two oscillators");
  for (const char* node : {"a", "b"}) {
    model.add_node(node);
    model.add<Inertia>("J_" + std::string(node), {node}, {.inertia = 0.3});
  }
  model.add<GroundSpring>("k_a", {"a"}, {.stiffness = 700.0, .damping = 3.0});
  model.add<GroundSpring>("k_b", {"b"}, {.stiffness = 5000.0});
  const DampedModeSet set = solve_damped_modes(model.build());
  REQUIRE(set.modes.size() == 2);
  CHECK(set.modes[0].lambda.real() == Approx(-5.0).epsilon(1e-13));
  CHECK(set.modes[1].lambda.real() == 0.0);
  CHECK(set.modes[1].damping_ratio == 0.0);
}

TEST_CASE("A dashpot that is not proportional", "[damped_modes]") {
  // Two free discs J = 2 and 3, k = 600, dashpot c = 4 beside: relative motion with the reduced
  // inertia 1.2; then a dashpot to ground on one disc: the characteristic polynomial by hand.
  Model model("two discs");
  model.add_node("a");
  model.add_node("b");
  model.add<Inertia>("Ja", {"a"}, {.inertia = 2.0});
  model.add<Inertia>("Jb", {"b"}, {.inertia = 3.0});
  model.add<ShaftSpring>("k", {"a", "b"}, {.stiffness = 600.0, .damping = 4.0});
  const DampedModeSet relative = solve_damped_modes(model.build());
  REQUIRE(relative.modes.size() == 1);
  CHECK(relative.modes[0].lambda.real() == Approx(-4.0 / 2.4).epsilon(1e-13));
  CHECK(std::abs(relative.modes[0].lambda) == Approx(std::sqrt(500.0)).epsilon(1e-13));

  model.add<Dashpot>("drag", {"a"}, {.damping = 7.0});
  const DampedModeSet dragged = solve_damped_modes(model.build());
  CHECK(dragged.rigid_modes == 1);
  REQUIRE(dragged.modes.size() == 1);
  REQUIRE(dragged.real_lambda.size() == 1);
  for (const std::complex<double> l :
       {dragged.modes[0].lambda, std::complex<double>(dragged.real_lambda[0])}) {
    const std::complex<double> shaft = 600.0 + 4.0 * l;
    // determinant over l: (2 l^2 + 7 l + s)(3 l^2 + s) - s^2 = l [6 l^3 + 21 l^2 + 5 s l + 7 s]
    const std::complex<double> rest = 6.0 * l * l * l + 21.0 * l * l + 5.0 * shaft * l + 7.0 * shaft;
    CHECK(std::abs(rest) < 1e-11 * 7.0 * 600.0 * 500.0);
  }
}

TEST_CASE("Closed contacts bring their damping, open ones do not", "[damped_modes]") {
  Model model("mesh");
  model.add_node("a");
  model.add_node("b");
  model.add<Inertia>("Ja", {"a"}, {.inertia = 0.01});
  model.add<Inertia>("Jb", {"b"}, {.inertia = 0.04});
  model.add<GearMesh>("mesh", {"a", "b"},
                      {.base_radius_1 = 0.05,
                       .base_radius_2 = 0.1,
                       .stiffness = 1e8,
                       .normal_backlash = 1e-4,
                       .damping = 2000.0});
  const System system = model.build();
  const DampedModeSet closed = solve_damped_modes(system);
  REQUIRE(closed.modes.size() == 1);
  // 1/m = 0.05^2/0.01 + 0.1^2/0.04 = 0.5: w^2 = k/2, xi = c/(2 m w)
  const double w = std::sqrt(0.5e8);
  CHECK(std::abs(closed.modes[0].lambda) == Approx(w).epsilon(1e-13));
  CHECK(closed.modes[0].damping_ratio == Approx(2000.0 / (4.0 * w)).epsilon(1e-11));
  const DampedModeSet open = solve_damped_modes(system, {.contact = Contact::open});
  CHECK(open.rigid_modes == 2);
  CHECK(open.modes.empty());
  CHECK(open.real_lambda == std::vector<double>{0.0, 0.0});
}

TEST_CASE("Undamped frequencies are those of solve_modes, the limit is kept", "[damped_modes]") {
  const System system = free_chain(20).build();
  const DampedModeSet damped = solve_damped_modes(system);
  const ModeSet modes = solve_modes(system, {.count = 19});
  for (int j = 0; j < 19; ++j) {
    const auto i = static_cast<std::size_t>(j);
    CHECK(damped.modes[i].frequency_Hz == Approx(modes.frequency_Hz[i]).epsilon(1e-11));
    const Vector shape = modes.shapes.col(j) / modes.shapes.col(j).cwiseAbs().maxCoeff();
    const Vector other = damped.shapes.col(j).real();
    CHECK(std::min((shape - other).norm(), (shape + other).norm()) < 1e-9);
    CHECK(damped.shapes.col(j).imag().norm() < 1e-9);
  }
  CHECK_THROWS_AS(solve_damped_modes(system, {.size_limit = 19}), ModelError);
  const auto places = static_cast<int>(system.pattern().nonZeros());
  for (const int size : {1, 20, places + 1}) {  // 20 unknowns: values of the pattern, not of the unknowns
    INFO(size << " values");
    try {
      solve_damped_modes(system, {.damping = Vector::Zero(size)});
      FAIL("a damping of another size was taken");
    } catch (const ModelError& error) {
      CHECK(std::string(error.what())
                .find("damping = " + std::to_string(size) + " values, must have " + std::to_string(places)) !=
            std::string::npos);
    }
  }
  CHECK(solve_damped_modes(system, {.damping = Vector::Zero(places)}).modes.size() == damped.modes.size());
}

TEST_CASE("A soft coupling beside a stiff shaft with next to no inertia is not refused", "[damped_modes]") {
  // omega^2 is 7 of the one mode and 1e16 of the other: 1e-15 of the largest.
  const double j_a = 50.0, j_b = 20.0, j_c = 1e-9, soft = 100.0, drag = 1.0, stiff = 1e7, damping = 1e-3;
  Model m("wide spread");
  for (const char* node : {"a", "b", "c"}) m.add_node(node);
  m.add<Inertia>("J_a", {"a"}, {.inertia = j_a});
  m.add<Inertia>("J_b", {"b"}, {.inertia = j_b});
  m.add<Inertia>("J_c", {"c"}, {.inertia = j_c});
  m.add<ShaftSpring>("soft", {"a", "b"}, {.stiffness = soft, .damping = drag});
  m.add<ShaftSpring>("stiff", {"b", "c"}, {.stiffness = stiff, .damping = damping});
  const DampedModeSet set = solve_damped_modes(m.build());
  CHECK(set.rigid_modes == 1);
  REQUIRE(set.modes.size() == 2);
  // J_c adds 5e-11 of J_b to the one, and the rest is 5e-11 of J_c's motion in the other.
  const double low = 1.0 / j_a + 1.0 / (j_b + j_c), high = 1.0 / j_b + 1.0 / j_c;
  const auto lambda = [](double decay, double square) {
    return std::complex<double>(-decay, std::sqrt(square - decay * decay));
  };
  const std::complex<double> slow = lambda(0.5 * drag * low, soft * low),
                             fast = lambda(0.5 * damping * high, stiff * high);
  CHECK(std::abs(set.modes[0].lambda - slow) < 1e-7 * std::abs(slow));
  CHECK(std::abs(set.modes[1].lambda - fast) < 1e-9 * std::abs(fast));
  CHECK(std::abs(set.shapes(1, 0) / set.shapes(0, 0) + j_a / j_b) < 1e-7);
}
