/// Modes against closed forms: free and held chains, repeated frequencies, bad scaling, contact
/// states.
#include <drev/core/assembler.hpp>
#include <drev/core/element.hpp>
#include <drev/core/error.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/gear_mesh.hpp>
#include <drev/elements/ground_spring.hpp>
#include <drev/elements/ideal_gear.hpp>
#include <drev/elements/inertia.hpp>
#include <drev/elements/shaft_spring.hpp>
#include <drev/solvers/modes/modes.hpp>

#include <Eigen/LU>
#include <cmath>
#include <string>

#include "tests/catch.hpp"

using namespace drev;

namespace {

constexpr int kAlwaysLanczos = 0, kAlwaysDense = 1 << 20;

std::string name(const char* prefix, int i) { return prefix + std::to_string(i); }

/// n inertias J in a row, springs k; the first tied to ground by another spring if held.
System chain(int n, double inertia, double stiffness, bool held) {
  Model model("chain");
  for (int i = 0; i < n; ++i) {
    model.add_node(name("n", i));
    model.add<Inertia>(name("J", i), {name("n", i)}, {.inertia = inertia});
    if (i > 0)
      model.add<ShaftSpring>(name("k", i), {name("n", i - 1), name("n", i)}, {.stiffness = stiffness});
  }
  if (held) model.add<GroundSpring>("ground", {"n0"}, {.stiffness = stiffness});
  return model.build();
}

/// Hub J = 2 with identical branches of two discs J = 1, all k = 1 (lambda in closed form for 8).
System hub(int branches) {
  Model model("hub");
  model.add_node("hub");
  model.add<Inertia>("J_hub", {"hub"}, {.inertia = 2.0});
  for (int i = 0; i < branches; ++i) {
    model.add_node(name("a", i));
    model.add_node(name("b", i));
    model.add<Inertia>(name("Ja", i), {name("a", i)}, {.inertia = 1.0});
    model.add<Inertia>(name("Jb", i), {name("b", i)}, {.inertia = 1.0});
    model.add<ShaftSpring>(name("ka", i), {"hub", name("a", i)}, {.stiffness = 1.0});
    model.add<ShaftSpring>(name("kb", i), {name("a", i), name("b", i)}, {.stiffness = 1.0});
  }
  return model.build();
}

double lambda(const ModeSet& modes, int j) { return modes.omega(j) * modes.omega(j); }

}  // namespace

TEST_CASE("Free-free chains: one rigid mode, none missed", "[modes]") {
  // omega_j = 2 sqrt(k/J) sin(j pi/2n)
  const double k = 1000.0, inertia = 0.5;
  for (const int n : {8, 10, 50, 200, 2000})
    for (const int limit : {kAlwaysLanczos, 200}) {
      if (n > 200 && limit > 0) continue;
      const int count = std::min(12, n - 1);
      const ModeSet modes = solve_modes(chain(n, inertia, k, false), {.count = count, .dense_limit = limit});
      CHECK(modes.rigid_modes == 1);
      REQUIRE(modes.count() == count);
      for (int j = 1; j <= count; ++j) {
        const double exact = 2.0 * std::sqrt(k / inertia) * std::sin(j * kPi / (2 * n));
        // eps lambda_max / lambda_1 is 4e-10 for n = 2000; 5e-12 was measured, as the header says
        CHECK(modes.omega(j - 1) == Approx(exact).epsilon(n > 200 ? 2e-11 : 1e-12));
      }
      if (count < n - 1) CHECK(modes.summary.sturm_count == count + 1);
      CHECK(modes.summary.largest_residual < 1e-13);
      CHECK(modes.summary.copies_not_returned == 0);
    }
}

