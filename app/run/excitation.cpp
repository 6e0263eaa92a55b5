#include "app/run/excitation.hpp"

#include <drev/core/law/harmonic_load.hpp>
#include <drev/core/load.hpp>
#include <drev/core/units.hpp>
#include <drev/solvers/periodic/spectrum.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <set>

namespace drev::app {

namespace {

using Complex = std::complex<double>;

constexpr int kLoadSamples = 4096;           // of a load over two turns of its node
constexpr std::size_t kHighestLine = 400;    // order 200 of the node
constexpr double kAmplitudeRounding = 1e-6;  // relative, of amplitudes
constexpr double kNoOrder = 1e-4;            // amplitude over the range of the load that is no order [-]
constexpr double kSpeedStep = 1.1;           // from one speed at which a load is transformed to the next [-]
constexpr int kSpeedSamples = 1000;          // over the run
// Orders shown: of each of the lowest modes those that excite it most, resonant from below the slowest to
// above the fastest speed of the run by these factors.
constexpr int kChiefModes = 4;
constexpr std::size_t kOrdersOfMode = 3, kLeastOrders = 3;
constexpr double kSlower = 0.5, kFaster = 1.6;
// Speeds over the slowest and the fastest of the run beyond which the loads of a crossing are those of the limit.
constexpr double kSlowestLoads = kSlower, kFastestLoads = 2.0;

double range_of(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return *high - *low;
}

double torque_of(const Load& load, double angle, double speed) {
  return load.evaluate({.nominal_angle = angle, .speed = speed, .nominal_speed = speed}).torque;
}

/// A load's torque over two turns of its node at a speed [rad/s].
std::vector<double> two_turns(const Load& load, double speed) {
  std::vector<double> torque(kLoadSamples + 1);
  for (int i = 0; i <= kLoadSamples; ++i)
    torque[idx(i)] = torque_of(load, 2.0 * kTwoPi * i / kLoadSamples, speed);
  return torque;
}

bool alternates(double range) { return std::isfinite(range) && range > 0.0; }

bool repeats(const std::vector<double>& torque) {
  return std::abs(torque.front() - torque.back()) <= kAmplitudeRounding * range_of(torque);
}

/// Orders of one load per turn of its node, with their amplitudes at any speed of it: those that it states, or those of
/// its torque over two turns. Where the torque follows the speed, amplitudes are parabolas through three speeds kSpeedStep
/// apart, which is exact for those that grow with the square of the speed.
class TorqueOrders {
 public:
  explicit TorqueOrders(const Load& load) : load_(load) {
    if (const auto* stated = dynamic_cast<const HarmonicLoad*>(&load)) {
      take(*stated);
      return;
    }
    follows_speed_ = follows_speed();
    for (std::size_t k = 1; k <= kHighestLine; ++k) orders.push_back(0.5 * static_cast<double>(k));
  }

  std::vector<double> orders;
  bool unknown = false;  ///< at a speed asked for the torque does not repeat within two turns

  /// A exp(i p) of A cos(order theta + p), of the order of this place; 0: the load does not have it.
  Complex at(std::size_t place, double speed) {
    direction_ = speed < 0.0 ? -1.0 : 1.0;
    const double level = follows_speed_ ? std::log(std::abs(speed) / kTurning) / std::log(kSpeedStep) : 0.0;
    const auto below = static_cast<int>(std::floor(level));
    Complex sum = lines_at(below).line(place);
    if (follows_speed_) {
      const double x = std::pow(kSpeedStep, level - below), a = kSpeedStep, b = a * a;
      sum = sum * ((x - a) * (x - b) / ((1.0 - a) * (1.0 - b))) +
            lines_at(below + 1).line(place) * ((x - 1.0) * (x - b) / ((a - 1.0) * (a - b))) +
            lines_at(below + 2).line(place) * ((x - 1.0) * (x - a) / ((b - 1.0) * (b - a)));
    }
    return std::abs(sum) >= lines_at(below).least ? sum : 0.0;
  }

 private:
  struct Lines {
    std::vector<Complex> amplitude;
    double least = 0.0;  // amplitude below which there is no order
    Complex line(std::size_t place) const { return place < amplitude.size() ? amplitude[place] : 0.0; }
  };

  void take(const HarmonicLoad& stated) {
    Lines& lines = found_[0];
    for (const LoadOrder& term : stated.orders().terms) {
      if (orders.empty() || orders.back() != term.order) {
        orders.push_back(term.order);
        lines.amplitude.emplace_back();
      }
      lines.amplitude.back() += Complex(term.cosine, -term.sine);
    }
    for (const Complex& one : lines.amplitude) lines.least += 2.0 * kNoOrder * std::abs(one);
  }

  /// Whether another speed makes another torque, anywhere from 0.01 rad/s on.
  bool follows_speed() const {
    for (int i = 0; i < 16; ++i) {
      const double angle = 0.37 + 0.911 * i;  // rad; no part of a turn
      double speed = 0.01;
      const double torque = torque_of(load_, angle, speed);
      for (int j = 0; j < 40; ++j, speed *= 1.5)
        for (const double sense : {-1.0, 1.0})
          if (torque_of(load_, angle, sense * speed) != torque) return true;
    }
    return false;
  }

