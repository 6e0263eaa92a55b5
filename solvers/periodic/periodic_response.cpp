#include <drev/core/channel.hpp>
#include <drev/core/control/controllers.hpp>
#include <drev/core/error.hpp>
#include <drev/core/law/friction.hpp>
#include <drev/core/units.hpp>
#include <drev/solvers/periodic/periodic_response.hpp>

#include <algorithm>
#include <cmath>
#include <map>

#include "solvers/periodic/bracketed_search.hpp"
#include "solvers/periodic/harmonic_balance.hpp"
#include "solvers/run/peak_search.hpp"

namespace drev {

namespace {

using Harmonics = HarmonicBalance::Harmonics;

constexpr int kFewest = 16, kMost = 4096;
constexpr double kLargestSize = 2e7;  // largest unknowns x harmonics: 320 MB for each motion
constexpr double kFirstTail = 1e-3;   // part of the motion beyond the first number of harmonics [-]
constexpr double kPeriodicity = 1e-8;
constexpr double kUneven = 10.0;           // factor of the error [-]: kinks between samples; 7.5 was measured
constexpr double kSwing = 0.02;            // largest rise of an extremum above its samples over the range [-]
constexpr double kLoosest = 1e-2;          // largest error accepted with the most harmonics [-]
constexpr double kNewtonTolerance = 1e-2;  // tolerance of Newton's method over that of the response [-]

/// Results with one number of harmonics.
struct Level {
  Eigen::MatrixXd values;  // channels (or unknowns, without channels) x samples
  bool closed = true;
};

/// Evaluates channels and contacts over the period.
Level evaluate(const System& system, HarmonicBalance& balance, const Harmonics& z, int samples, double period,
               const std::vector<Channel>& channels) {
  const auto q = balance.motion(z, 0, samples), v = balance.motion(z, 1, samples);
  const auto a = balance.motion(z, 2, samples);
  Assembler assembler(system);
  State state = State::initial(system);
  Level level;
  if (channels.empty())
    level.values = q;
  else
    level.values.resize(static_cast<Eigen::Index>(channels.size()), samples);
  std::vector<int> side(system.scalars().size(), 0);
  for (int s = 0; s < samples; ++s) {
    state.t = period * s / samples;
    state.z = q.col(s);
    state.v = v.col(s);
    state.a = a.col(s);
    assembler.set_time(state.t);
    for (std::size_t c = 0; c < channels.size(); ++c)
      level.values(static_cast<Eigen::Index>(c), s) = channels[c].evaluate(assembler, state);
    for (std::size_t j = 0; j < side.size(); ++j) {
      const auto gap = system.scalars()[j].force->gap();
      if (!gap) continue;
      const double x = assembler.input(system.scalars()[j], state.z, state.v).x;
      const int now = x >= gap->high ? 1 : x <= gap->low ? -1 : 0;
      if (s == 0) side[j] = now;
      level.closed = level.closed && now != 0 && now == side[j];
    }
  }
  return level;
}

/// The motion at any time, by Horner's rule.
class SeriesMotion {
 public:
  SeriesMotion(const System& system, const Harmonics& z, double w)
      : assembler_(system), state_(State::initial(system)), z_(z), w_(w) {}

  PeakSample look(const Channel& channel, double t) {
    state_.t = t;
    assembler_.set_time(t);
    const std::complex<double> turn = std::polar(1.0, w_ * t);
    Eigen::VectorXcd q = Eigen::VectorXcd::Zero(z_.rows()), v = q, a = q;
    for (Eigen::Index n = z_.cols() - 1; n >= 0; --n) {
      const std::complex<double> rate(0.0, w_ * static_cast<double>(n));
      q = q * turn + z_.col(n);
      v = v * turn + rate * z_.col(n);
      a = a * turn + rate * rate * z_.col(n);
    }
    state_.z = q.real();
    state_.v = v.real();
    state_.a = a.real();
    return {t, channel.evaluate(assembler_, state_), channel.rate(assembler_, state_)};
  }