TEST_CASE("Held chains have no rigid mode", "[modes]") {
  // omega_j = 2 sqrt(k/J) sin((2j - 1) pi/(4n + 2))
  for (const int n : {1, 10, 150}) {
    const ModeSet modes = solve_modes(chain(n, 0.5, 1000.0, true));
    CHECK(modes.rigid_modes == 0);
    REQUIRE(modes.count() == std::min(n, 10));
    for (int j = 1; j <= modes.count(); ++j)
      CHECK(modes.omega(j - 1) ==
            Approx(2.0 * std::sqrt(2000.0) * std::sin((2 * j - 1) * kPi / (4 * n + 2))).epsilon(1e-12));
    if (n > 10) CHECK(modes.summary.sturm_count == 10);
  }
}

TEST_CASE("A count that cuts repeated frequencies is noticed", "[modes]") {
  const System system = hub(8);
  const double first = (3.0 - std::sqrt(5.0)) / 2.0, eighth = (7.0 - std::sqrt(13.0)) / 2.0;
  const double ninth = (3.0 + std::sqrt(5.0)) / 2.0, last = (7.0 + std::sqrt(13.0)) / 2.0;
  for (const int limit : {kAlwaysLanczos, kAlwaysDense}) {
    const ModeSet all = solve_modes(system, {.count = 16, .dense_limit = limit});
    for (int j = 0; j < 7; ++j) CHECK(lambda(all, j) == Approx(first).epsilon(1e-12));
    CHECK(lambda(all, 7) == Approx(eighth).epsilon(1e-12));
    for (int j = 8; j < 15; ++j) CHECK(lambda(all, j) == Approx(ninth).epsilon(1e-12));
    CHECK(lambda(all, 15) == Approx(last).epsilon(1e-12));

    for (const int count : {1, 3, 6, 7}) {
      const ModeSet modes = solve_modes(system, {.count = count, .dense_limit = limit});
      REQUIRE(modes.count() == count);
      CHECK(lambda(modes, count - 1) == Approx(first).epsilon(1e-12));
      CHECK(modes.summary.copies_not_returned == 7 - count);
      CHECK(modes.summary.sturm_count == 8);  // with the rigid mode
    }
  }
}

TEST_CASE("Lanczos finds all copies in a large hub", "[modes]") {
  const System system = hub(60);  // 121 unknowns, first frequency 59 times
  const ModeSet modes = solve_modes(system, {.count = 6, .dense_limit = kAlwaysLanczos});
  CHECK(modes.summary.copies_not_returned == 53);
  CHECK(modes.summary.sturm_count == 60);
  const ModeSet some = solve_modes(system, {.count = 20, .dense_limit = kAlwaysLanczos});
  for (int j = 0; j < 20; ++j) CHECK(lambda(some, j) == Approx((3.0 - std::sqrt(5.0)) / 2.0).epsilon(1e-12));
}

TEST_CASE("Shapes: unit modal mass, orthogonal, signed, over all nodes", "[modes]") {
  Model model("geared");
  for (const char* node : {"a", "b", "c", "d", "wall"}) model.add_node(node);
  model.add<Inertia>("Ja", {"a"}, {.inertia = 2.0});
  model.add<Inertia>("Jb", {"b"}, {.inertia = 1.0});
  model.add<Inertia>("Jd", {"d"}, {.inertia = 3.0});
  model.add<ShaftSpring>("k_ab", {"a", "b"}, {.stiffness = 50.0});
  model.add<IdealGear>("gear", {"b", "c"}, {.ratio = -2.0});
  model.add<ShaftSpring>("k_cd", {"c", "d"}, {.stiffness = 80.0});
  model.add<ShaftSpring>("k_wall", {"d", "wall"}, {.stiffness = 10.0});
  model.hold("wall");
  const System system = model.build();
  REQUIRE(system.size() == 3);
  const ModeSet modes = solve_modes(system);
  REQUIRE(modes.count() == 3);
  REQUIRE(modes.shapes.rows() == 5);
  Vector product, mass = system.mass_values();
  for (int j = 0; j < 3; ++j) {
    const auto shape = modes.shapes.col(j);
    CHECK(shape[system.node("c")] == Approx(-2.0 * shape[system.node("b")]));
    CHECK(shape[system.node("wall")] == 0.0);
    CHECK(shape.maxCoeff() == shape.cwiseAbs().maxCoeff());
    Assembler(system).multiply(mass, modes.vectors.col(j), product);
    for (int i = 0; i < 3; ++i)
      CHECK(modes.vectors.col(i).dot(product) == Approx(i == j ? 1.0 : 0.0).margin(1e-13));
    // kinetic energy of the nodes at unit rate of the mode: 1/2
    CHECK(2.0 * std::pow(shape[0], 2) + std::pow(shape[1], 2) + 3.0 * std::pow(shape[3], 2) ==
          Approx(1.0).epsilon(1e-13));
  }
  // characteristic polynomial by hand, at the first mode: det(K - lambda M) = 0 relative to its
  // terms
  const double l = lambda(modes, 0);
  Eigen::Matrix3d dynamic;
  dynamic << 50 - 2 * l, -50, 0, -50, 50 + 320 - l, 160, 0, 160, 90 - 3 * l;
  CHECK(std::abs(dynamic.determinant()) < 1e-10 * 50 * 370 * 90);
}

