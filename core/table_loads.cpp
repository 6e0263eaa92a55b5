#include <drev/core/lanes.hpp>
#include <drev/core/table_loads.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace drev {

TableLoads::Values::Values(const TableLoads& loads) {
  const auto n = static_cast<std::size_t>(loads.size());
  for (std::vector<double>* v : {&torque, &nominal, &from_knot, &value, &left, &right}) v->resize(n);
  origin.assign(n, std::numeric_limits<double>::infinity());  // no knot yet
}

void TableLoads::add(const LoadTable& table, int unknown, double coeff, double ratio, double gain) {
  const std::size_t n = table.values.size();
  const auto [place, is_new] = begin_of_.try_emplace(table.values.data(), static_cast<int>(knots_.size()));
  if (is_new) {
    std::vector<Knot> knots;
    for (std::size_t k = 0; k <= n; ++k) {
      const std::size_t i = k % n, before = (i + n - 1) % n;
      const double turn = k == n ? table.period : 0.0;
      knots.push_back({table.arguments[i] - table.arguments[0] + turn, table.values[i], table.slopes[before],
                       table.slopes[i]});
    }
    std::size_t same = 0;
    while (same < begin_.size() && !(count_[same] == static_cast<int>(n) &&
                                     std::equal(knots.begin(), knots.end(), knots_.begin() + begin_[same])))
      ++same;
    if (same < begin_.size())
      place->second = begin_[same];
    else
      knots_.insert(knots_.end(), knots.begin(), knots.end());
  }
  unknown_.push_back(unknown);
  coeff_.push_back(coeff);
  ratio_.push_back(ratio);
  gain_.push_back(gain);
  offset_.push_back(table.phase - table.arguments[0]);
  period_.push_back(table.period);
  inverse_period_.push_back(1.0 / table.period);
  inverse_spacing_.push_back(static_cast<double>(n) / table.period);
  begin_.push_back(place->second);
  count_.push_back(static_cast<int>(n));
}

void TableLoads::set_nominal(double phi, Values& values) const {
  for (std::size_t e = 0; e < ratio_.size(); ++e) values.nominal[e] = ratio_[e] * phi + offset_[e];
}

/// Angles here are arguments: less the offset. Without branches: look_up() makes vectors of it.
[[gnu::always_inline]] inline TableLoads::Nearest TableLoads::find_knot(int e, double argument) const {
  constexpr double kRound = 6755399441055744.0;  // 1.5 * 2^52: adding it rounds to whole numbers
  const double period = period_.data()[e], coeff = coeff_.data()[e];
  double turns = argument * inverse_period_.data()[e] + kRound;
  turns -= kRound;
  turns -= turns * period > argument ? 1.0 : 0.0;
  double place = (argument - period * turns) * inverse_spacing_.data()[e] + 0.5;
  place = place > 0.0 ? place : 0.0;  // NaN too
  const double last = count_.data()[e];
  place = place < last ? place : last;
  const Knot& k = knots_.data()[begin_.data()[e] + static_cast<int>(place)];
  return {k.argument + period * turns, coeff * k.value, coeff * k.left, coeff * k.right};
}

TableLoads::Nearest TableLoads::nearest(int e, double angle) const {
  const double offset = offset_[static_cast<std::size_t>(e)];
  Nearest found = find_knot(e, angle + offset);
  found.angle -= offset;
  return found;
}

namespace {
constexpr int kFew = 4;  // entries that left their knots: more are found all at once, in vectors
}

DREV_WIDEST
void TableLoads::look_up(const double* z, Values& values) const {
  const int n = size();
  const double *gain = gain_.data(), *density = inverse_spacing_.data();
  const int* unknown = unknown_.data();
  const double* nominal = values.nominal.data();
  double *__restrict origin = values.origin.data(), *__restrict value = values.value.data(),
         *__restrict left = values.left.data(), *__restrict right = values.right.data();
  double* __restrict from_knot = values.from_knot.data();
  double* __restrict torque = values.torque.data();
  std::int64_t left_behind = 0;
  for (int e = 0; e < n; ++e) {
    const double d = nominal[e] + gain[e] * z[unknown[e]] - origin[e];
    from_knot[e] = d;
    left_behind += !(std::abs(d * density[e]) <= 0.5);
  }
  if (left_behind > kFew) {
#pragma GCC ivdep
    for (int e = 0; e < n; ++e) {
      const double argument = nominal[e] + gain[e] * z[unknown[e]];
      const Nearest found = find_knot(e, argument);
      origin[e] = found.angle;
      from_knot[e] = argument - found.angle;
      value[e] = found.value, left[e] = found.left, right[e] = found.right;
    }
  } else if (left_behind > 0) {
    for (int e = 0; e < n; ++e) {
      if (std::abs(from_knot[e] * density[e]) <= 0.5) continue;
      const double argument = nominal[e] + gain[e] * z[unknown[e]];
      const Nearest found = find_knot(e, argument);
      origin[e] = found.angle;
      from_knot[e] = argument - found.angle;
      value[e] = found.value, left[e] = found.left, right[e] = found.right;
    }
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
