#include <drev/core/error.hpp>
#include <drev/models/gears/load_law.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

namespace drev {
namespace {

/// The penetration at which a force that grows with it has a value, by the secant rule within a bracket.
double penetration_of(double load, double guess, const std::function<double(double)>& force) {
  constexpr int kMostSteps = 100;
  double low = 0.0, high = guess, at_low = 0.0, at_high = force(high);
  for (int i = 0; at_high < load && i < kMostSteps; ++i)
    low = high, at_low = at_high, high *= 2.0, at_high = force(high);
  if (!(at_high >= load))
    throw ModelError({{"mesh cycle", "loads", to_text(load), "N/m", "is more than the teeth carry"}});
  for (int i = 0; i < kMostSteps && high - low > 1e-12 * high; ++i) {
    const double part = std::clamp((load - at_low) / (at_high - at_low), 0.01, 0.99);
    const double middle = low + part * (high - low), here = force(middle);
    (here < load ? low : high) = middle;
    (here < load ? at_low : at_high) = here;
  }
  return high;
}

void check_loads(const std::vector<double>& loads) {
  constexpr std::size_t kMostLoads = 20;
  std::vector<Finding> findings;
  ParameterCheck check("mesh cycle", findings);
  if (loads.empty() || loads.size() > kMostLoads)
    check.fail("loads", std::to_string(loads.size()), "", "must be 1 to " + std::to_string(kMostLoads));
  for (std::size_t i = 0; i < loads.size(); ++i) {
    check.positive("loads[" + std::to_string(i) + "]", loads[i], "N/m");
    if (i > 0 && !(loads[i] > 1.01 * loads[i - 1]))
      check.fail("loads[" + std::to_string(i) + "]", to_text(loads[i]), "N/m",
                 "must be more than the one before it, " + to_text(loads[i - 1]) + ", by 1 % at least");
  }
  if (!findings.empty()) throw ModelError(std::move(findings));
}

class ErrorSum {
 public:
  void add(double value, double exact) {
    const double off = std::abs(value / exact - 1.0);
    squares_ += off * off;
    most_ = std::max(most_, off);
    ++count_;
  }
  LoadLawError result() const { return {std::sqrt(squares_ / count_), most_}; }

 private:
  double squares_ = 0.0, most_ = 0.0;
  int count_ = 0;
};

}  // namespace

GearLoadLaw gear_load_law(const MeshCycle& cycle, const std::vector<double>& loads) {
  check_loads(loads);
  const auto count = static_cast<std::size_t>(cycle.options().points);
  const double load = cycle.options().load, guess = cycle.figures().error_mean;
  GearLoadLaw law;
  law.loads = loads;
  std::vector<double> secant;  // of the cycle under its load
  for (std::size_t i = 0; i < count; ++i) {
    law.phases.push_back(cycle.points()[i].phase);
    secant.push_back(cycle.points()[i].secant);
  }
  const auto mean_force = [&](double p) {
    double sum = 0.0;
    for (const double phase : law.phases) sum += cycle.force(phase, p);
    return sum / static_cast<double>(count);
  };
  const double working = penetration_of(load, guess, mean_force);
  for (const double phase : law.phases) law.stiffness.push_back(cycle.force(phase, working) / working);
  const auto spring = [&](double p) {
    double sum = 0.0;
    for (std::size_t i = 0; i < count; ++i) sum += cycle.force(law.phases[i], p) / law.stiffness[i];
    return sum / static_cast<double>(count);
  };
  // Stretches up to each load, and on from the last as far again.
  std::vector<double> ends{0.0}, values{0.0};
  for (const double each : loads) ends.push_back(penetration_of(each, guess, mean_force));
  ends.push_back(2.0 * ends.back());
  for (std::size_t i = 1; i < ends.size(); ++i) values.push_back(spring(ends[i]));
  double unit = 1.0;  // the slope at the mean load
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const double slope = (values[i + 1] - values[i]) / (ends[i + 1] - ends[i]);
    law.penetrations.push_back(ends[i]);
    law.slopes.push_back(slope);
    if (ends[i] < working) unit = slope;
  }
  for (double& slope : law.slopes) slope /= unit;
  for (double& k : law.stiffness) k *= unit;
  // On each stretch between the lowest and the highest load, ends and two places between.
  ErrorSum own, constant;
  for (std::size_t i = 1; i + 1 < ends.size(); ++i)
    for (const double part : {0.0, 1.0 / 3.0, 2.0 / 3.0}) {
      if (i + 2 == ends.size() && part > 0.0) break;
      const double p = ends[i] + part * (ends[i + 1] - ends[i]);
      const double s = (values[i] + part * (values[i + 1] - values[i])) / unit;
      for (std::size_t j = 0; j < count; ++j) {
        const double exact = cycle.force(law.phases[j], p);
        own.add(law.stiffness[j] * s, exact);
        constant.add(secant[j] * p, exact);
      }
    }
  law.error = own.result();
  law.constant = constant.result();
  return law;
}

}  // namespace drev