TEST_CASE("Contacts closed and open", "[modes]") {
  // Two free shafts joined by a mesh: J1 = 0.3 with J2 = 0.2, k = 100; J3 = 0.4 with J4 = 0.1, k =
  // 300
  Model model("two shafts");
  for (int i = 1; i <= 4; ++i) model.add_node(name("n", i));
  const double inertia[] = {0.3, 0.2, 0.4, 0.1};
  for (int i = 1; i <= 4; ++i) model.add<Inertia>(name("J", i), {name("n", i)}, {.inertia = inertia[i - 1]});
  model.add<ShaftSpring>("k12", {"n1", "n2"}, {.stiffness = 100.0});
  model.add<ShaftSpring>("k34", {"n3", "n4"}, {.stiffness = 300.0});
  model.add<GearMesh>(
      "mesh", {"n2", "n3"},
      {.base_radius_1 = 0.05, .base_radius_2 = 0.1, .stiffness = 1e6, .normal_backlash = 1e-4});
  const System system = model.build();

  const ModeSet open = solve_modes(system, {.contact = Contact::open});
  CHECK(open.contact == Contact::open);
  CHECK(open.rigid_modes == 2);
  REQUIRE(open.count() == 2);
  CHECK(lambda(open, 0) == Approx(100.0 * (1 / 0.3 + 1 / 0.2)).epsilon(1e-13));
  CHECK(lambda(open, 1) == Approx(300.0 * (1 / 0.4 + 1 / 0.1)).epsilon(1e-13));

  const ModeSet closed = solve_modes(system);
  CHECK(closed.rigid_modes == 1);
  REQUIRE(closed.count() == 3);
  double sum = 0.0;
  for (int j = 0; j < 3; ++j) sum += lambda(closed, j);
  // trace of M^-1 K
  CHECK(
      sum ==
      Approx(lambda(open, 0) + lambda(open, 1) + 1e6 * (0.05 * 0.05 / 0.2 + 0.1 * 0.1 / 0.4)).epsilon(1e-12));
}

TEST_CASE("Stiffnesses that differ by 1e12: what the header promises", "[modes]") {
  // J = 1 four times, k = 1e12, 1, 1e6; exact values from the factored form in 40 digits
  Model model("scaled");
  const double k[] = {1e12, 1.0, 1e6};
  for (int i = 0; i < 4; ++i) {
    model.add_node(name("n", i));
    model.add<Inertia>(name("J", i), {name("n", i)}, {.inertia = 1.0});
    if (i > 0)
      model.add<ShaftSpring>(name("k", i), {name("n", i - 1), name("n", i)}, {.stiffness = k[i - 1]});
  }
  const ModeSet modes = solve_modes(model.build());
  CHECK(modes.rigid_modes == 1);
  REQUIRE(modes.count() == 3);
  // 1e12 + 1 in double is off by up to 6e-5: that is the error in lambda of 1
  CHECK(modes.omega(0) == Approx(.99999987499984).epsilon(6e-5));
  CHECK(modes.omega(1) == Approx(1414.2137391499).epsilon(1e-10));
  CHECK(modes.omega(2) == Approx(1414213.5623733).epsilon(1e-13));
}

