#include "app/variants/variant_statistics.hpp"

#include <algorithm>
#include <cmath>

namespace drev::app {

namespace {

constexpr double kNormal95 = 1.959963984540054;  // quantile 0.975 of the normal distribution
constexpr double kParts[] = {0.01, 0.05, 0.5, 0.95, 0.99};

}  // namespace

VariantStatistics::VariantStatistics(const VariantStudy& study) {
  for (const FigureColumn& column : study.figures()) figures_.push_back({.column = column});
  squares_.assign(figures_.size(), 0.0);
  const auto& sampling = study.plan().sampling();
  independent_ = sampling.has_value();
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
    ++s.count;  // Welford's update
    const double off = value - s.mean;
    s.mean += off / static_cast<double>(s.count);
    squares_[f] += off * (value - s.mean);
  }
}

double VariantStatistics::bin_of(std::size_t figure, double value) const {
  const FigureStatistics& s = figures_[figure];
  return s.max > s.min ? (value - s.min) / (s.max - s.min) : 0.0;
}

void VariantStatistics::look_again(const double* row) {
  if (bins_.empty()) {
    bins_.assign(figures_.size(), std::vector<std::uint64_t>(kBins));
    values_.resize(figures_.size());
  }
  for (std::size_t f = 0; f < figures_.size(); ++f) {
    const double value = row[1 + f];
    if (!std::isfinite(value)) continue;
    ++bins_[f][std::min(kBins - 1, static_cast<std::size_t>(bin_of(f, value) * kBins))];
    if (figures_[f].count <= kBins) values_[f].push_back(value);
  }
}

void VariantStatistics::finish() {
  for (std::size_t f = 0; f < figures_.size(); ++f) {
    FigureStatistics& s = figures_[f];
    if (s.count == 0) continue;
    const auto n = static_cast<double>(s.count);
    if (s.count > 1) s.deviation = std::sqrt(squares_[f] / (n - 1.0));
    if (independent_) s.mean_error = kNormal95 * s.deviation / std::sqrt(n);
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
      s.quantiles.push_back({part, at_rank(part * n), at_rank(std::max(0.0, part * n - spread)),
                             at_rank(std::min(n, part * n + spread))});
    }
    s.histogram.assign(kBars, 0);
    for (std::size_t bin = 0; bin < kBins; ++bin) s.histogram[bin * kBars / kBins] += bins_[f][bin];
    if (group_ > 0) s.indices = indices_[f].indices();
  }
}

}  // namespace drev::app
