#include "core/law/curve_cells.hpp"

#include <drev/core/units.hpp>

#include <algorithm>
#include <cmath>

namespace drev {

namespace {

constexpr std::size_t kOfCell = CurveCells::kTerms;  // n
constexpr double kOverlap = 1.8;                     // reach over half the width
constexpr double kCellTail = 1e-14;                  // of the largest coefficient
constexpr std::size_t kFewest = 8, kMost = 1024;

/// Chebyshev coefficients a_j of values at the nodes cos(pi (q + 1/2)/n), as powers of (x/reach).
std::array<double, kOfCell> to_powers(const std::array<double, kOfCell>& a, double reach) {
  std::array<double, kOfCell> power{}, below{}, now{}, next{};
  below[0] = 1.0, now[1] = 1.0;  // T_0, T_1
  power[0] = a[0], power[1] = a[1];
  for (std::size_t j = 2; j < kOfCell; ++j) {
    for (std::size_t k = 0; k < kOfCell; ++k) next[k] = (k > 0 ? 2.0 * now[k - 1] : 0.0) - below[k];
    for (std::size_t k = 0; k <= j; ++k) power[k] += a[j] * next[k];
    below = now;
    now = next;
  }
  double scale = 1.0;
  for (double& p : power) p *= scale, scale /= reach;
  return power;
}

}  // namespace

CurveCells::CurveCells(const KnottedLoad& load) : period_(kTwoPi * load.turns()) {
  const auto turns = static_cast<std::size_t>(load.turns());
  for (std::size_t count = kFewest; !fill(load, count * turns) && count < kMost; count *= 2) {
  }
}

/// True if the cells are narrow enough.
bool CurveCells::fill(const KnottedLoad& load, std::size_t count) {
  // cos(j angle_q) at the nodes' angles, for all cells.
  static const auto cosine = [] {
    std::array<std::array<double, kOfCell>, kOfCell> table{};
    for (std::size_t q = 0; q < kOfCell; ++q)
      for (std::size_t j = 0; j < kOfCell; ++j)
        table[q][j] = std::cos(static_cast<double>(j) * kPi * (static_cast<double>(q) + 0.5) /
                               static_cast<double>(kOfCell));
    return table;
  }();
  width_ = period_ / static_cast<double>(count);
  reach_ = 0.5 * kOverlap * width_;
  std::vector<Cell> cells(count);
  std::array<double, 2> tail{}, largest{};
  for (std::size_t i = 0; i < count; ++i) {
    Cell& cell = cells[i];
    cell.centre = (static_cast<double>(i) + 0.5) * width_;
    std::array<std::array<double, kOfCell>, 2> a{};
    for (std::size_t q = 0; q < kOfCell; ++q) {
      const KnottedLoad::Curves c = load.curves(cell.centre + reach_ * cosine[q][1]);
      for (std::size_t j = 0; j < kOfCell; ++j) {
        const double weight = (j > 0 ? 2.0 : 1.0) / static_cast<double>(kOfCell) * cosine[q][j];
        a[0][j] += weight * c.factor;
        a[1][j] += weight * c.by_speed_squared;
      }
    }
    for (std::size_t f = 0; f < 2; ++f) {
      tail[f] = std::max(tail[f], std::abs(a[f][kOfCell - 1]) + std::abs(a[f][kOfCell - 2]));
      for (const double c : a[f]) largest[f] = std::max(largest[f], std::abs(c));
    }
    cell.factor = to_powers(a[0], reach_);
    cell.by_speed = to_powers(a[1], reach_);
  }
  cells_ = std::make_shared<const std::vector<Cell>>(std::move(cells));
  return tail[0] <= kCellTail * largest[0] && tail[1] <= kCellTail * largest[1];
}

CurveCells CurveCells::shifted(double by) const {
  CurveCells other = *this;
  other.start_ += by;
  return other;
}

CurveCells::Place CurveCells::at(double angle) const {
  const double from_start = angle - start_, within = from_start - period_ * std::floor(from_start / period_);
  const auto last = static_cast<double>(cells_->size() - 1);
  const double i = within > 0.0 ? std::min(std::floor(within / width_), last) : 0.0;  // a NaN: the first
  const Cell& cell = (*cells_)[static_cast<std::size_t>(i)];
  return {&cell, within - cell.centre};
}

CurveCells::Values CurveCells::values(const Place& place) {
  Values v;
  const double x = place.distance;
  for (std::size_t k = kOfCell; k-- > 0;) {
    v.factor_slope = v.factor_slope * x + v.factor;
    v.factor = v.factor * x + place.cell->factor[k];
    v.by_speed_slope = v.by_speed_slope * x + v.by_speed;
    v.by_speed = v.by_speed * x + place.cell->by_speed[k];
  }
  return v;
}

}  // namespace drev
