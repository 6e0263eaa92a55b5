#pragma once
/// Peers in other languages: what they read, and running them.
///
/// A folder of plain text, from the chain that make_chain() has checked against drev:
///   M.txt C.txt K.txt   n x n by rows [kg m^2, N m s/rad, N m/rad]
///   tables.txt          a column for each load table, evenly spaced over a turn from 0 [N m]
///   loads.txt           row, table (both from 1), phase [rad]
///   meshes.txt          stiffness [N/m], half gap [m], n arms [m]; no file where there are none
///   run.txt             nominal speed [rad/s], row of the free end (from 1)
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <unistd.h>

#include "tests/benchmark/peer_harness.hpp"

namespace drev::benchmark {

/// A folder that goes with its owner.
class ScratchFolder {
 public:
  ScratchFolder()
      : path_(std::filesystem::temp_directory_path() / ("drev_peers_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  std::string text() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

inline void write_files(const Chain& c, const ScratchFolder& folder) {
  const auto write = [&](const char* name, int rows, int columns, const auto& value) {
    std::ofstream file(folder / (std::string(name) + ".txt"));
    file.precision(17);
    for (int i = 0; i < rows; ++i)
      for (int j = 0; j < columns; ++j) file << value(i, j) << (j + 1 == columns ? '\n' : ' ');
  };
  const auto diagonal = [&](const char* name, const auto& value) {
    write(name, c.n, c.n, [&](int i, int j) { return i == j ? value(i) : 0.0; });
  };
  diagonal("M", [&](int i) { return c.inertia[i]; });
  diagonal("C", [&](int i) { return c.damping[i] * c.inertia[i]; });
  write("K", c.n, c.n, [&](int i, int j) {
    const double* part = i == j ? c.main : i == j + 1 ? c.low : i == j - 1 ? c.up : nullptr;
    return part ? part[i] * c.inertia[i] : 0.0;
  });
  const int tables = static_cast<int>(c.value.size()) / c.knots;
  write("tables", c.knots, tables,
        [&](int i, int j) { return c.value[static_cast<std::size_t>(j * c.knots + i)]; });
  std::vector<int> loaded;
  for (int i = 0; i < c.n; ++i)
    if (c.load[i] != 0.0) loaded.push_back(i);
  write("loads", static_cast<int>(loaded.size()), 3, [&](int k, int j) {
    const int i = loaded[static_cast<std::size_t>(k)];
    return j == 0 ? i + 1.0 : j == 1 ? c.table[i] / c.knots + 1.0 : c.phase[i];
  });
  if (!c.meshes.empty())
    write("meshes", static_cast<int>(c.meshes.size()), 2 + c.n, [&](int k, int j) {
      const peers::Mesh& m = c.meshes[static_cast<std::size_t>(k)];
      if (j < 2) return j == 0 ? m.k : m.half_gap;
      return j - 2 == m.a ? m.arm_a : j - 2 == m.b ? m.arm_b : 0.0;
    });
  write("run", 1, 2, [&](int, int j) { return j == 0 ? c.omega : c.end + 1.0; });
}

/// The first of these programs (what the environment variable names goes first) that does `probe`; empty and
/// a line that says so where there is none.
inline std::string interpreter(const char* variable, std::vector<std::string> programs, const char* probe,
                               const char* what) {
  if (const char* given = std::getenv(variable)) programs.insert(programs.begin(), given);
  for (const std::string& program : programs)
    if (std::system((program + " " + probe + " < /dev/null > /dev/null 2>&1").c_str()) == 0) return program;
  std::printf("left out: %s, or name it by %s\n", what, variable);
  return "";
}
inline std::string octave() {
  return interpreter("DREV_OCTAVE", {"octave-cli", "octave"}, "--norc --quiet --eval 1",
                     "Octave (package octave)");
}
inline std::string python() {
  return interpreter("DREV_PYTHON", {"python3", "/usr/bin/python3"}, "-c 'import scipy'",
                     "SciPy (package python3-scipy)");
}
inline std::string peer_file(const char* name) {
  return std::string(" " DREV_SOURCE_DIR "/tests/benchmark/peers/") + name + " ";
}

/// Everything that a program prints; one thread. Fails the test if it fails. (What octave-cli 7 complains of
/// when it ends means nothing.)
inline std::string output_of(const std::string& command, const ScratchFolder& folder) {
  const std::string complaints = folder / "complaints";
  std::FILE* pipe =
      popen(("OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 " + command + " 2> " + complaints).c_str(), "r");
  REQUIRE(pipe);
  std::string text;
  char part[4096];
  while (const std::size_t n = std::fread(part, 1, sizeof part, pipe)) text.append(part, n);
  const int status = pclose(pipe);
  std::ostringstream why;
  why << std::ifstream(complaints).rdbuf();
  INFO(command << "\n" << why.str());
  REQUIRE(status == 0);
  return text;
}

}  // namespace drev::benchmark
