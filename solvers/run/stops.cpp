#include "solvers/run/stops.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "solvers/run/control_run.hpp"

namespace drev {

namespace {
constexpr double kWholeStep = 1e-6;  // steps by which a count of steps may be off a whole number by rounding
}

double Stop::evaluation_time() const {
  return at_break ? std::nextafter(t - width, -std::numeric_limits<double>::infinity()) : t;
}

Stops::Stops(const System& system, double t_end, double same, std::vector<Observer*> observers,
             const ControlRun* controls)
    : system_(system), t_end_(t_end), same_(same), observers_(std::move(observers)), controls_(controls) {}

Stop Stops::after(double t) const {
  const std::vector<double>& breaks = system_.breakpoints();
  const auto after = std::upper_bound(breaks.begin(), breaks.end(), t);
  double next_break = after != breaks.end() ? *after : std::numeric_limits<double>::infinity();
  if (controls_ != nullptr) next_break = std::min(next_break, controls_->next_stop(t));
  double stop = std::min(t_end_, next_break);
  for (const Observer* o : observers_) {
    const double wanted = o->next_stop(t);
    if (wanted > t + same_) stop = std::min(stop, wanted);
  }
  if (t_end_ - stop <= same_) stop = t_end_;
  if (next_break - stop <= same_) return {next_break, true};
  return {stop, false};
}

EvenSteps::EvenSteps(double from, double to, double longest)
    : begin(from),
      end(to),
      count(std::max(1.0, std::ceil((to - from) / longest - kWholeStep))),
      h((to - from) / count) {}

}  // namespace drev
