#include "app/run/excitation.hpp"

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

constexpr int kLoadSamples = 4096;           // of a load over two turns of its node
constexpr int kHighestLine = 400;            // order 200 of the node
constexpr double kAmplitudeRounding = 1e-6;  // relative, of amplitudes
constexpr int kSpeedSamples = 1000;          // over the run
// Orders shown: of each of the lowest modes those that excite it most, resonant from below the slowest to
// above the fastest speed of the run by these factors.
constexpr int kChiefModes = 4;
constexpr std::size_t kOrdersOfMode = 3, kLeastOrders = 3;
constexpr double kSlower = 0.5, kFaster = 1.6;

double range_of(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return *high - *low;
}

/// A load's torque over two turns of its node at a speed [rad/s]; empty: it has no orders.
std::vector<double> two_turns(const LoadTerm& term, double speed) {
  std::vector<double> torque(kLoadSamples + 1);
  for (int i = 0; i <= kLoadSamples; ++i) {
    const double angle = 2.0 * kTwoPi * i / kLoadSamples;
    torque[static_cast<std::size_t>(i)] =
        term.load->evaluate({.nominal_angle = angle, .speed = speed, .nominal_speed = speed}).torque;
  }
  const double range = range_of(torque);
  // Neither a constant nor what does not repeat within two turns has orders.
  if (!std::isfinite(range) || !(range > 0.0) ||
      std::abs(torque.front() - torque.back()) > kAmplitudeRounding * range)
    return {};
  return torque;
}

/// Phase sum of the loads for every mode, at one order.
using Excitation = std::vector<std::complex<double>>;

class Orders {
 public:
  Orders(const System& system, const ModeSet& modes, double rate)
      : system_(system), modes_(modes), rate_(rate) {
    for (const LoadTerm& load : system.loads()) add(load);
  }

  std::map<long, Excitation> found;  // by order in millionths, so that orders that two loads share are one

 private:
  void add(const LoadTerm& term) {
    const double ratio = system_.ratio(term.node);
    if (ratio == 0.0) return;
    const std::vector<double> torque = two_turns(term, ratio * rate_);
    if (torque.empty()) return;
    const double range = range_of(torque);
    const Spectrum lines = spectrum(torque, 1.0);
    for (std::size_t k = 1; k <= kHighestLine; ++k) {
      if (lines.amplitude[k] < 1e-4 * range) continue;
      const double order = 0.5 * static_cast<double>(k) * std::abs(ratio);
      Excitation& sum =
          found.try_emplace(std::lround(order * 1e6), Excitation(modes_.frequency_Hz.size())).first->second;
      const std::complex<double> load =
          std::polar(lines.amplitude[k], ratio > 0.0 ? lines.phase[k] : -lines.phase[k]);
      for (int m = 0; m < modes_.count(); ++m)
        sum[static_cast<std::size_t>(m)] += modes_.shapes(term.node, m) * load;
    }
  }

  const System& system_;
  const ModeSet& modes_;
  double rate_;
};

}  // namespace

std::vector<Crossing> find_crossings(const System& system, const ModeSet& modes, double rate) {
  const Orders orders(system, modes, rate);
  std::vector<Crossing> all;
  for (const auto& [key, excitation] : orders.found)
    for (int m = 0; m < modes.count(); ++m) {
      const double order = static_cast<double>(key) * 1e-6, omega = modes.omega(m);
      const double answer = std::abs(excitation[static_cast<std::size_t>(m)]) / (omega * omega) *
                            modes.shapes.col(m).cwiseAbs().maxCoeff();
      all.push_back({m, order, omega / order, answer});
    }
  std::sort(all.begin(), all.end(), [](const Crossing& a, const Crossing& b) { return a.answer > b.answer; });
  return all;
}

std::string driven_node(const System& system) {
  double largest = 0.0;
  std::string node;
  for (const LoadTerm& term : system.loads()) {
    const std::vector<double> torque = two_turns(term, 0.0);
    if (torque.empty() || !(range_of(torque) > (1.0 + kAmplitudeRounding) * largest)) continue;
    largest = range_of(torque);
    node = system.node_names()[static_cast<std::size_t>(term.node)];
  }
  return node;
}

SpeedRange speed_range(const System& system, double duration) {
  const auto& reference = system.reference();
  if (!reference || !reference->at) return {};
  const auto speed = [&](double t) { return std::abs(reference->at(t).rate); };
  SpeedRange range{HUGE_VAL, 0.0, speed(0.0), speed(duration)};
  for (int i = 0; i <= kSpeedSamples; ++i) {
    const double here = speed(duration * i / kSpeedSamples);
    range.slowest = std::min(range.slowest, here);
    range.fastest = std::max(range.fastest, here);
  }
  return range;
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
