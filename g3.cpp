// Masses on springs with a gap each, by average acceleration, 1 ms: microseconds a step, beside what
// FEDEM R8.1.6 took for such chains. FEDEM's figures are from another machine of this kind (61 us a step
// for 2 masses, 1.1 ms for 100, 11.3 ms for 1,000, least output): the ratios are no measurement side by side.
//   build/release/bin/bench_gap_chain
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <string>
#include <vector>

#include "core/system.hpp"
#include "elements/catalogue.hpp"
#include "solvers/transient.hpp"

using namespace drev;

namespace {

/// ground -(k, gap)- m -(k, gap)- m ..., the last mass pulled for 2 s and let go, as in
/// models/two_mass_backlash.
System gap_chain(int masses) {
  Model m("gap chain");
  NodeId last{-1};
  for (int i = 0; i < masses; ++i) {
    const std::string n = std::to_string(i);
    const NodeId node = m.add_node("mass_" + n, NodeKind::translational);
    m.add<Inertia>("m_" + n, {node}, {.inertia = 10.0});
    const PolylineSpring::Params spring = PolylineSpring::dead_band(2000.0, 0.05 / masses);
    if (i == 0)
      m.add<PolylineSpring>("spring_" + n, {node}, spring);
    else
      m.add<PolylineSpring>("spring_" + n, {last, node}, spring);
    last = node;
  }
  m.add<AppliedTorque>("force", {last},
                       {.table = TimeTable({0.0, 1.0, 2.0, 2.0}, {0.0, 100.0, 100.0, 0.0})});
  return m.build();
}

}  // namespace


#include <chrono>
int main(int argc,char**argv){ const System system=gap_chain(std::stoi(argv[1])); std::vector<double> t; for(int r=0;r<41;++r){ State st=State::initial(system,0.0); timespec a,b; clock_gettime(CLOCK_THREAD_CPUTIME_ID,&a); auto s=simulate(system,{.step=1e-3,.t_end=10.0,.energy_tolerance=10.0},st); clock_gettime(CLOCK_THREAD_CPUTIME_ID,&b); t.push_back(1e6*((b.tv_sec-a.tv_sec)+1e-9*(b.tv_nsec-a.tv_nsec))/s.steps);} std::printf("first %.4f ",t[0]); std::sort(t.begin(),t.end()); std::printf("min %.4f median %.4f max %.4f\n",t[0],t[20],t[40]); }
