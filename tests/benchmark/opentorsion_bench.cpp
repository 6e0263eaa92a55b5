// Six-cylinder diesel, 800 to 2,600 rpm by 10 rpm, 24 orders, beside openTorsion (peers/engine_orders.py), whose example
// the engine is: the same torques on both sides, viscous shafts, which both have. drev also finds the sum of all
// orders over the cycle, twists, heat, peaks and criticals; what openTorsion prints is the sum of amplitudes.
// Processor time, medians of runs by turns; start of the interpreter and building the model left out on both sides.
//   build/release/bin/bench_opentorsion
// Package: pip install opentorsion; another interpreter by DREV_OPENTORSION.
#include <drev/core/units.hpp>
#include <drev/solvers/periodic/linear_sweep.hpp>

#include <algorithm>
#include <ctime>

#include "tests/benchmark/peer_files.hpp"
#include "tests/problems/engine_chain.hpp"

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

}  // namespace

TEST_CASE("Six cylinders beside openTorsion") {
  const std::string python = interpreter("DREV_OPENTORSION", {"python3"}, "-c 'import opentorsion'",
                                         "openTorsion (pip install opentorsion)");
  if (python.empty()) return;
  const test::EngineChain engine = six_cylinders();
  REQUIRE(engine.orders.size() == 24);
  const System system = engine.model().build();
  LinearSweepOptions options{.orders = engine.orders, .threads = 1};
  for (int n = 800; n <= 2600; n += 10) options.speeds.push_back(rpm(n));
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
  std::vector<double> own, peer;
  double off = 0.0;
  for (int turn = 0; turn < 3; ++turn) {
    constexpr int kRepeats = 5;
    const std::clock_t begin = std::clock();
    for (int i = 0; i < kRepeats; ++i) sweep = sweep_linear(system, options);
    own.push_back(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC / kRepeats);
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
  std::nth_element(own.begin(), own.begin() + 1, own.end());
  std::nth_element(peer.begin(), peer.begin() + 1, peer.end());
  std::ostringstream remark;
  remark << "sums of amplitudes differ by " << off << " at the most; drev finds peaks and criticals, too";
  report("six-cylinder diesel, 181 speeds, 24 orders", "openTorsion", own[1], peer[1], remark.str());
}
