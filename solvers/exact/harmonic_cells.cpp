#include "solvers/exact/harmonic_cells.hpp"

#include <drev/core/units.hpp>

#include <algorithm>
#include <cmath>

namespace drev {

namespace {
constexpr double kCell = 1.1, kReach = 2.2;  // width and reach of a cell, times the highest order [rad]
constexpr int kMostTurns = 8, kMostCells = 8192;
constexpr double kTwoPiRest = 2.4492935982947064e-16;  // 2 pi less its double
}  // namespace

HarmonicCells::HarmonicCells(const LoadOrders& orders) : orders_(orders) {
  double highest = 0.0;
  for (const LoadOrder& h : orders.terms) highest = std::max(highest, h.order);
  if (!(highest > 0.0)) highest = 1.0;
  reach_ = kReach / highest;
  width_ = 2.0 * kCell / highest;
  const auto periodic = [&](double turns) {
    return std::all_of(orders.terms.begin(), orders.terms.end(),
                       [&](const LoadOrder& h) { return h.order * turns == std::floor(h.order * turns); });
  };
  double turns = 1.0;
  while (turns <= kMostTurns && !periodic(turns)) turns += 1.0;
  const double count = std::ceil(kTwoPi * turns / width_);
  if (turns > kMostTurns || count > kMostCells) {
    cells_.resize(1);
    return;
  }
  turns_ = turns;
  width_ = kTwoPi * turns / count;
  cells_.resize(static_cast<std::size_t>(count));
}

HarmonicCells::Place HarmonicCells::at(double angle) {
  if (turns_ == 0.0) {
    Cell& cell = cells_.front();
    if (!(cell.made && std::abs(angle - cell.centre) <= 0.5 * width_)) make(angle, cell);
    return {&cell, angle - cell.centre};
  }
  const double k = turns_ * std::floor(angle / (kTwoPi * turns_));
  const double within = (angle - k * kTwoPi) - k * kTwoPiRest;
  const auto last = static_cast<double>(cells_.size() - 1);
  // A NaN goes to the first cell.
  const double i = within > 0.0 ? std::min(std::floor(within / width_), last) : 0.0;
  Cell& cell = cells_[static_cast<std::size_t>(i)];
  if (!cell.made) make((i + 0.5) * width_, cell);
  return {&cell, within - cell.centre};
}

void HarmonicCells::make(double centre, Cell& cell) const {
  cell = {.centre = centre, .made = true};
  std::array<double, kTerms>& c = cell.terms;
  for_each_order(orders_.terms, centre, [&](const LoadOrder& h, double cosine, double sine) {
    // f = p cos(o x) + q sin(o x), x = theta - centre.
    double p = h.cosine * cosine + h.sine * sine, q = h.sine * cosine - h.cosine * sine;
    q *= h.order;
    const double turn = -h.order * h.order;
    for (std::size_t k = 0; k < kTerms; k += 2, p *= turn, q *= turn) {
      c[k] += p;
      c[k + 1] += q;
    }
  });
  double factorial = 1.0;
  for (std::size_t k = 1; k < kTerms; ++k) c[k] /= factorial *= static_cast<double>(k);
  c[0] += orders_.mean;
}

LoadResponse HarmonicCells::value(const Place& place) {
  LoadResponse r;
  for (std::size_t k = kTerms; k-- > 0;) {
    r.dtorque_dangle = r.dtorque_dangle * place.distance + r.torque;
    r.torque = r.torque * place.distance + place.cell->terms[k];
  }
  return r;
}

}  // namespace drev