TEST_CASE("Options out of range and systems without modes are refused", "[modes]") {
  const System system = chain(5, 1.0, 1.0, false);
  CHECK(solve_modes(system).count() == 4);
  CHECK(solve_modes(system, {.count = 4}).count() == 4);
  CHECK_THROWS_AS(solve_modes(system, {.count = 5}), ModelError);
  CHECK_THROWS_AS(solve_modes(system, {.count = 0}), ModelError);
  CHECK_THROWS_AS(solve_modes(system, {.count = -3}), ModelError);
  CHECK_THROWS_AS(solve_modes(system, {.dense_limit = -1}), ModelError);
  CHECK(solve_modes(chain(1, 1.0, 1.0, false)).count() == 0);
  CHECK(solve_modes(chain(1, 1.0, 1.0, false)).rigid_modes == 1);
  CHECK_THROWS_AS(solve_modes(chain(1, 1.0, 1.0, false), {.count = 1}), ModelError);
}

namespace {

/// A spring to ground by hand: its stiffness may be zero or negative, and it claims to be tied or
/// not.
class AnySpring final : public Element {
 public:
  struct Params {
    double stiffness = 0.0;
    bool says_so = true;
  };
  explicit AnySpring(Params params) : params_(params) {}
  std::string_view type() const override { return "any spring"; }
  int min_nodes() const override { return 1; }
  void check(ParameterCheck&) const override {}
  void describe(int, Terms& terms) const override {
    terms.stiffness(0, 0) = params_.stiffness;
    if (params_.says_so) terms.speed_ratio_constraints.push_back({.b = relative_motion(1)});
  }

 private:
  Params params_;
};

System with_spring(int n, AnySpring::Params params) {
  Model model("chain with a spring");
  for (int i = 0; i < n; ++i) {
    model.add_node(name("n", i));
    model.add<Inertia>(name("J", i), {name("n", i)}, {.inertia = 1.0});
    if (i > 0) model.add<ShaftSpring>(name("k", i), {name("n", i - 1), name("n", i)}, {.stiffness = 1.0});
  }
  model.add<AnySpring>("any", {"n0"}, std::move(params));
  return model.build();
}

}  // namespace

TEST_CASE("Rigid modes must be those of the graph, and K must not be unstable", "[modes]") {
  for (const int limit : {kAlwaysLanczos, kAlwaysDense}) {
    const ModesOptions options{.count = 3, .dense_limit = limit};
    CHECK_NOTHROW(solve_modes(with_spring(30, {0.5, true}), options));
    CHECK_THROWS_AS(solve_modes(with_spring(30, {0.0, true}), options), SolverError);
    CHECK_THROWS_AS(solve_modes(with_spring(30, {0.5, false}), options), SolverError);
    CHECK_THROWS_AS(solve_modes(with_spring(30, {-0.5, true}), options), SolverError);
  }
}

TEST_CASE("An inertia too small for its stiffness over it to be a number is refused, not searched for ever",
          "[modes]") {
  Model m("tiny");
  for (const char* node : {"motor", "load"}) m.add_node(node);
  m.add<Inertia>("J_motor", {"motor"}, {.inertia = 1e-308});
  m.add<Inertia>("J_load", {"load"}, {.inertia = 0.035});
  m.add<ShaftSpring>("shaft", {"motor", "load"}, {.stiffness = 8500.0});
  CHECK_THROWS_AS(solve_modes(m.build()), SolverError);
}
