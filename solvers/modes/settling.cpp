#include <drev/core/error.hpp>
#include <drev/solvers/modes/damped_modes.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace drev {

namespace {

constexpr int kMostUnknownsToSettle = 400;  // 4 s
constexpr double kUndamped = 1e-9;          // of |lambda|: decay that is rounding
constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr int kMostRounds = 100;

/// When exp(-decay t) more(t) has come down to kSettledPart [s]; more >= 1 grows more slowly than exp(decay t).
template <class More>
double settles(double decay, const More& more) {
  double t = 0.0;
  for (int i = 0; i < kMostRounds; ++i) t = std::log(more(t) / kSettledPart) / decay;
  return t;
}

/// Of a mode that decays at `decay` and swings at `omega` [1/s], let go from a deflection: cos(w t) + d/w sin(w t) is at most
/// sqrt(1 + (d/w)^2), and 1 + d t where it hardly swings.
double settles_swinging(double decay, double omega) {
  return settles(decay, [=](double t) { return std::min(1.0 + decay * t, std::hypot(1.0, decay / omega)); });
}

/// The same of two motions that do not swing, the second no slower than the first: (b exp(-a t) - a exp(-b t)) / (b - a).
double settles_creeping(double a, double b) {
  return settles(a, [=](double t) {
    const double apart = (b - a) * t;
    return 1.0 + a * t * (apart > 0.0 ? -std::expm1(-apart) / apart : 1.0);
  });
}

}  // namespace

Settling settling_time(const System& system) {
  std::ostringstream text;
  text.precision(4);
  if (system.size() == 0) return {0.0, "every node is prescribed"};
  if (system.size() > kMostUnknownsToSettle) {
    text << "its damped modes are not sought with more than " << kMostUnknownsToSettle << " unknowns";
    return {kNever, text.str()};
  }
  DampedModeSet modes;
  try {
    modes = solve_damped_modes(system, {.in_time = true});
  } catch (const SolverError& error) {
    return {kNever, std::string("its damped modes are not found: ") + error.what()};
  }
  double fastest = 0.0, slowest = kNever, time = 0.0;  // decay [1/s]; s
  const DampedMode* of = nullptr;
  for (const DampedMode& mode : modes.modes) fastest = std::max(fastest, std::abs(mode.lambda));
  for (const DampedMode& mode : modes.modes)
    if (-mode.lambda.real() < slowest) slowest = -mode.lambda.real(), of = &mode;
  if (of != nullptr && !(slowest > kUndamped * std::abs(of->lambda))) {
    text << "the mode at " << of->frequency_Hz << " Hz (contacts closed) "
         << (slowest < -kUndamped * std::abs(of->lambda) ? "grows" : "is not damped");
    return {kNever, text.str()};
  }
  for (const DampedMode& mode : modes.modes) {
    const double t = settles_swinging(-mode.lambda.real(), std::abs(mode.lambda.imag()));
    if (t > time) time = t, slowest = -mode.lambda.real(), of = &mode;
  }
  std::vector<double> creeping;  // decay [1/s]
  for (const double lambda : modes.real_lambda)
    if (std::abs(lambda) > kUndamped * std::max(fastest, 1.0))
      creeping.push_back(-lambda);  // no free rotation
  std::sort(creeping.begin(), creeping.end());
  if (!creeping.empty()) {
    if (!(creeping[0] > 0.0)) return {kNever, "a motion that does not swing grows"};
    const double t = settles_creeping(creeping[0], creeping.size() > 1 ? creeping[1] : kNever);
    if (t > time) time = t, slowest = creeping[0], of = nullptr;
  }
  if (time == 0.0) return {0.0, "nothing in it swings or decays"};
  text << "what the start excited has decayed to " << 100.0 * kSettledPart << " % after " << time
       << " s, the slowest of it ";
  if (of != nullptr)
    text << "the damped mode at " << of->frequency_Hz << " Hz (contacts closed)";
  else
    text << "a motion that does not swing";
  text << " with the time constant " << 1.0 / slowest << " s";
  return {time, text.str()};
}

}  // namespace drev
