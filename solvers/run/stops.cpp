#include "solvers/run/stops.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace drev {

namespace {
constexpr double kWholeStep = 1e-6;  // of a step: a count of steps that is off a whole number by rounding
}

double Stop::evaluation_time() const {
  return at_break ? std::nextafter(t - width, -std::numeric_limits<double>::infinity()) : t;
}

Stops::Stops(const System& system, double t_end, double same, std::vector<Observer*> observers)
    : system_(system), t_end_(t_end), same_(same), observers_(std::move(observers)) {}

Stop Stops::after(double t) const {
  const std::vector<double>& breaks = system_.breakpoints();
  const auto next_break = std::upper_bound(breaks.begin(), breaks.end(), t);
  double stop = t_end_;
  if (next_break != breaks.end()) stop = std::min(stop, *next_break);
  for (const Observer* o : observers_) {
    const double wanted = o->next_stop(t);
    if (wanted > t + same_) stop = std::min(stop, wanted);
  }
  if (t_end_ - stop <= same_) stop = t_end_;
  if (next_break != breaks.end() && *next_break - stop <= same_) return {*next_break, true};
  return {stop, false};
}

EvenSteps::EvenSteps(double from, double to, double longest)
    : begin(from),
      end(to),
      count(std::max(1.0, std::ceil((to - from) / longest - kWholeStep))),
      h((to - from) / count) {}

}  // namespace drev
