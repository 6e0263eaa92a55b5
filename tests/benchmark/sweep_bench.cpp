// What linear sweeps cost, in processor time: nine nodes over 1,500 speeds with 24 orders; chains of up to 10,000
// nodes, a frequency, beside one complex factorisation and solution by Eigen's sparse LU.
//   build/release/bin/bench_sweep
#include <drev/core/units.hpp>
#include <drev/solvers/periodic/linear_sweep.hpp>

#include <Eigen/SparseLU>
#include <algorithm>
#include <cstdio>
#include <ctime>

#include "tests/catch.hpp"
#include "tests/problems/engine_chain.hpp"

using namespace drev;

namespace {

/// Least processor time of several calls [ms].
template <class Task>
double milliseconds(int calls, const Task& task) {
  double least = 1e300;
  for (int i = 0; i < calls; ++i) {
    const std::clock_t begin = std::clock();
    task();
    least = std::min(least, 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  return least;
}

}  // namespace

TEST_CASE("Nine nodes, 1,500 speeds, 24 orders") {
  test::EngineChain engine;
  for (int k = 1; k <= 24; ++k) {
    engine.orders.push_back(0.5 * k);
    engine.torque.push_back(std::polar(600.0 / k, 0.3 * k));
  }
  engine.damping_over_stiffness = 2.5e-5;
  const System system = engine.model().build();
  LinearSweepOptions options;
  for (int i = 0; i < 1500; ++i) options.speeds.push_back(rpm(800.0 + 1.2 * i));
  for (std::size_t i = 0; i < 8; ++i) options.sections.push_back(test::EngineChain::shaft(i) + ".torque_Nm");
  for (const bool refine : {false, true}) {
    options.refine = refine;
    const double time = milliseconds(9, [&] { sweep_linear(system, options); });
    std::printf("nine nodes, 1,500 speeds, 24 orders, 8 sections%s: %.1f ms\n",
                refine ? ", with peaks and criticals" : "", time);
  }
}

TEST_CASE("Long chains, a frequency") {
  for (const int n : {100, 1000, 10000}) {
    Model m("chain");
    for (int i = 0; i < n; ++i) {
      const std::string node = "n" + std::to_string(i);
      m.add_node(node);
      m.add<Inertia>("J" + node, {node}, {.inertia = 1.0});
      if (i > 0)
        m.add<ShaftSpring>("k" + std::to_string(i), {"n" + std::to_string(i - 1), node},
                           {.stiffness = 1e6, .damping = 5.0});
    }
    m.add<EngineOrderTorque>("gas", {"n0"}, {.harmonics = {{1.0, 100.0, 0.0}}, .twist_feedback = false});
    m.set_reference("n0", constant_speed(100.0));
    const System system = m.build();
    const int speeds = 200000 / n;
    LinearSweepOptions options{.orders = {1.0}, .sections = {"k1.torque_Nm"}, .refine = false};
    for (int i = 0; i < speeds; ++i) options.speeds.push_back(50.0 + 100.0 * i / speeds);
    const double sweep = milliseconds(3, [&] { sweep_linear(system, options); }) / speeds;
    Eigen::SparseMatrix<std::complex<double>> s = system.pattern().cast<std::complex<double>>();
    for (Eigen::Index e = 0; e < s.nonZeros(); ++e)
      s.valuePtr()[e] = system.stiffness_values()[e] +
                        std::complex<double>(0.0, 77.0) * system.damping_values()[e] -
                        77.0 * 77.0 * system.mass_values()[e];
    Eigen::SparseLU<Eigen::SparseMatrix<std::complex<double>>> lu;
    lu.analyzePattern(s);
    const Eigen::VectorXcd b = Eigen::VectorXcd::Ones(n);
    Eigen::VectorXcd x;
    const double one = milliseconds(5, [&] {
      lu.factorize(s);
      x = lu.solve(b);
    });
    std::printf(
        "%6d nodes: %.4f ms a frequency; factorisation and solution by Eigen's sparse LU %.4f ms: %.2f\n", n,
        sweep, one, sweep / one);
  }
}
