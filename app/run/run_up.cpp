#include "app/run/run_up.hpp"

#include <drev/core/units.hpp>

#include <algorithm>
#include <cmath>

namespace drev::app {

namespace {
constexpr double kTurnsOfWindow = 4.0;
constexpr double kUsualOrders = 12.0;
constexpr std::size_t kMostCriticals = 40;
}  // namespace

RunUpWatch::RunUpWatch(const System& full, const ModeSet* modes, const System& system, double duration,
                       const std::vector<std::string>& channels, bool inside, bool waterfall) {
  const SpeedRange range = found_.range = speed_range(full, duration);
  std::vector<double> orders;
  if (modes != nullptr) {
    const std::vector<Crossing> all = find_crossings(full, *modes, range.first);
    orders = chief_orders(all, range);
    found_.frequency_Hz = modes->frequency_Hz;
    for (const Crossing& c : all)
      if (c.speed >= range.slowest && c.speed <= range.fastest && found_.criticals.size() < kMostCriticals)
        found_.criticals.push_back(c);
  }
  const auto& phi = full.reference()->at;
  const double turns = std::abs(phi(duration).value - phi(0.0).value) / kTwoPi;
  found_.turns = kTurnsOfWindow * std::max(1.0, std::ceil(2.0 * turns / (kTurnsOfWindow * kMostWindows)));
  if (waterfall) {
    const double highest = std::max(kUsualOrders, orders.empty() ? 0.0 : 1.25 * orders.back());
    double spacing = 0.5 * OrderTracking::kResolution / found_.turns;
    while (highest > kMostLines * spacing) spacing *= 2.0;
    std::vector<double> lines;
    for (int i = 1; i * spacing <= highest; ++i) lines.push_back(i * spacing);
    waterfall_ = std::make_unique<OrderTracking>(system, channels, std::move(lines), found_.turns, inside);
  }
  tracking_ = std::make_unique<OrderTracking>(system, channels, std::move(orders), found_.turns, inside);
}

std::vector<Observer*> RunUpWatch::observers() {
  std::vector<Observer*> all{tracking_.get()};
  if (waterfall_) all.push_back(waterfall_.get());
  return all;
}

SpeedsPassed RunUpWatch::result() const {
  SpeedsPassed result = found_;
  result.orders = tracking_->tracks();
  if (waterfall_) result.waterfall = waterfall_->tracks();
  return result;
}

}  // namespace drev::app