 private:
  Assembler assembler_;
  State state_;
  const Harmonics& z_;
  double w_;
};

/// Largest and smallest value of a channel over the period: at equidistant times `h` apart, refined on the
/// motion itself next to those that are extreme.
Peak peak_of(const Channel& channel, const Eigen::RowVectorXd& y, double h, SeriesMotion& motion) {
  Peak p{{y[0], 0.0, y[0], 0.0}};
  for (Eigen::Index s = 1; s < y.size(); ++s) p.note(y[s], h * static_cast<double>(s));
  const double swing = kSwing * (p.max - p.min), top = p.max - swing, bottom = p.min + swing;
  const auto look = [&](double t) { return motion.look(channel, t); };
  for (Eigen::Index s = 0; s < y.size(); ++s) {
    const double before = y[(s + y.size() - 1) % y.size()], here = y[s], next = y[(s + 1) % y.size()];
    const bool highest = here > before && here >= next && here >= top;
    const bool lowest = here < before && here <= next && here <= bottom;
    if (!highest && !lowest) continue;
    const double t = h * static_cast<double>(s);
    const PeakSample middle = look(t);
    search_peak(look(t - h), middle, look, p.max - p.min, p);
    search_peak(middle, look(t + h), look, p.max - p.min, p);
  }
  return p;
}

/// The number of harmonics to start with, at most `most`: the part of the motion beyond them is kFirstTail of
/// it or less.
int first_level(const HarmonicBalance& balance, const Harmonics& z, int most) {
  const double limit = kFirstTail * balance.size(z);
  Harmonics tail = Harmonics::Zero(z.rows(), z.cols());
  auto needed = static_cast<int>(z.cols()) - 1;
  for (; needed > kFewest; --needed) {
    tail.col(needed) = z.col(needed);
    if (balance.size(tail) > limit) break;
  }
  int level = kFewest;
  while (level < needed) level *= 2;
  return std::min(level, most);
}

/// Largest difference of a channel between two levels, relative to its largest value [-].
double difference(const Level& coarse, const Level& fine) {
  double largest = 0.0;
  for (Eigen::Index c = 0; c < fine.values.rows(); ++c) {
    double of_channel = 0.0;
    for (Eigen::Index s = 0; s < coarse.values.cols(); ++s)
      of_channel = std::max(of_channel, std::abs(fine.values(c, 2 * s) - coarse.values(c, s)));
    if (of_channel > 0.0) largest = std::max(largest, of_channel / fine.values.row(c).cwiseAbs().maxCoeff());
  }
  return largest;
}

/// Largest truncation error of a channel's series, relative to its largest value [-]. A channel that depends
/// on time (a load at the nominal angle) has the same values with any number of harmonics, while its series
/// has not.
double truncated(const HarmonicBalance& balance, const Level& level, const Harmonics& amplitudes) {
  const Eigen::MatrixXd series = balance.motion(amplitudes, 0, static_cast<int>(level.values.cols()));
  double largest = 0.0;
  for (Eigen::Index c = 0; c < series.rows(); ++c) {
    const double off = (level.values.row(c) - series.row(c)).cwiseAbs().maxCoeff();
    if (off > 0.0) largest = std::max(largest, off / level.values.row(c).cwiseAbs().maxCoeff());
  }
  return largest;
}

double given_period(const System& system, const PeriodicOptions& options, PeriodicResponse& response) {
  std::vector<Finding> findings;
  ParameterCheck check(system.name() + "/periodic response", findings);
  check.non_negative("period", options.period, "s");
  check.positive("turns", options.turns, "");
  check.within("harmonics", options.harmonics, 0, kMost, "");
  check.within("tolerance", options.tolerance, 1e-10, 1e-1, "");
  const double speed = system.reference_speed();
  if (options.period == 0.0 && speed == 0.0)
    check.fail("period", "0", "s", "must be given: no reference shaft turns");
  if (!findings.empty()) throw ModelError(findings);
  response.period = options.period > 0.0 ? options.period : options.turns * kTwoPi / speed;
  response.order_step = speed > 0.0 ? kTwoPi / (speed * response.period) : 0.0;
  return response.period;
}

std::string refusal(const System& system) {
  if (system.size() == 0) return "every node is prescribed";
  if (const auto why = system.why_not_varying_inertia("harmonic balance")) return *why;
  if (const auto floating = system.floating_parts(Contact::closed); !floating.empty())
    return "a part of the model floats freely (with " + floating.front() + ")";
  if (const auto why = why_not_friction(system, "a periodic steady state by harmonic balance")) return *why;
  if (const auto why = why_not_controllers(system, "a periodic steady state by harmonic balance"))
    return *why;
  for (const GeneralTerm& term : system.generals())
    if (term.force->history_size() > 0)
      return system.element_instances()[idx(index(term.element))].name + " has a history, which is unknown";
  return {};
}

}  // namespace

PeriodicResponse solve_periodic(const System& system, const PeriodicOptions& options) {
  PeriodicResponse response;
  const double period = given_period(system, options, response);
  const std::vector<Channel> channels = find_channels(system, options.channels);
  response.reason = refusal(system);
  if (!response.reason.empty()) return response;
  const auto most = static_cast<int>(std::clamp<double>(kLargestSize / system.size(), 2 * kFewest, kMost));
  const bool given = options.harmonics > 0;

  // Each level has twice the harmonics of the last one, whose samples are every second one of its own.
  HarmonicBalance balance(system, period);
  Harmonics z;
  int harmonics = given ? (options.harmonics + 1) / 2 : most / 2;
  response.reason = balance.start(harmonics, 4 * harmonics, z).reason;
  if (!response.reason.empty()) return response;
  if (!given) harmonics = first_level(balance, z, harmonics);
  Level level = {}, before;
  for (int number = 0;; ++number, harmonics *= 2) {
    const HarmonicBalance::Outcome outcome =
        balance.solve(harmonics, 4 * harmonics, kNewtonTolerance * options.tolerance, z);
    response.harmonics = harmonics;
    response.iterations += outcome.iterations;
    response.reason = outcome.reason;
    if (response.reason.empty() && number == 0 && balance.aperiodicity(z, 4 * harmonics) > kPeriodicity)
      response.reason = "what acts on the model does not have the period " + to_text(period) + " s";
    if (!response.reason.empty()) return response;
    level = evaluate(system, balance, z, 4 * harmonics, period, channels);
    if (number > 0) {
      response.error = kUneven * (difference(before, level) + outcome.residual);
      if (given || response.error <= options.tolerance || 2 * harmonics > most) break;
    }
    before = std::move(level);
  }
  response.contact_closed = level.closed;
  response.found = given || response.error <= std::max(options.tolerance, kLoosest);
  if (!response.found)
    response.reason = "the error is " + to_text(response.error) + " with " + std::to_string(harmonics) +
                      " harmonics, not the tolerance " + to_text(options.tolerance);
  if (!response.found) return response;
  response.z = balance.motion(z, 0, 4 * harmonics).col(0);
  response.v = balance.motion(z, 1, 4 * harmonics).col(0);
  if (channels.empty()) return response;
  const Harmonics amplitudes = balance.to_harmonics(level.values, harmonics);
  response.error += kUneven * truncated(balance, level, amplitudes);
  SeriesMotion motion(system, z, kTwoPi / period);
  for (Eigen::Index c = 0; c < amplitudes.rows(); ++c) {
    response.peaks.push_back(peak_of(channels[static_cast<std::size_t>(c)], level.values.row(c),
                                     period / (4 * harmonics), motion));
    const Eigen::VectorXcd row = amplitudes.row(c).transpose();
    response.amplitudes.emplace_back(row.begin(), row.end());
  }
  return response;
}

namespace {
constexpr double kSearchWidth = 1e-4;  // tolerance of the search relative to its interval [-]
}

SpeedSweep sweep_speeds(const std::function<System(double)>& build, const std::vector<double>& speeds,
                        const PeriodicOptions& options) {
  std::vector<Finding> findings;
  ParameterCheck check("speed sweep", findings);
  check.increasing("speeds", speeds, "");
  if (speeds.empty()) check.fail("speeds", "none", "", "must be at least one");
  if (options.channels.empty()) check.fail("channels", "none", "", "must be at least one");
  if (options.period != 0.0)
    check.fail("period", to_text(options.period), "s", "must be 0: it changes with the speed");
  if (!findings.empty()) throw ModelError(findings);

  SpeedSweep sweep;
  std::map<double, std::vector<double>> amplitudes;  // of all channels by speed; empty: no response
  const auto solve = [&](double speed) {
    PeriodicResponse response = solve_periodic(build(speed), options);
    std::vector<double>& here = amplitudes[speed];
    for (const Peak& peak : response.peaks) here.push_back(peak.amplitude());
    return response;
  };
  for (const double speed : speeds) sweep.curve.push_back({speed, solve(speed)});
  sweep.worst.resize(options.channels.size());
  for (std::size_t c = 0; c < options.channels.size(); ++c) {
    SpeedSweep::Worst& worst = sweep.worst[c];
    const auto at_speed = [&](double speed) {
      if (!amplitudes.contains(speed)) solve(speed);
      const std::vector<double>& here = amplitudes[speed];
      const double amplitude = here.empty() ? 0.0 : here[c];
      if (amplitude > worst.amplitude) worst = {speed, amplitude};
      return amplitude;
    };
    std::size_t top = 0;
    for (std::size_t i = 0; i < speeds.size(); ++i) {
      const double before = worst.amplitude;
      if (at_speed(speeds[i]) > before) top = i;
    }
    const double low = speeds[top > 0 ? top - 1 : 0], high = speeds[std::min(top + 1, speeds.size() - 1)];
    if (high > low) bracketed_maximum(low, speeds[top], high, kSearchWidth * (high - low), at_speed);
  }
  return sweep;
}

}  // namespace drev
