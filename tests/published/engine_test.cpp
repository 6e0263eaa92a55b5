/// The six-cylinder diesel of tests/problems/engine_chain.hpp with its cylinders as elements: gas pressure over the
/// crank angle, scaled by the peak pressure over speed (models/six_cylinder, openTorsion's example data, MIT), slider
/// and crank, oscillating mass; shafts with a loss factor of 0.035. Expected: two separate programs (exact Fourier
/// integrals in numpy; Holzer state vectors and midpoint integration in C++), which agree to 2e-8.
#include <drev/app/model_file/model_file.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/solvers/periodic/linear_sweep.hpp>

#include "tests/catch.hpp"
#include "tests/published/six_cylinder_train.hpp"

using namespace drev;
using test::diesel, test::shaft_of, test::train;

TEST_CASE("Six cylinders by their pressure: mean torque", "[engine]") {
  const EngineCylinders engine(diesel("1-4-2-6-3-5"));
  for (const auto& [speed, mean] :
       {std::pair{1000.0, 168.013429}, {1500.0, 174.470086}, {2000.0, 175.451150}, {2500.0, 92.370256}})
    CHECK(engine.mean_torque(3, rpm(speed)) == Approx(mean).epsilon(5e-8));
}

TEST_CASE("Six cylinders by their pressure: half range of the flywheel shaft, both firing orders",
          "[engine]") {
  const std::vector<double> speeds{1000, 1500, 2000, 2175, 2500};
  std::vector<double> in_rad;
  for (const double speed : speeds) in_rad.push_back(rpm(speed));
  const auto sweep_of = [&](const char* order) {
    return sweep_linear(train(0.035, rpm(2000), diesel(order)).build(),
                        {.speeds = in_rad, .refine = false, .threads = 1});
  };
  const LinearSweep sweep = sweep_of("1-4-2-6-3-5");
  const std::vector<double> half{1942.31777, 2822.39112, 4353.69346, 7999.03920, 1293.23206};
  const std::vector<double> other{1942.80660, 2891.99131, 4575.82818, 8049.34251, 1390.61573};
  for (std::size_t s = 0; s < speeds.size(); ++s) {
    INFO(speeds[s]);
    CHECK(shaft_of(sweep, 8).half_range()[Eigen::Index(s)] == Approx(half[s]).epsilon(1e-7));
    CHECK(sweep.input_power[Eigen::Index(s)] ==
          Approx(sweep.dissipated_power[Eigen::Index(s)]).epsilon(1e-11));
  }
  CHECK(sweep.dissipated_power[2] == Approx(762.887192).epsilon(1e-7));
  CHECK(sweep.dissipated_power[3] == Approx(4479.174692).epsilon(1e-7));
  const std::vector<double> each{761.9855, 1153.878, 4571.939, 5683.600,
                                 7022.838, 8077.141, 8168.212, 7999.039};
  for (int i = 1; i <= 8; ++i)
    CHECK(shaft_of(sweep, i).half_range()[3] == Approx(each[std::size_t(i - 1)]).epsilon(1e-6));
  const LinearSweep mirrored = sweep_of("1-5-3-6-2-4");
  for (std::size_t s = 0; s < speeds.size(); ++s)
    CHECK(shaft_of(mirrored, 8).half_range()[Eigen::Index(s)] == Approx(other[s]).epsilon(1e-7));
}

TEST_CASE("The model file of the six-cylinder diesel: half range, and a cylinder that misfires", "[engine]") {
  const app::ModelFile file(DREV_SOURCE_DIR "/models/six_cylinder/six_cylinder.toml", "");
  const auto half_range = [&](const char* misfire) {
    Parameters parameters(file.entry().name, file.entry().parameters);
    parameters.set("misfire", misfire);
    const System system = file.entry().build(parameters).model.build();
    return shaft_of(sweep_linear(system, {.speeds = {rpm(2175.0)}, .refine = false, .threads = 1}), 8)
        .half_range()[0];
  };
  CHECK(half_range("0") == Approx(7999.03920).epsilon(1e-7));
  CHECK(half_range("4") < 0.99 * 7999.03920);
}
