// Exact propagation beside SciPy's solve_ivp (peers/solve_ivp.py) at an error no larger, on the held
// camshaft over 1 s. Processor time of one run, start of the interpreter and reading left out.
//   build/release/bin/bench_scipy
#include "tests/benchmark/peer_files.hpp"

using namespace drev;
using namespace drev::benchmark;

TEST_CASE("SciPy held") {
  const std::string python = benchmark::python();
  if (python.empty()) return;
  Problem p = make_problem("held", false);
  p.duration = p.horizon();
  const ScratchFolder folder;
  write_files(p.chain, folder);
  Drev drev(p);
  print_header(p);
  for (const auto& [method, rtol] : {std::pair{"LSODA", 1e-7}, {"DOP853", 1e-6}}) {
    const auto run = [&, m = method, r = rtol](double t_end, int) {
      std::istringstream text(output_of(python + peer_file("solve_ivp.py") + folder.text() + " " + m + " " +
                                            to_text(r) + " " + to_text(t_end),
                                        folder));
      peers::PeerRun result;
      result.t_end = t_end;
      text >> result.seconds >> result.steps >> result.evaluations;
      for (peers::Sample s; text >> s.t >> s.angle;) result.samples.push_back(s);
      return result;
    };
    compare(p, drev, std::string("SciPy ") + method, rtol, 1, run);
  }
}
