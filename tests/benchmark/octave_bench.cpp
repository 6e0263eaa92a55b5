// Average acceleration at h = 1 ms beside the source's program style in Octave (peers/camshaft.m): dense
// matrices, full Newton, tables by interp1, cam by cam; the same with a direct look-up in the table; and both
// with all cams of a kind in one call. Processor time a step, start of the interpreter and reading left out;
// medians of 3 runs by turns (drev's over 5 s).
//   build/release/bin/bench_octave
#include <drev/solvers/stepping/transient.hpp>

#include "tests/benchmark/peer_files.hpp"

using namespace drev;
using namespace drev::benchmark;

namespace {

constexpr double kStep = 1e-3, kDuration = 5.0;

RunSummary drev_run(const Problem& p, double t_end, const std::vector<Observer*>& observers = {}) {
  const RunSummary r =
      simulate(p.system, {.step = kStep, .t_end = t_end, .energy_tolerance = 1e9}, observers);
  INFO(r.reason);
  REQUIRE(r.ok());
  return r;
}

/// compared: horizon over which the free end's angle must be the same [s].
void measure(const char* drive, double compared) {
  const std::string octave = benchmark::octave();
  if (octave.empty()) return;
  const Problem p = make_problem(drive, false);
  const ScratchFolder folder;
  write_files(p.chain, folder);
  EndAngle end(p, 1000000);  // every step
  drev_run(p, kDuration, {&end});
  struct Variant {
    const char* look_up;
    const char* calls;
    double duration;
    const char* wanted;  // ratio
  };
  for (const auto& [look_up, calls, duration, wanted] :
       {Variant{"interp1", "each", 0.1, " (wanted: 10000 times)"},
        {"direct", "each", 0.5, " (wanted: 700 times)"},
        {"interp1", "all", 0.5, ""},
        {"direct", "all", 5.0, ""}}) {
    std::vector<double> own, peer;
    double worst = 0.0, peak = 0.0;
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 20; ++k) {
        const std::clock_t start = std::clock();
        const RunSummary r = drev_run(p, kDuration);
        own.push_back(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC /
                      static_cast<double>(r.steps));
      }
      std::istringstream text(output_of(octave + " --norc --quiet" + peer_file("camshaft.m") + folder.text() +
                                            " " + look_up + " " + calls + " " + to_text(kStep) + " " +
                                            to_text(duration),
                                        folder));
      double seconds = 0.0, angle = 0.0;
      long steps = 0;
      text >> seconds >> steps;
      peer.push_back(seconds / static_cast<double>(steps));
      for (std::size_t k = 0; text >> angle; ++k) {
        REQUIRE(k < end.samples.size());
        peak = std::max(peak, std::abs(end.samples[k].angle));
        if (end.samples[k].t <= compared) worst = std::max(worst, std::abs(angle - end.samples[k].angle));
      }
    }
    CHECK(worst / peak < 1e-6);
    report(std::string("a step of 1 ms, ") + drive,
           std::string("Octave, ") + look_up + (calls == std::string("each") ? ", cam by cam" : ", vectors"),
           median(own), median(peer), "same answer to " + join({worst / peak}) + wanted);
  }
}

}  // namespace

TEST_CASE("Octave held") { measure("held", kDuration); }
// The rattle amplifies rounding a decade in 59 ms.
TEST_CASE("Octave gears") { measure("gears", 0.05); }
