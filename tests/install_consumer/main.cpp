// Two inertias on a shaft, by the installed library alone: the elastic mode against its closed form,
// omega^2 = k (1 / J1 + 1 / J2), here 1200 (1/2 + 1/3) = 1000 (rad/s)^2. Exit status 0: they agree.
#include <drev/core/model.hpp>
#include <drev/core/system.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/modes/modes.hpp>

#include <cmath>
#include <cstdio>

int main() {
  drev::Model model("two inertias");
  model.add_node("motor");
  model.add_node("load");
  model.add<drev::Inertia>("motor inertia", {"motor"}, {.inertia = 2.0});           // kg m^2
  model.add<drev::Inertia>("load inertia", {"load"}, {.inertia = 3.0});             // kg m^2
  model.add<drev::ShaftSpring>("shaft", {"motor", "load"}, {.stiffness = 1200.0});  // N m/rad
  const drev::ModeSet modes = drev::solve_modes(model.build());

  const double expected = std::sqrt(1000.0);
  std::printf("rigid modes %d, elastic modes %d", modes.rigid_modes, modes.count());
  for (int i = 0; i < modes.count(); ++i) std::printf(", omega %.12g rad/s", modes.omega(i));
  std::printf(" (closed form %.12g)\n", expected);
  // Two unknowns, all eigenpairs: a few roundings, far below 1e-12.
  const bool right =
      modes.rigid_modes == 1 && modes.count() == 1 && std::abs(modes.omega(0) / expected - 1.0) < 1e-12;
  return right ? 0 : 1;
}
