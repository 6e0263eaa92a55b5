#include "app/run/run_up.hpp"

#include <drev/core/units.hpp>

#include <cmath>

namespace drev::app {

namespace {
constexpr double kTurnsOfWindow = 4.0;
constexpr std::size_t kMostCriticals = 40;
}  // namespace

RunUpWatch::RunUpWatch(const System& full, const ModeSet* modes, const System& system, double duration,
                       const std::vector<std::string>& channels, bool inside) {
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
  tracking_ = std::make_unique<OrderTracking>(system, channels, std::move(orders), found_.turns, inside);
}

SpeedsPassed RunUpWatch::result() const {
  SpeedsPassed result = found_;
  result.orders = tracking_->tracks();
  return result;
}

}  // namespace drev::app
