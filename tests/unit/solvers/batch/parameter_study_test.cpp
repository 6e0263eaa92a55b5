// The example of docs/parameter_study.md.
#include <drev/models/ready_made.hpp>
#include <drev/solvers/batch/simulate_many.hpp>
#include <drev/solvers/stepping/transient.hpp>

#include <cstdio>

#include "tests/catch.hpp"

using namespace drev;

TEST_CASE("Parameter study: the page's example") {
  // [study]
  const auto build = [](std::size_t i) {
    Parameters parameters("camshaft", camshaft_entry().parameters);
    parameters.set("engine_rpm", to_text(600.0 + 10.0 * static_cast<double>(i)));
    return build_camshaft(parameters).model.build();
  };
  const ManyResult study =
      simulate_many(16, build, {.step = 1e-5, .t_end = 0.02}, {.channels = {"inlet_9-fuel_1.twist_rad"}});
  for (const VariantResult& variant : study.variants)
    if (variant.ok()) std::printf("%.6f rad\n", variant.peaks[0].amplitude());
  // [study]
  CHECK(study.why_not_lockstep == "");
  for (const VariantResult& variant : study.variants) {
    CHECK(variant.ok());
    CHECK(variant.peaks[0].amplitude() > 0.0);
  }
}
