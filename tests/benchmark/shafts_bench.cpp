// Ten modes of a whole shaft as one sparse system, by drev and by SciPy's eigsh (ARPACK and SuperLU) on the same matrices,
// and what chains of segments make of them. Processor time and peak memory.
//   build/release/bin/bench_shafts                     up to 1.2e6 unknowns, SciPy's up to 3e5
//   build/release/bin/bench_shafts "Large:*"           1.2e6 with SciPy's (minutes)
//   build/release/bin/bench_shafts "Larger:*"          3.0e6 (4 GB)
#include <drev/elements/catalogue.hpp>
#include <drev/models/shafts/contour_shaft.hpp>
#include <drev/solvers/modes/modes.hpp>

#include <cstdio>
#include <ctime>
#include <fstream>
#include <sstream>

#include "models/shafts/whole_shaft.hpp"
#include "tests/benchmark/peer_files.hpp"

using namespace drev;
using namespace drev::benchmark;

namespace {

constexpr int kModes = 10;

double shaft_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Peak of the resident memory [MB]; reset to the present where the system allows.
double peak_memory(bool reset) {
  if (reset) std::ofstream("/proc/self/clear_refs") << "5";
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == "VmHWM:") {
      double kilobytes = 0.0;
      status >> kilobytes;
      return kilobytes / 1024.0;
    }
  return 0.0;
}

/// Throws of a plain stepped shaft: necks of 160 mm, journals and collars of 240 mm.
ShaftContour stepped_shaft(int throws = 6) {
  ShaftContour contour{.shear_modulus = 8e10, .density = 7850.0};
  for (int i = 0; i < throws; ++i)
    for (const auto& [length, diameter] : {std::pair{0.06, 0.16}, {0.12, 0.24}, {0.06, 0.16}, {0.1, 0.22}})
      contour.stations.push_back(
          {.length = length,
           .outer_diameter = diameter,
           .fillet_start = diameter < 0.2 && i + length > 0.0 && !contour.stations.empty() ? 0.008 : 0.0,
           .fillet_end = diameter < 0.2 ? 0.008 : 0.0});
  return contour;
}

void print_chain(const char* name, const std::vector<double>& whole, const std::function<void(Model&)>& add) {
  Model m("shaft");
  m.add_node("a");
  m.add_node("b");
  add(m);
  const System system = m.build();
  const std::vector<double> f = solve_modes(system, {.count = kModes}).frequency_Hz;
  std::printf("%-44s %4d unknowns, off by [%%]:", name, system.size());
  for (std::size_t i = 0; i < f.size() && i < whole.size(); ++i)
    std::printf(" %.2f", 100.0 * (f[i] / whole[i] - 1.0));
  std::printf("\n");
}

template <class T>
void write_raw(std::ofstream& file, const T* values, long count) {
  file.write(reinterpret_cast<const char*>(values), static_cast<std::streamsize>(sizeof(T)) * count);
}

/// A row of the table; SciPy's where a Python is named.
std::vector<double> print_whole(const ShaftContour& contour, int halvings, const std::string& python) {
  peak_memory(true);
  const double start = shaft_seconds();
  const WholeShaft shaft = whole_shaft(contour, halvings);
  const double assembled = shaft_seconds();
  const WholeShaftModes modes = whole_shaft_modes(shaft, kModes);
  const double solved = shaft_seconds();
  std::printf("%8d; %.2f + %.2f s, %.0f MB, %d solves", modes.unknowns, assembled - start, solved - assembled,
              peak_memory(false), modes.solves);
  std::fflush(stdout);
  if (!python.empty()) {
    const ScratchFolder folder;
    {
      const SparseMatrix& k = shaft.stiffness;
      std::ofstream file(folder.text() + "/shaft.bin", std::ios::binary);
      const long size[2] = {k.rows(), k.nonZeros()};
      write_raw(file, size, 2);
      write_raw(file, k.outerIndexPtr(), k.rows() + 1);
      write_raw(file, k.innerIndexPtr(), k.nonZeros());
      write_raw(file, k.valuePtr(), k.nonZeros());
      write_raw(file, shaft.mass.data(), k.nonZeros());
    }
    std::istringstream text(output_of(python + peer_file("shaft_modes.py") + folder.text() + "/shaft.bin " +
                                          to_text(whole_shaft_shift(shaft)) + " " + std::to_string(kModes),
                                      folder));
    double seconds = 0.0, memory = 0.0, off = 0.0, f = 0.0;
    text >> seconds >> memory;
    for (std::size_t i = 0; i < modes.frequency_Hz.size() && text >> f; ++i)
      off = std::max(off, std::abs(f / modes.frequency_Hz[i] - 1.0));
    std::printf("; %.2f s, %.0f MB; %.1e", seconds, memory, off);
  }
  std::printf("\n");
  std::fflush(stdout);
  return modes.frequency_Hz;
}

}  // namespace

TEST_CASE("Large: modes of a whole shaft", "[.]") { print_whole(stepped_shaft(), 3, benchmark::python()); }

TEST_CASE("Larger: modes of a whole shaft", "[.]") { print_whole(stepped_shaft(15), 3, ""); }

TEST_CASE("Modes of a whole shaft") {
  const std::string python = benchmark::python();
  const ShaftContour contour = stepped_shaft();
  std::vector<double> whole_Hz;
  std::printf(
      "unknowns; assembly, factor and ten modes [s], peak memory [MB]; SciPy's the same; largest "
      "difference\n");
  for (int halvings = 1; halvings <= 3; ++halvings)
    whole_Hz =
        print_whole(contour, halvings, halvings <= 2 ? python : "");  // SuperLU takes minutes with the third
  std::printf("whole shaft [Hz]:");
  for (const double f : whole_Hz) std::printf(" %.2f", f);
  std::printf("\n");
  const auto by_contour = [&](const char* name, double up_to, SegmentMass mass) {
    ShaftContour c = contour;
    c.up_to_frequency = up_to;
    c.mass = mass;
    print_chain(name, whole_Hz, [&](Model& m) { m.add<ContourShaft>("shaft", {"a", "b"}, c); });
  };
  by_contour("contour, a lumped segment each station", kNotGiven, SegmentMass::lumped);
  by_contour("contour, an averaged segment each station", kNotGiven, SegmentMass::averaged);
  by_contour("contour, averaged, to 1e-3 up to 8 kHz", 8000.0, SegmentMass::averaged);
  print_chain("distributed shafts, each with its own J", whole_Hz, [&](Model& m) {
    const std::size_t n = contour.stations.size();
    for (std::size_t k = 0; k < n; ++k) {
      const std::string from = k == 0 ? "a" : "n" + std::to_string(k),
                        to = k + 1 == n ? "b" : "n" + std::to_string(k + 1);
      if (k + 1 < n) m.add_node(to);
      m.add<DistributedShaft>("s" + std::to_string(k), {from, to},
                              {.shear_modulus = 8e10,
                               .density = 7850.0,
                               .outer_diameter = contour.stations[k].outer_diameter,
                               .length = contour.stations[k].length,
                               .segments = 4,
                               .mass = SegmentMass::averaged});
    }
  });
}
