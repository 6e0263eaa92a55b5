#pragma once
/// Statistics of a study's rows: the number of variants with each status, and for each figure mean, standard
/// deviation, extremes with their variants, quantiles, a histogram and Sobol indices. They take two passes
/// over the rows in order, and memory that does not grow with the number of rows: quantiles of up to kBins values are exact, of
/// more to a bin, 1/kBins of the range.
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "app/variants/sobol_indices.hpp"
#include "app/variants/variant_study.hpp"

namespace drev::app {

struct Quantile {
  double part = 0.0, value = 0.0;
  double low = 0.0, high = 0.0;  ///< 95 % interval, from order statistics
};

struct FigureStatistics {
  FigureColumn column;
  std::uint64_t count = 0;  ///< number of finite values; the others are left out
  double mean = 0.0, deviation = 0.0;
  double mean_error = 0.0;  ///< half the 95 % interval of the mean for independent variants, 1.96 s / sqrt(n)
  double min = 0.0, max = 0.0;
  std::uint64_t at_min = 0, at_max = 0;  ///< variants of the extremes
  std::vector<Quantile> quantiles = {};
  std::vector<std::uint64_t> histogram = {};  ///< counts in equal parts from min to max
  std::vector<SobolIndex> indices = {};       ///< indices of each varied parameter; empty: no saltelli sample
};

class VariantStatistics {
 public:
  static constexpr std::size_t kBins = 8192, kBars = 64;

  explicit VariantStatistics(const VariantStudy& study);

  /// First pass: to be called with all rows in order, with their numbers from 0 on.
  void look(std::uint64_t variant, const double* row);
  /// Second pass: to be called with all rows once more.
  void look_again(const double* row);
  void finish();

  const std::vector<FigureStatistics>& figures() const { return figures_; }
  std::uint64_t count(VariantStatus status) const { return statuses_[static_cast<std::size_t>(status)]; }

 private:
  double bin_of(std::size_t figure, double value) const;

  std::vector<FigureStatistics> figures_;
  std::array<std::uint64_t, kVariantStatuses> statuses_{};
  std::vector<double> squares_;                       // sums of squared distances from the mean
  std::vector<std::vector<std::uint64_t>> bins_;      // counts in kBins bins from min to max
  std::vector<std::vector<double>> values_;           // of figures that have at most kBins of them
  std::size_t group_ = 0;                             // number of rows of a block of saltelli; 0: none
  std::vector<SobolIndices> indices_;                 // Sobol indices of each figure
  std::vector<std::vector<double>> values_of_group_;  // values of each figure in the block
  bool independent_ = false;
};

}  // namespace drev::app
