// Modes that lie close together or whose units differ widely, against what theory says of them.
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/modes/modes.hpp>

#include <cmath>

#include "tests/catch.hpp"

using namespace drev;

namespace {

constexpr int kAlwaysLanczos = 0, kAlwaysDense = 1 << 20;

std::string name(const char* prefix, int i) { return prefix + std::to_string(i); }

/// Hub J = 2 with branches of two discs J = 1; both springs of branch i are 1 + i * mistuning.
System hub(int branches, double mistuning) {
  Model model("hub");
  model.add_node("hub");
  model.add<Inertia>("J_hub", {"hub"}, {.inertia = 2.0});
  for (int i = 0; i < branches; ++i) {
    const double k = 1.0 + i * mistuning;
    model.add_node(name("a", i));
    model.add_node(name("b", i));
    model.add<Inertia>(name("Ja", i), {name("a", i)}, {.inertia = 1.0});
    model.add<Inertia>(name("Jb", i), {name("b", i)}, {.inertia = 1.0});
    model.add<ShaftSpring>(name("ka", i), {"hub", name("a", i)}, {.stiffness = k});
    model.add<ShaftSpring>(name("kb", i), {name("a", i), name("b", i)}, {.stiffness = k});
  }
  return model.build();
}

double lambda(const ModeSet& modes, int j) { return modes.omega(j) * modes.omega(j); }

}  // namespace

TEST_CASE("Branches that differ by little: one mode between each two of their own frequencies", "[modes]") {
  // Cauchy's interlacing: with the hub held, branch i has (3 -+ sqrt 5)/2 (1 + i d); letting one
  // freedom go puts exactly one eigenvalue between each two of them.
  const double low = (3.0 - std::sqrt(5.0)) / 2.0, high = (3.0 + std::sqrt(5.0)) / 2.0;
  for (const auto& [branches, mistuning] :
       {std::pair{8, 1e-3}, {8, 1e-5}, {8, 1e-10}, {8, 1e-13}, {60, 1e-5}, {60, 1e-11}})
    for (const int limit : {kAlwaysLanczos, kAlwaysDense}) {
      const ModeSet modes =
          solve_modes(hub(branches, mistuning), {.count = 2 * branches - 1, .dense_limit = limit});
      const double rounding = 1e-12;
      for (int j = 0; j < branches - 1; ++j)
        for (const auto& [first, own] : {std::pair{0, low}, {branches, high}}) {
          INFO(branches << " branches, " << mistuning << ", mode " << first + j);
          CHECK(lambda(modes, first + j) >= own * (1.0 + j * mistuning - rounding));
          CHECK(lambda(modes, first + j) <= own * (1.0 + (j + 1) * mistuning + rounding));
        }
      // A count that ends inside the cluster returns its lowest members.
      const ModeSet some = solve_modes(hub(branches, mistuning), {.count = 3, .dense_limit = limit});
      for (int j = 0; j < 3; ++j) CHECK(lambda(some, j) == Approx(lambda(modes, j)).epsilon(2e-12));
    }
}

TEST_CASE("Modes too close to count between them, yet apart: counted behind their cluster", "[modes]") {
  // Relative distances of 1e-6 to 1e-9: a count between them meets tiny pivots.
  const double low = (3.0 - std::sqrt(5.0)) / 2.0;
  for (const int branches : {4, 8, 20, 60})
    for (const double mistuning : {1e-6, 1e-7, 1e-8, 1e-9})
      for (const int limit : {kAlwaysLanczos, kAlwaysDense}) {
        INFO(branches << " branches, " << mistuning << (limit == kAlwaysDense ? ", dense" : ", Lanczos"));
        const ModeSet modes = solve_modes(hub(branches, mistuning), {.count = 2, .dense_limit = limit});
        for (int j = 0; j < 2; ++j) {
          CHECK(lambda(modes, j) >= low * (1.0 + j * mistuning - 1e-12));
          CHECK(lambda(modes, j) <= low * (1.0 + (j + 1) * mistuning + 1e-12));
        }
      }
}

TEST_CASE("Inertias and stiffnesses over twelve decades in one chain: closed form to 1e-12", "[modes]") {
  // J_i = s r^i, k_i = s r^i between i and i + 1: lambda_j = 1 + 1/r - 2/sqrt r cos(j pi/n), j = 1 ... n - 1,
  // from the recurrence of the shaft torques, whose coefficients are constant.
  for (const double scale : {1e-6, 1.0, 1e6})
    for (const double r : {10.0, 2.0}) {
      const int n = r == 10.0 ? 13 : 40;
      Model model("graded");
      double factor = scale;
      for (int i = 0; i < n; ++i, factor *= r) {
        model.add_node(name("n", i));
        model.add<Inertia>(name("J", i), {name("n", i)}, {.inertia = factor});
        if (i > 0)
          model.add<ShaftSpring>(name("k", i), {name("n", i - 1), name("n", i)}, {.stiffness = factor / r});
      }
      const System system = model.build();
      for (const int limit : {kAlwaysLanczos, kAlwaysDense}) {
        const ModeSet modes = solve_modes(system, {.count = n - 1, .dense_limit = limit});
        CHECK(modes.rigid_modes == 1);
        for (int j = 1; j < n; ++j) {
          INFO("scale " << scale << ", r = " << r << ", mode " << j);
          CHECK(lambda(modes, j - 1) ==
                Approx(1.0 + 1.0 / r - 2.0 / std::sqrt(r) * std::cos(j * kPi / n)).epsilon(1e-12));
        }
      }
    }
}
