// Covers advice/closed_flank.hpp: one flank of a mesh that gets stiffer with its load.
#include "advice/closed_flank.hpp"

#include <drev/core/verify.hpp>

#include "tests/catch.hpp"

using namespace drev;

TEST_CASE("A closed flank is the mesh with its gap as long as that flank carries") {
  GearMesh::Params params{.base_radius_1 = 0.05,
                          .base_radius_2 = 0.1,
                          .stiffness = 2e8,
                          .normal_backlash = 80e-6,
                          .damping = 1e3,
                          .stiffening = {{0.0, 4e-6, 12e-6}, {0.9, 1.0, 1.2}}};
  const GearMesh gapped(params);
  params.normal_backlash = 0.0;
  const auto closed = std::make_shared<const GearMesh>(params);
  for (const int side : {1, -1}) {
    const ClosedFlank flank(closed, side * 40e-6);
    CHECK(check_element(flank, 2).text() == "");
    for (const double p : {3e-6, 8e-6, 30e-6}) {
      const ScalarInput in{.x = side * (40e-6 + p), .x_dot = 0.02};
      CHECK(flank.evaluate(in).y == Approx(gapped.evaluate(in).y).epsilon(1e-12));
      CHECK(flank.evaluate(in).dy_dx == Approx(gapped.evaluate(in).dy_dx).epsilon(1e-12));
    }
    CHECK(flank.kinks().size() == 4);
  }
}
