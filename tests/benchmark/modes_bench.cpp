// The ten lowest modes: a small model beside LAPACK's dense solvers of K x = lambda M x, chains beside
// SciPy's eigsh in shift-invert at the same shift (peers/modes.py). Processor time, medians of repetitions
// by turns; what has built the matrices is left out on both sides.
//   build/release/bin/bench_modes
#include <drev/solvers/modes/modes.hpp>

#include "tests/benchmark/peer_files.hpp"

using namespace drev;
using namespace drev::benchmark;

extern "C" {
void dsygv_(const int* itype, const char* jobz, const char* uplo, const int* n, double* a, const int* lda,
            double* b, const int* ldb, double* w, double* work, const int* lwork, int* info);
void dsygvd_(const int* itype, const char* jobz, const char* uplo, const int* n, double* a, const int* lda,
             double* b, const int* ldb, double* w, double* work, const int* lwork, int* iwork,
             const int* liwork, int* info);
}

namespace {

constexpr int kCount = 10;
constexpr int kChains[] = {20000, 200000, 1000000};

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

Eigen::MatrixXd dense(const System& s, const Vector& values) {
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(s.size(), s.size());
  for (int j = 0; j < s.size(); ++j)
    for (int slot = s.pattern().outerIndexPtr()[j]; slot < s.pattern().outerIndexPtr()[j + 1]; ++slot)
      m(s.pattern().innerIndexPtr()[slot], j) = values[slot];
  return m;
}

/// Largest relative difference of frequencies [rad/s], with the rigid modes ahead of them.
double off(const ModeSet& modes, const std::vector<double>& omegas) {
  double worst = 0.0;
  for (int k = 0; k < kCount; ++k)
    worst = std::max(
        worst, std::abs(omegas[static_cast<std::size_t>(modes.rigid_modes + k)] / modes.omega(k) - 1.0));
  return worst;
}

}  // namespace

TEST_CASE("Modes of the camshaft") {
  Parameters parameters("camshaft", camshaft_entry().parameters);
  parameters.set("drive", "free");
  const System system = camshaft_entry().build(parameters).model.build();
  const int n = system.size(), one = 1, work_size = 10 * n * n, iwork_size = 10 * n;
  const Eigen::MatrixXd k = dense(system, system.stiffness_values());
  const Eigen::MatrixXd m = dense(system, system.mass_values());
  std::vector<double> w(static_cast<std::size_t>(n)), work(static_cast<std::size_t>(work_size));
  std::vector<int> iwork(static_cast<std::size_t>(iwork_size));
  const auto lapack = [&](bool divide, const char* vectors) {
    Eigen::MatrixXd a = k, b = m;
    int info = 0;
    if (divide)
      dsygvd_(&one, vectors, "L", &n, a.data(), &n, b.data(), &n, w.data(), work.data(), &work_size,
              iwork.data(), &iwork_size, &info);
    else
      dsygv_(&one, vectors, "L", &n, a.data(), &n, b.data(), &n, w.data(), work.data(), &work_size, &info);
    REQUIRE(info == 0);
  };
  ModeSet modes;
  std::vector<double> own, qr, divide;
  const auto timed = [](std::vector<double>& times, const auto& work_done) {
    constexpr int kRepeats = 20;
    const double start = processor_seconds();
    for (int i = 0; i < kRepeats; ++i) work_done();
    times.push_back((processor_seconds() - start) / kRepeats);
  };
  for (int i = 0; i < 51; ++i) {
    timed(own, [&] { modes = solve_modes(system, {.count = kCount}); });
    timed(qr, [&] { lapack(false, "V"); });
    timed(divide, [&] { lapack(true, "V"); });
  }
  for (double& x : w) x = std::sqrt(std::abs(x));
  const std::string problem = "10 modes, free camshaft, n = " + std::to_string(n);
  CHECK(off(modes, w) < 1e-9);
  report(problem, "LAPACK dsygv", median(own), median(qr),
         "same to " + join({off(modes, w)}) + " (wanted: 1)");
  report(problem, "LAPACK dsygvd", median(own), median(divide), "(wanted: 1)");
}

TEST_CASE("Modes of chains") {
  const std::string python = benchmark::python();
  if (python.empty()) return;
  const ScratchFolder folder;
  for (const int n : kChains) {
    Model model("chain");
    std::string last = "held";
    model.add_node(last);
    model.constant_speed(last, 0.0);
    for (int i = 0; i < n; ++i) {
      const std::string node = "n" + std::to_string(i);
      model.add_node(node);
      model.add<Inertia>("J" + node, {node}, {.inertia = 1.0 + 0.5 * std::sin(2.3 * i)});
      model.add<ShaftSpring>("k" + node, {last, node}, {.stiffness = 1e6 * (1.0 + 0.3 * std::sin(1.7 * i))});
      last = node;
    }
    const System system = model.build();
    {
      std::vector<double> columns(static_cast<std::size_t>(3 * n));
      for (int j = 0; j < n; ++j) {
        const auto* pattern = &system.pattern();
        for (int slot = pattern->outerIndexPtr()[j]; slot < pattern->outerIndexPtr()[j + 1]; ++slot) {
          const int i = pattern->innerIndexPtr()[slot];
          if (i == j) columns[static_cast<std::size_t>(j)] = system.mass_values()[slot];
          if (i == j) columns[static_cast<std::size_t>(n + j)] = system.stiffness_values()[slot];
          if (i == j + 1) columns[static_cast<std::size_t>(2 * n + i)] = system.stiffness_values()[slot];
        }
      }
      std::ofstream file(folder / "chain.bin", std::ios::binary);
      file.write(reinterpret_cast<const char*>(columns.data()),
                 static_cast<std::streamsize>(columns.size() * sizeof(double)));
    }
    ModeSet modes;
    std::vector<double> own, peer, omegas(kCount);
    const int turns = n < 100000 ? 5 : 3;
    for (int i = 0; i < turns; ++i) {
      const double start = processor_seconds();
      modes = solve_modes(system, {.count = kCount});
      own.push_back(processor_seconds() - start);
      std::istringstream text(output_of(python + peer_file("modes.py") + folder / "chain.bin" + " " +
                                            std::to_string(n) + " " + std::to_string(kCount) + " " +
                                            to_text(modes.summary.shift),
                                        folder));
      text >> peer.emplace_back();
      for (double& omega : omegas) text >> omega;
    }
    CHECK(off(modes, omegas) < 1e-6);
    report("10 modes, chain of " + std::to_string(n), "SciPy eigsh", median(own), median(peer),
           "same to " + join({off(modes, omegas)}) + ", " + std::to_string(modes.summary.solves) +
               " solves (wanted: 1.7)");
  }
}
