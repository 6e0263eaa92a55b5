#include "app/variants/variant_statistics.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/accuracy/student.hpp"

namespace drev::app {

namespace {

constexpr double kNormal95 = 1.959963984540054;  // quantile 0.975 of the normal distribution
constexpr double kParts[] = {0.01, 0.05, 0.5, 0.95, 0.99};

}  // namespace

VariantStatistics::VariantStatistics(const VariantStudy& study) {
  for (const FigureColumn& column : study.figures()) figures_.push_back({.column = column});
  used_.assign(figures_.size(), 0);
  squares_.assign(figures_.size(), 0.0);
  const auto& sampling = study.plan().sampling();
  has_intervals_ = sampling && sampling->points > 1;
  if (!sampling || sampling->kind != Sampling::Kind::saltelli) return;
  const std::size_t parameters = study.plan().varied().size();
  group_ = parameters + 2;
  indices_.assign(figures_.size(), SobolIndices(parameters, sampling->points));
  values_of_group_.assign(figures_.size(), std::vector<double>(group_));
}

void VariantStatistics::look(std::uint64_t variant, const double* row) {
  ++statuses_[static_cast<std::size_t>(row[0])];
  for (std::size_t f = 0; f < figures_.size(); ++f) {
    const double value = row[1 + f];
    if (group_ > 0) {
      values_of_group_[f][variant % group_] = value;
      if (variant % group_ + 1 == group_) indices_[f].add(variant / group_, values_of_group_[f]);
    }
    if (!std::isfinite(value)) continue;
    FigureStatistics& s = figures_[f];
    if (s.count == 0 || value < s.min) s.min = value, s.at_min = variant;
    if (s.count == 0 || value > s.max) s.max = value, s.at_max = variant;
    ++s.count;
    if (!is_independent(variant)) continue;
    const double off = value - s.mean;  // Welford's update
    s.mean += off / static_cast<double>(++used_[f]);
    squares_[f] += off * (value - s.mean);
  }
}

double VariantStatistics::bin_of(std::size_t figure, double value) const {
  const FigureStatistics& s = figures_[figure];
  return s.max > s.min ? (value - s.min) / (s.max - s.min) : 0.0;
}

void VariantStatistics::look_again(std::uint64_t variant, const double* row) {
  if (bins_.empty()) {
    for (FigureStatistics& s : figures_)
      if (s.count > 0) s.histogram.assign(kBars, 0);
    bins_.assign(figures_.size(), std::vector<std::uint64_t>(kBins));
    values_.resize(figures_.size());
  }
  for (std::size_t f = 0; f < figures_.size(); ++f) {
    const double value = row[1 + f];
    if (!std::isfinite(value)) continue;
    const std::size_t bin = std::min(kBins - 1, static_cast<std::size_t>(bin_of(f, value) * kBins));
    ++figures_[f].histogram[bin * kBars / kBins];
    if (!is_independent(variant)) continue;
    ++bins_[f][bin];
    if (used_[f] <= kBins) values_[f].push_back(value);
  }
}

void VariantStatistics::finish() {
  for (std::size_t f = 0; f < figures_.size(); ++f) {
    FigureStatistics& s = figures_[f];
    if (used_[f] == 0) {
      s = {.column = s.column};  // also where only rows that depend on others have the figure
      continue;
    }
    const auto n = static_cast<double>(used_[f]);
    if (used_[f] > 1) s.deviation = std::sqrt(squares_[f] / (n - 1.0));
    const bool known = has_intervals_ && used_[f] > 1;
    if (known) s.mean_error = student_95(n - 1.0) * s.deviation / std::sqrt(n);
    std::sort(values_[f].begin(), values_[f].end());
    const auto at_rank = [&](double rank) {  // the value that `rank` values do not exceed
      if (!values_[f].empty()) {  // the i-th value stands at the rank i - 1/2: the median is the middle one
        const double place = std::clamp(rank - 0.5, 0.0, n - 1.0);
        const auto i = static_cast<std::size_t>(place);
        const double above = values_[f][std::min(i + 1, values_[f].size() - 1)];
        return std::lerp(values_[f][i], above, place - static_cast<double>(i));
      }
      double below = 0.0;
      std::size_t bin = 0;
      while (bin + 1 < kBins && below + static_cast<double>(bins_[f][bin]) < rank)
        below += static_cast<double>(bins_[f][bin++]);
      const double inside = bins_[f][bin] > 0 ? (rank - below) / static_cast<double>(bins_[f][bin]) : 0.0;
      return s.min + (s.max - s.min) * (static_cast<double>(bin) + std::clamp(inside, 0.0, 1.0)) / kBins;
    };
    for (const double part : kParts) {
      const double spread = kNormal95 * std::sqrt(n * part * (1.0 - part));
      s.quantiles.push_back({.part = part, .value = at_rank(part * n)});
      // Beyond the least and the largest value nothing bounds a quantile: few values tell no end of its interval.
      if (known && part * n > spread) s.quantiles.back().low = at_rank(part * n - spread);
      if (known && part * n + spread < n) s.quantiles.back().high = at_rank(part * n + spread);
    }
    if (group_ > 0) s.indices = indices_[f].indices();
  }
}

}  // namespace drev::app