  /// At kTurning times this power of kSpeedStep.
  const Lines& lines_at(int power) {
    const auto [place, missing] = found_.try_emplace(power);
    if (!missing) return place->second;
    Lines& lines = place->second;
    const std::vector<double> torque = two_turns(load_, direction_ * kTurning * std::pow(kSpeedStep, power));
    const double range = range_of(torque);
    if (!alternates(range)) return lines;
    if (!repeats(torque)) {
      unknown = true;
      return lines;
    }
    const Spectrum all = spectrum(torque, 1.0);
    lines.least = kNoOrder * range;
    for (std::size_t k = 1; k <= kHighestLine; ++k)
      lines.amplitude.push_back(std::polar(all.amplitude[k], all.phase[k]));
    return lines;
  }

  const Load& load_;
  bool follows_speed_ = false;
  double direction_ = 1.0;  // in which the node turns
  std::map<int, Lines> found_;
};

}  // namespace

Excitation find_excitation(const System& system, const ModeSet& modes, const SpeedRange& range) {
  // Phase sum of the loads by order, in millionths so that orders that two loads share are one, and by mode.
  std::map<std::pair<long, int>, Complex> sums;
  Excitation found;
  for (const LoadTerm& term : system.loads()) {
    const double ratio = system.ratio(term.node);
    if (ratio == 0.0) continue;
    TorqueOrders load(*term.load);
    for (std::size_t k = 0; k < load.orders.size(); ++k) {
      const double order = load.orders[k] * std::abs(ratio);
      for (int m = 0; m < modes.count(); ++m) {
        const double speed =
            std::clamp(modes.omega(m) / order, kSlowestLoads * range.slowest, kFastestLoads * range.fastest);
        const Complex torque = load.at(k, ratio * speed);
        if (torque != 0.0)
          sums[{std::lround(order * 1e6), m}] +=
              modes.shapes(term.node, m) * (ratio > 0.0 ? torque : std::conj(torque));
      }
    }
    const std::string& element = system.element_instances()[idx(index(term.element))].name;
    if (load.unknown && std::count(found.unknown.begin(), found.unknown.end(), element) == 0)
      found.unknown.push_back(element);
  }
  for (const auto& [key, sum] : sums) {
    const double order = static_cast<double>(key.first) * 1e-6, omega = modes.omega(key.second);
    const double answer =
        std::abs(sum) / (omega * omega) * modes.shapes.col(key.second).cwiseAbs().maxCoeff();
    found.crossings.push_back({key.second, order, omega / order, answer});
  }
  std::sort(found.crossings.begin(), found.crossings.end(),
            [](const Crossing& a, const Crossing& b) { return a.answer > b.answer; });
  return found;
}

std::vector<std::string> driven_nodes(const System& system) {
  std::vector<std::pair<double, int>> driven;  // range, node
  for (const LoadTerm& term : system.loads()) {
    const std::vector<double> torque = two_turns(*term.load, kTurning);
    const double range = range_of(torque);
    if (alternates(range) && (dynamic_cast<const HarmonicLoad*>(term.load) != nullptr || repeats(torque)))
      driven.emplace_back(range, term.node);
  }
  std::vector<std::string> names;
  while (!driven.empty()) {
    auto largest = driven.begin();  // the first of equal ones
    for (auto d = driven.begin(); d != driven.end(); ++d)
      if (d->first > (1.0 + kAmplitudeRounding) * largest->first) largest = d;
    names.push_back(system.node_names()[idx(largest->second)]);
    driven.erase(largest);
  }
  return names;
}

SpeedRange range_of_speeds(const std::vector<double>& speeds) {
  const auto [lowest, highest] = std::minmax_element(speeds.begin(), speeds.end());
  const bool through_zero = *lowest < 0.0 && *highest > 0.0;
  return {.slowest = through_zero ? 0.0 : std::min(std::abs(*lowest), std::abs(*highest)),
          .fastest = std::max(std::abs(*lowest), std::abs(*highest)),
          .first = speeds.front(),
          .last = speeds.back(),
          .lowest = *lowest,
          .highest = *highest};
}

SpeedRange speed_range(const System& system, double duration) {
  const auto& reference = system.reference();
  if (!reference || !reference->at) return {};
  std::vector<double> speeds;
  for (int i = 0; i <= kSpeedSamples; ++i) speeds.push_back(reference->at(duration * i / kSpeedSamples).rate);
  return range_of_speeds(speeds);
}

std::vector<double> chief_orders(const std::vector<Crossing>& crossings, const SpeedRange& range) {
  std::set<double> shown;
  std::vector<std::size_t> taken(kChiefModes, 0);
  for (const Crossing& c : crossings)
    if (c.mode < kChiefModes && c.speed > kSlower * range.slowest && c.speed < kFaster * range.fastest &&
        taken[static_cast<std::size_t>(c.mode)]++ < kOrdersOfMode)
      shown.insert(c.order);
  for (const Crossing& c : crossings)
    if (shown.size() < kLeastOrders) shown.insert(c.order);
  return {shown.begin(), shown.end()};
}

std::string reference_node(const Model& model) {
  if (!model.references().empty()) return model.name_of(model.references().front().first);
  for (const Model::Prescription& p : model.prescriptions())
    if (p.omega) return model.name_of(p.node);
  return {};
}

std::string of_reference(const Model& model) {
  const std::string node = reference_node(model);
  return "of " + node + (node.empty() ? "" : ", ") + "the reference shaft";
}

}  // namespace drev::app
