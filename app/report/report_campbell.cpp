#include "app/report/report_campbell.hpp"

#include <drev/core/load.hpp>
#include <drev/core/units.hpp>
#include <drev/elements/gear_mesh.hpp>
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
constexpr std::size_t kCrossings = 400;
constexpr double kFarthest = 4.0;  // crossings up to as many times the speed of the run
// Orders shown: of each of the lowest modes those that excite it most, resonant between these times the
// speed; at least kLeastOrders, then the ones that excite most wherever they are resonant.
constexpr int kCampbellModes = 4;
constexpr std::size_t kOrdersOfMode = 3, kLeastOrders = 3;
constexpr double kSlowest = 0.5, kFast = 1.6;

/// Phase sum of the loads for every mode, at one order.
using Excitation = std::vector<std::complex<double>>;

/// To a millionth, so that orders that two loads share are one.
long key_of(double order) { return std::lround(order * 1e6); }

class Orders {
 public:
  Orders(const System& system, const ModeSet& modes, double rate)
      : system_(system), modes_(modes), rate_(rate) {
    for (const LoadTerm& load : system.loads()) add(load);
  }

  std::map<long, Excitation> found;

 private:
  void add(const LoadTerm& term) {
    const double ratio = system_.ratio(term.node);
    if (ratio == 0.0) return;
    std::vector<double> torque(kLoadSamples + 1);
    for (int i = 0; i <= kLoadSamples; ++i) {
      const double angle = 2.0 * kTwoPi * i / kLoadSamples;
      torque[static_cast<std::size_t>(i)] =
          term.load->evaluate({.nominal_angle = angle, .speed = ratio * rate_}).torque;
    }
    const auto [low, high] = std::minmax_element(torque.begin(), torque.end());
    const double range = *high - *low;
    // Neither a constant nor what does not repeat within two turns has orders.
    if (!std::isfinite(range) || !(range > 0.0) ||
        std::abs(torque.front() - torque.back()) > kAmplitudeRounding * range)
      return;
    const Spectrum lines = spectrum(torque, 1.0);
    for (std::size_t k = 1; k <= kHighestLine; ++k) {
      if (lines.amplitude[k] < 1e-4 * range) continue;
      const double order = 0.5 * static_cast<double>(k) * std::abs(ratio);
      Excitation& sum =
          found.try_emplace(key_of(order), Excitation(modes_.frequency_Hz.size())).first->second;
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

/// Name of the node through which the reference motion was given.
std::string reference_name(const Model& model) {
  if (!model.references().empty()) return model.name_of(model.references().front().first);
  for (const Model::Prescription& p : model.prescriptions())
    if (p.omega) return model.name_of(p.node);
  return "reference shaft";
}

/// One node for each speed there is.
Json shafts_object(const System& system, const std::string& reference) {
  std::map<long, std::string> shafts;
  shafts[key_of(1.0)] = reference;
  for (int i = 0; i < system.node_count(); ++i)
    if (const double ratio = std::abs(system.ratio(i)); ratio > 0.0)
      shafts.try_emplace(key_of(ratio), system.node_names()[static_cast<std::size_t>(i)]);
  Json list = Json::array({{{"name", reference}, {"ratio", 1.0}}});
  for (const auto& [key, name] : shafts)
    if (name != reference)
      list.push_back({{"name", name}, {"ratio", std::abs(system.ratio(system.node(name)))}});
  return list;
}

struct Crossing {
  int mode = 0;
  double order = 0.0, speed = 0.0, answer = 0.0;
};

}  // namespace

Json campbell_object(const Model& model, const System& system, const ModeSet& modes, double duration) {
  const auto& reference = system.reference();
  if (!reference || !reference->at) return nullptr;
  const double first = reference->at(0.0).rate, last = reference->at(duration).rate;
  const double fastest = std::max(std::abs(first), std::abs(last));
  if (!(fastest > 0.0)) return nullptr;

  const Orders orders(system, modes, first);
  std::vector<Crossing> all;
  for (const auto& [key, excitation] : orders.found)
    for (int m = 0; m < modes.count(); ++m) {
      const double order = static_cast<double>(key) * 1e-6, omega = modes.omega(m);
      const double answer = std::abs(excitation[static_cast<std::size_t>(m)]) / (omega * omega) *
                            modes.shapes.col(m).cwiseAbs().maxCoeff();
      all.push_back({m, order, omega / order, answer});
    }
  std::sort(all.begin(), all.end(), [](const Crossing& a, const Crossing& b) { return a.answer > b.answer; });
  std::set<double> shown;
  std::vector<std::size_t> taken(kCampbellModes, 0);
  for (const Crossing& c : all)
    if (c.mode < kCampbellModes && c.speed > kSlowest * fastest && c.speed < kFast * fastest &&
        taken[static_cast<std::size_t>(c.mode)]++ < kOrdersOfMode)
      shown.insert(c.order);
  for (const Crossing& c : all)
    if (shown.size() < kLeastOrders) shown.insert(c.order);
  std::erase_if(all, [&](const Crossing& c) { return c.speed > kFarthest * fastest; });

  Json list = Json::array();
  for (const double order : shown) list.push_back({{"order", order}, {"of", "loads"}});
  for (const ElementInstance& placement : system.element_instances())
    if (const auto* mesh = dynamic_cast<const GearMesh*>(placement.element.get());
        mesh != nullptr && mesh->params().teeth_1 > 0) {
      const int gear = system.node_of(placement.nodes.front());
      list.push_back(
          {{"order", mesh->params().teeth_1 * std::abs(system.ratio(gear))}, {"of", placement.name}});
    }
  if (all.size() > kCrossings) all.resize(kCrossings);
  Json crossings = Json::array();
  for (const Crossing& c : all)
    crossings.push_back(
        {{"mode", c.mode}, {"order", c.order}, {"speed", c.speed}, {"static", number(c.answer)}});
  const std::string name = reference_name(model);
  return {{"shaft", name},
          {"speed", {std::abs(first), std::abs(last)}},
          {"orders", std::move(list)},
          {"crossings", std::move(crossings)},
          {"shafts", shafts_object(system, name)}};
}

}  // namespace drev::app
