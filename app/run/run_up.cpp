#include "app/run/run_up.hpp"

#include <drev/core/units.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace drev::app {

namespace {
constexpr double kTurnsOfWindow = 4.0;
constexpr double kUsualOrders = 12.0;
constexpr std::size_t kMostCriticals = 40;
}  // namespace

bool turns_actually(const System& system, double duration) {
  const SpeedRange range = speed_range(system, duration);
  const std::vector<std::string> floating = system.floating_parts(Contact::closed);
  if (!(range.fastest > 0.0)) return !floating.empty();
  return range.changes() && system.loads_depend_on_motion() &&
         std::any_of(floating.begin(), floating.end(),
                     [&](const std::string& node) { return system.ratio(system.node(node)) != 0.0; });
}

std::optional<System> turned_with(const Model& model, const System& system, const std::string& node) {
  if (system.reference()) return system;
  Model turning = model;
  try {
    turning.set_reference(node, constant_speed(kTurning));
    return turning.build();
  } catch (const ModelError&) {  // something ties it to ground
    return std::nullopt;
  }
}

OrderShaft order_shaft(const Model& model, const System& system, const std::string& named, double duration) {
  if (!turns_actually(system, duration)) return {};
  for (const std::string& node : named.empty() ? driven_nodes(system) : std::vector{named})
    if (auto turned = turned_with(model, system, node)) return {node, std::move(turned)};
  return {};
}

RunUpWatch::RunUpWatch(const System& full, const ModeSet* modes, const System& system, double duration,
                       const std::vector<std::string>& channels, bool inside, bool waterfall,
                       const OrderShaft& shaft) {
  const bool actual = shaft.turned.has_value();
  const System& turning = actual ? *shaft.turned : full;
  SpeedRange range = found_.range = speed_range(full, duration);
  if (actual) range = {.slowest = 0.0, .fastest = HUGE_VAL};  // not known yet
  std::vector<double> orders;
  if (modes != nullptr) {
    Excitation excitation = find_excitation(turning, *modes, range);
    crossings_ = std::move(excitation.crossings);
    found_.unknown = std::move(excitation.unknown);
    if (const double ratio = actual ? std::abs(turning.ratio(turning.node(shaft.node))) : 1.0; ratio != 1.0)
      for (Crossing& c : crossings_) {
        c.order /= ratio;
        c.speed *= ratio;
      }
    orders = chief_orders(crossings_, range);
    found_.frequency_Hz = modes->frequency_Hz;
  }
  found_.turns = kTurnsOfWindow;
  if (!actual) {
    const auto& phi = full.reference()->at;
    const double turns = std::abs(phi(duration).value - phi(0.0).value) / kTwoPi;
    found_.turns *= std::max(1.0, std::ceil(2.0 * turns / (kTurnsOfWindow * kMostWindows)));
  }
  if (waterfall) {
    const double highest = std::max(kUsualOrders, orders.empty() ? 0.0 : 1.25 * orders.back());
    double spacing = 0.5 * OrderTracking::kResolution / found_.turns;
    while (highest > kMostLines * spacing) spacing *= 2.0;
    // A line of fewer cycles in a window would hold a part of its neighbours.
    std::vector<double> lines;
    for (int i = 1; i * spacing <= highest; ++i)
      if (i * spacing * found_.turns >= OrderTracking::kResolution) lines.push_back(i * spacing);
    waterfall_ =
        std::make_unique<OrderTracking>(system, channels, std::move(lines), found_.turns, inside, shaft.node);
  }
  tracking_ =
      std::make_unique<OrderTracking>(system, channels, std::move(orders), found_.turns, inside, shaft.node);
}

std::vector<Observer*> RunUpWatch::observers() {
  std::vector<Observer*> all{tracking_.get()};
  if (waterfall_) all.push_back(waterfall_.get());
  return all;
}

std::optional<SpeedsPassed> RunUpWatch::result() const {
  SpeedsPassed result = found_;
  result.orders = tracking_->tracks();
  if (waterfall_) result.waterfall = waterfall_->tracks();
  if (!result.orders.shaft.empty()) {
    std::vector<double> speeds = result.orders.speed;
    if (speeds.size() < 2) return std::nullopt;
    speeds.insert(speeds.begin(), result.orders.first_speed);
    result.range = range_of_speeds(speeds);
  }
  for (const Crossing& c : crossings_)
    if (c.speed >= result.range.slowest && c.speed <= result.range.fastest &&
        result.criticals.size() < kMostCriticals)
      result.criticals.push_back(c);
  return result;
}

}  // namespace drev::app
