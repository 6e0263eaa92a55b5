#include <drev/core/load.hpp>
#include <drev/core/scalar_force.hpp>
#include <drev/core/units.hpp>
#include <drev/solvers/nonlinear_sweep.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace drev {

const char* to_text(BranchChange change) {
  switch (change) {
    case BranchChange::fold:
      return "fold";
    case BranchChange::contact:
      return "contact opens";
    case BranchChange::period_doubling:
      return "period doubling";
    case BranchChange::torus:
      return "torus";
    case BranchChange::branching:
      return "branching";
  }
  return "";
}

double cycle_turns(const System& system, const std::vector<double>& speeds) {
  constexpr int kMostTurns = 20, kProbes = 4096, kLargestPrime = 499;
  constexpr double kSame = 1e-8, kGolden = 0.6180339887498949, kFewestTurns = 1e-4, kLongestTurns = 100.0;
  const double nominal = system.reference_speed() > 0.0 ? system.reference_speed() : 1.0;
  // All that acts, of angle and speed of the reference shaft, where nothing deviates.
  using Act = std::function<double(double phi, double w)>;
  std::vector<Act> acts;
  std::vector<double> shafts{1.0};  // turns of the reference shaft in one of theirs
  const auto add_shaft = [&shafts](double ratio) {
    if (ratio != 0.0 && std::abs(ratio) != 1.0) shafts.push_back(1.0 / std::abs(ratio));
  };
  for (const ScalarTerm& law : system.scalars()) {
    if (law.phase_node < 0) continue;
    const auto gap = law.force->gap();
    const double edge = gap ? gap->high : 0.0, x = edge > 0.0 ? 2.0 * edge : 1e-4;
    const double ratio = system.ratio(law.phase_node);
    add_shaft(ratio);
    acts.emplace_back([&law, x, ratio](double phi, double w) {
      return law.force
          ->evaluate({.x = x - law.force->offset(ratio * phi).e, .t = phi / w, .angle = ratio * phi})
          .y;
    });
  }
  for (const LoadTerm& load : system.loads()) {
    const double ratio = system.ratio(load.node);
    add_shaft(ratio);
    acts.emplace_back([&load, ratio](double phi, double w) {
      return load.load
          ->evaluate(
              {.t = phi / w, .nominal_angle = ratio * phi, .speed = ratio * w, .nominal_speed = ratio * w})
          .torque;
    });
  }
  // Evenly over the longest cycle, so that no step of a stiffness is passed over.
  const auto probe = [&](int i) {
    const double part = kGolden * i;
    return kMostTurns * kTwoPi * (part - std::floor(part));
  };
  const auto speed = [&](int i) { return speeds.empty() ? nominal : speeds[idx(i) % speeds.size()]; };
  const auto repeats = [&](const Act& f, double turns) {
    double largest = 0.0;
    for (int i = 0; i < kProbes / 16; ++i) largest = std::max(largest, std::abs(f(probe(i), speed(i))));
    for (int i = 0; i < kProbes; ++i)
      if (std::abs(f(probe(i) + turns * kTwoPi, speed(i)) - f(probe(i), speed(i))) > kSame * largest)
        return false;
    return true;
  };
  // What is the same everywhere has no cycle.
  std::erase_if(acts, [&](const Act& f) {
    for (int i = 1; i < kProbes; ++i) {
      const double first = f(probe(0), speed(i));
      if (std::abs(f(probe(i), speed(i)) - first) > kSame * std::abs(first)) return false;
    }
    return true;
  });
  if (acts.empty()) return 1.0;
  const auto all = [&](double turns) {
    return std::all_of(acts.begin(), acts.end(), [&](const Act& f) { return repeats(f, turns); });
  };
  // Whole turns of the reference shaft; then of each shaft on which something acts.
  double turns = 0.0;
  for (const double of_shaft : shafts)
    for (int t = 1; t <= kMostTurns && turns == 0.0; ++t)
      if (t * of_shaft <= kLongestTurns && all(t * of_shaft)) turns = t * of_shaft;
  for (int p = 2; turns > 0.0 && p <= kLargestPrime; ++p)
    while (turns / p > kFewestTurns && all(turns / p)) turns /= p;
  return turns;
}

}  // namespace drev
