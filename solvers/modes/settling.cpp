#include <drev/core/error.hpp>
#include <drev/solvers/modes/damped_modes.hpp>

#include <cmath>
#include <limits>
#include <sstream>

namespace drev {

namespace {

constexpr int kMostUnknownsToSettle = 400;  // 4 s
constexpr double kUndamped = 1e-9;          // of |lambda|: decay that is rounding
constexpr double kNever = std::numeric_limits<double>::infinity();

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
  double fastest = 0.0, slowest = kNever;  // decay [1/s]
  const DampedMode* of = nullptr;
  for (const DampedMode& mode : modes.modes) fastest = std::max(fastest, std::abs(mode.lambda));
  for (const DampedMode& mode : modes.modes)
    if (-mode.lambda.real() < slowest) slowest = -mode.lambda.real(), of = &mode;
  if (of != nullptr && !(slowest > kUndamped * std::abs(of->lambda))) {
    text << "the mode at " << of->frequency_Hz << " Hz (contacts closed) "
         << (slowest < -kUndamped * std::abs(of->lambda) ? "grows" : "is not damped");
    return {kNever, text.str()};
  }
  for (const double lambda : modes.real_lambda) {
    if (!(std::abs(lambda) > kUndamped * std::max(fastest, 1.0))) continue;  // a free rotation
    if (-lambda < slowest) slowest = -lambda, of = nullptr;
  }
  if (slowest == kNever) return {0.0, "nothing in it swings or decays"};
  if (!(slowest > 0.0)) return {kNever, "a motion that does not swing grows"};
  text << "what the start excited has decayed to " << 100.0 * kSettledPart << " % after "
       << std::log(1.0 / kSettledPart) / slowest << " s, the slowest of it ";
  if (of != nullptr)
    text << "the damped mode at " << of->frequency_Hz << " Hz (contacts closed)";
  else
    text << "a motion that does not swing";
  text << " with the time constant " << 1.0 / slowest << " s";
  return {std::log(1.0 / kSettledPart) / slowest, text.str()};
}

}  // namespace drev
