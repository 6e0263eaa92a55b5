#include "core/table_loads.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/lanes.hpp"

namespace drev {

TableLoads::Values::Values(const TableLoads& loads) {
  const auto n = static_cast<std::size_t>(loads.size());
  for (std::vector<double>* v : {&torque, &nominal, &from_knot, &value, &left, &right}) v->resize(n);
  origin.assign(n, std::numeric_limits<double>::infinity());  // no knot yet
}

void TableLoads::add(const LoadTable& table, int unknown, double coeff, double ratio, double gain) {
  const std::size_t n = table.values.size();
  const auto [place, is_new] =
      begin_of_.try_emplace(table.values.data(), static_cast<int>(knots_.size()));
  if (is_new) {
    std::vector<Knot> knots;
    for (std::size_t k = 0; k <= n; ++k) {
      const std::size_t i = k % n, before = (i + n - 1) % n;
      const double turn = k == n ? table.period : 0.0;
      knots.push_back({table.arguments[i] - table.arguments[0] + turn, table.values[i], table.slopes[before],
                       table.slopes[i]});
    }
    const auto same = std::find_if(turns_.begin(), turns_.end(), [&](const Turn& t) {
      return t.count == static_cast<int>(n) &&
             std::equal(knots.begin(), knots.end(), knots_.begin() + t.begin);
    });
    if (same != turns_.end())
      place->second = same->begin;
    else
      knots_.insert(knots_.end(), knots.begin(), knots.end());
  }
  unknown_.push_back(unknown);
  ratio_.push_back(ratio);
  gain_.push_back(gain);
  offset_.push_back(table.phase - table.arguments[0]);
  const double count = static_cast<double>(n);
  inverse_spacing_.push_back(count / table.period);
  turns_.push_back({coeff, offset_.back(), table.period, 1.0 / table.period, count / table.period,
                    place->second, static_cast<int>(n)});
}

void TableLoads::set_nominal(double phi, Values& values) const {
  for (std::size_t e = 0; e < ratio_.size(); ++e) values.nominal[e] = ratio_[e] * phi + offset_[e];
}

/// Angles here are arguments: less the offset.
[[gnu::always_inline]] inline TableLoads::Nearest TableLoads::find_knot(std::size_t e,
                                                                        double argument) const {
  constexpr double kRound = 6755399441055744.0;  // 1.5 * 2^52: adding it rounds to whole numbers
  const Turn& t = turns_[e];
  double turns = argument * t.inverse_period + kRound;
  turns -= kRound;
  if (turns * t.period > argument) turns -= 1.0;
  double place = (argument - t.period * turns) * t.inverse_spacing + 0.5;
  place = place > 0.0 ? place : 0.0;  // NaN too
  const Knot& k = knots_[static_cast<std::size_t>(t.begin) +
                         static_cast<std::size_t>(std::min(place, static_cast<double>(t.count)))];
  return {k.argument + t.period * turns, t.coeff * k.value, t.coeff * k.left, t.coeff * k.right};
}

TableLoads::Nearest TableLoads::nearest(int e, double angle) const {
  const auto i = static_cast<std::size_t>(e);
  const double offset = turns_[i].offset;
  Nearest found = find_knot(i, angle + offset);
  found.angle -= offset;
  return found;
}

DREV_WIDEST
void TableLoads::look_up(const double* z, Values& values) const {
  const int n = size();
  const double *gain = gain_.data(), *density = inverse_spacing_.data();
  const int* unknown = unknown_.data();
  const double *nominal = values.nominal.data(), *origin = values.origin.data(),
               *value = values.value.data(), *left = values.left.data(), *right = values.right.data();
  double* __restrict from_knot = values.from_knot.data();
  double* __restrict torque = values.torque.data();
  int left_behind = 0;
  for (int e = 0; e < n; ++e) {
    const double d = nominal[e] + gain[e] * z[unknown[e]] - origin[e];
    from_knot[e] = d;
    const double places = d * density[e];
    left_behind |= !(places <= 0.5 && places >= -0.5);
  }
  if (left_behind)
    for (int e = 0; e < n; ++e) {
      const double places = from_knot[e] * density[e];
      if (places <= 0.5 && places >= -0.5) continue;
      const auto i = static_cast<std::size_t>(e);
      const double argument = nominal[e] + gain[e] * z[unknown[e]];
      const Nearest found = find_knot(i, argument);
      values.origin[i] = found.angle;
      values.from_knot[i] = argument - found.angle;
      values.value[i] = found.value, values.left[i] = found.left, values.right[i] = found.right;
    }
  Lanes most{};
  int e = 0;
  for (; e + kLanes <= n; e += kLanes) {
    Lanes d, a, b, g;
    load(from_knot + e, d);
    load(left + e, a);
    load(right + e, b);
    load(value + e, g);
    const Lanes behind = d < 0.0 ? d : 0.0 * d;
    g += a * behind + b * (d - behind);
    store(g, torque + e);
    load(gain + e, g);
    larger(most, a * g);
    larger(most, b * g);
  }
  double steepest = 0.0;
  for (int l = 0; l < kLanes; ++l) steepest = std::max(steepest, most[l]);
  for (; e < n; ++e) {
    const double d = from_knot[e], behind = d < 0.0 ? d : 0.0;
    torque[e] = value[e] + left[e] * behind + right[e] * (d - behind);
    steepest = std::max({steepest, std::abs(left[e] * gain[e]), std::abs(right[e] * gain[e])});
  }
  values.steepest = steepest;
}

void TableLoads::add_to(const Values& values, double* p) const {
  for (std::size_t e = 0; e < unknown_.size(); ++e) p[unknown_[e]] += values.torque[e];
}

}  // namespace drev
