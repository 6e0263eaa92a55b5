#include "app/results/branches_largest.hpp"

#include <drev/core/units.hpp>

#include <cmath>
#include <vector>

#include "app/base/text_layout.hpp"

namespace drev::app {

namespace {

constexpr int kDigitsShown = 6, kSpeedDigits = 8;

struct SweptLargest {
  double half_range = -1.0, speed = 0.0, lowest = 0.0, highest = 0.0, heat = 0.0;
  int curve = 0;  ///< from 1; 0: a run
  bool found() const { return half_range >= 0.0; }
  void note(const SweptLargest& other) {
    if (other.half_range > half_range) *this = other;
  }
};

struct SweptLargestPair {
  SweptLargest asked, between;  ///< between: only where it is above
};

SweptLargestPair largest_of(const NonlinearSweep& sweep, Eigen::Index section) {
  SweptLargestPair largest;
  for (std::size_t b = 0; b < sweep.branches.size(); ++b)
    for (const SweptMotion& motion : sweep.branches[b].motions)
      if (motion.stable || !motion.judged)
        (motion.asked ? largest.asked : largest.between)
            .note({motion.half_range()[section], motion.speed, motion.minimum[section],
                   motion.maximum[section], motion.heat[section], static_cast<int>(b) + 1});
  for (const SweptRun& run : sweep.runs)
    if (run.reason.empty())
      largest.asked.note({0.5 * (run.highest[section] - run.lowest[section]), run.speed, run.lowest[section],
                          run.highest[section], std::nan(""), 0});
  if (!(largest.between.half_range > largest.asked.half_range)) largest.between = {};
  return largest;
}

}  // namespace

std::string largest_as_text(const NonlinearSweep& sweep) {
  std::vector<std::vector<std::string>> rows{
      {"section", "half range", "at [rpm]", "curve", "lowest", "highest", "heat [W]", "between", "at [rpm]"}};
  for (std::size_t c = 0; c < sweep.sections.size(); ++c) {
    const auto [asked, between] = largest_of(sweep, static_cast<Eigen::Index>(c));
    if (!asked.found()) continue;
    const auto value = [&](double SweptLargest::*of, const SweptLargest& one) {
      return one.found() && std::isfinite(one.*of) ? digits(one.*of, kDigitsShown) : std::string("-");
    };
    const auto speed = [](const SweptLargest& one) {
      return one.found() ? short_digits(to_rpm(one.speed), kSpeedDigits) : std::string("-");
    };
    rows.push_back({sweep.sections[c].name, value(&SweptLargest::half_range, asked), speed(asked),
                    asked.curve > 0 ? std::to_string(asked.curve) : "run",
                    value(&SweptLargest::lowest, asked), value(&SweptLargest::highest, asked),
                    value(&SweptLargest::heat, asked), value(&SweptLargest::half_range, between),
                    speed(between)});
  }
  if (rows.size() == 1) return {};
  return "Largest half range of stable motions and runs at the speeds asked for; between them, where a "
         "curve "
         "is higher:\n" +
         columns_text(rows);
}

Json largest_objects(const NonlinearSweep& sweep) {
  Json list = Json::array();
  for (std::size_t c = 0; c < sweep.sections.size(); ++c) {
    const auto [asked, between] = largest_of(sweep, static_cast<Eigen::Index>(c));
    if (!asked.found()) continue;
    list.push_back({{"section", sweep.sections[c].name},
                    {"half_range", number(asked.half_range)},
                    {"speed_rpm", number(to_rpm(asked.speed))},
                    {"branch", asked.curve > 0 ? Json(asked.curve) : Json()},
                    {"lowest", number(asked.lowest)},
                    {"highest", number(asked.highest)},
                    {"heat_W", number(asked.heat)},
                    {"between_half_range", between.found() ? number(between.half_range) : Json()},
                    {"between_rpm", between.found() ? number(to_rpm(between.speed)) : Json()}});
  }
  return list;
}

}  // namespace drev::app
