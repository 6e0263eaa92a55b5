// Six-cylinder diesel, 800 to 2,600 rpm by 10 rpm, 24 orders, beside openTorsion, whose example the engine is:
// - its example (peers/engine_example.py): torque from measured pressure at each speed, shafts with a loss factor;
// - given torques and viscous shafts (peers/engine_orders.py): its response alone.
// drev also finds the sum of all orders over the cycle with its extremes, twists, heat, power, and (the second time)
// peaks and criticals; what openTorsion prints is the sum of amplitudes.
// Processor time of one thread, medians of runs by turns; start of the interpreter and building the model left out on both
// sides. Of the example also the time by the clock, as both run by themselves: drev on all processors.
//   build/release/bin/bench_opentorsion
// Package: pip install opentorsion; another interpreter by DREV_OPENTORSION.
#include <drev/core/units.hpp>
#include <drev/solvers/periodic/linear_sweep.hpp>

#include <algorithm>
#include <chrono>
#include <ctime>

#include "tests/benchmark/peer_files.hpp"
#include "tests/problems/engine_chain.hpp"
#include "tests/problems/sampled_cylinder.hpp"

using namespace drev;
using namespace drev::benchmark;

namespace {

/// The torques of a cylinder at 2,000 rpm, by orders.
test::EngineChain six_cylinders() {
  test::EngineChain engine;
  engine.damping_over_stiffness = 0.035 / (kTwoPi * 216.58360524);
  std::ifstream file(DREV_SOURCE_DIR "/tests/published/data/six_cylinder_orders.csv");
  std::string line;
  while (std::getline(file, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    double speed = 0.0, order = 0.0, gas_re = 0.0, gas_im = 0.0, mass_re = 0.0, mass_im = 0.0;
    if (!(words >> speed >> order >> gas_re >> gas_im >> mass_re >> mass_im) || speed != 2000.0) continue;
    engine.orders.push_back(order);
    engine.torque.emplace_back(gas_re + mass_re, gas_im + mass_im);
  }
  return engine;
}

/// Time of a sweep [s], median of several calls: of the processor, and by the clock.
struct Seconds {
  double processor, clock;
};
Seconds seconds_of(const System& system, const LinearSweepOptions& options, LinearSweep& sweep) {
  constexpr int kRepeats = 15;
  std::vector<double> processor, clock;
  for (int i = 0; i < kRepeats; ++i) {
    const std::clock_t begin = std::clock();
    const auto start = std::chrono::steady_clock::now();
    sweep = sweep_linear(system, options);
    clock.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    processor.push_back(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  return {median(processor), median(clock)};
}

/// 800 to 2,600 rpm of the engine, times `factor` [rad/s].
std::vector<double> engine_speeds(double factor) {
  std::vector<double> speeds;
  for (int n = 800; n <= 2600; n += 10) speeds.push_back(factor * rpm(n));
  return speeds;
}

}  // namespace

TEST_CASE("Six cylinders as in openTorsion's example") {
  const std::string python = interpreter("DREV_OPENTORSION", {"python3"}, "-c 'import opentorsion'",
                                         "openTorsion (pip install opentorsion)");
  if (python.empty()) return;
  const test::SampledCylinder::Curves curves = test::sampled_curves(test::measured_pressure());
  const System system = test::sampled_engine(curves).build();
  LinearSweepOptions options{.speeds = engine_speeds(test::SampledCylinder::kSlower), .threads = 1};
  for (std::size_t i = 0; i < 8; ++i) options.sections.push_back(test::EngineChain::shaft(i) + ".torque_Nm");
  const std::string folder = std::string(DREV_SOURCE_DIR) + "/models/six_cylinder/";
  std::string command =
      python + peer_file("engine_example.py") + folder + "pressure.csv " + folder + "peak_pressure.csv";
  for (int n = 800; n <= 2600; n += 10) command += " " + std::to_string(n);
  const ScratchFolder scratch;
  std::vector<double> plain, with_peaks, by_elements, by_matrices, on_all, by_clock;
  double off = 0.0;
  for (int turn = 0; turn < 3; ++turn) {
    LinearSweep sweep;
    options.refine = true;
    with_peaks.push_back(seconds_of(system, options, sweep).processor);
    options.refine = false;
    options.threads = 0;
    on_all.push_back(seconds_of(system, options, sweep).clock);
    options.threads = 1;
    plain.push_back(seconds_of(system, options, sweep).processor);
    std::istringstream text(output_of(command, scratch));
    double seconds = 0.0;
    text >> seconds;
    by_elements.push_back(seconds);
    text >> seconds;
    by_clock.push_back(seconds);
    text >> seconds;
    by_matrices.push_back(seconds);
    text >> seconds;
    for (std::size_t s = 0; s < options.speeds.size(); ++s)
      for (std::size_t c = 0; c < sweep.sections.size(); ++c) {
        double sum = 0.0;
        REQUIRE(text >> sum);
        const double here = test::EngineChain::kStiffnesses[c] *
                            sweep.sections[c].twist.col(static_cast<Eigen::Index>(s)).cwiseAbs().sum();
        off = std::max(off, std::abs(sum - here) / here);
      }
  }
  CHECK(off < 1e-9);
  std::ostringstream remark;
  remark << "sums of amplitudes differ by " << off << " at the most";
  const std::string job = "openTorsion's example of a diesel, 181 speeds, 24 orders";
  report(job, "openTorsion, as its example", median(plain), median(by_elements), remark.str());
  report(job + ", by the clock, drev on all processors", "openTorsion, as its example", median(on_all),
         median(by_clock), "");
  report(job + ", with peaks and criticals", "openTorsion, as its example", median(with_peaks),
         median(by_elements), "");
  report(job, "openTorsion, damping of two matrices", median(plain), median(by_matrices), "");
}

TEST_CASE("Six cylinders beside openTorsion") {
  const std::string python = interpreter("DREV_OPENTORSION", {"python3"}, "-c 'import opentorsion'",
                                         "openTorsion (pip install opentorsion)");
  if (python.empty()) return;
  const test::EngineChain engine = six_cylinders();
  REQUIRE(engine.orders.size() == 24);
  const System system = engine.model().build();
  LinearSweepOptions options{.orders = engine.orders, .threads = 1};
  options.speeds = engine_speeds(1.0);
  for (std::size_t i = 0; i < 8; ++i) options.sections.push_back(test::EngineChain::shaft(i) + ".torque_Nm");

  const ScratchFolder folder;
  {
    std::ofstream file(folder / "engine.txt");
    file.precision(17);
    const auto row = [&](const auto& values) {
      for (const double value : values) file << value << ' ';
      file << '\n';
    };
    row(engine.kInertias);
    row(engine.kStiffnesses);
    for (const double k : engine.kStiffnesses) file << engine.damping_over_stiffness * k << ' ';
    file << '\n';
    for (int i = 0; i < 9; ++i) file << (i < 2 || i > 7 ? 0.0 : engine.ground_damping) << ' ';
    file << '\n';
    row(options.speeds);
    row(engine.orders);
    for (std::size_t k = 0; k < engine.orders.size(); ++k) {
      for (std::size_t i = 0; i < 9; ++i) {
        const bool fires = i >= 2 && i <= 7;
        const std::complex<double> torque =
            fires ? engine.torque[k] * std::polar(1.0, -engine.orders[k] * deg(engine.kFiring[i - 2])) : 0.0;
        file << torque.real() << ' ' << torque.imag() << ' ';
      }
      file << '\n';
    }
  }
  LinearSweep sweep;
  std::vector<double> own, with_peaks, peer;
  double off = 0.0;
  for (int turn = 0; turn < 3; ++turn) {
    options.refine = true;
    with_peaks.push_back(seconds_of(system, options, sweep).processor);
    options.refine = false;
    own.push_back(seconds_of(system, options, sweep).processor);
    std::istringstream text(
        output_of(python + peer_file("engine_orders.py") + (folder / "engine.txt"), folder));
    double seconds = 0.0;
    text >> seconds;
    peer.push_back(seconds);
    for (std::size_t s = 0; s < options.speeds.size(); ++s)
      for (std::size_t c = 0; c < sweep.sections.size(); ++c) {
        double sum = 0.0;
        REQUIRE(text >> sum);
        // openTorsion's is the stiffness's part of the torque.
        const double here = engine.kStiffnesses[c] *
                            sweep.sections[c].twist.col(static_cast<Eigen::Index>(s)).cwiseAbs().sum();
        off = std::max(off, std::abs(sum - here) / here);
      }
  }
  CHECK(off < 1e-9);
  std::ostringstream remark;
  remark << "sums of amplitudes differ by " << off << " at the most";
  const std::string job = "six-cylinder diesel, given torques, viscous shafts, 181 speeds, 24 orders";
  report(job, "openTorsion", median(own), median(peer), remark.str());
  report(job + ", with peaks and criticals", "openTorsion", median(with_peaks), median(peer), "");
}
