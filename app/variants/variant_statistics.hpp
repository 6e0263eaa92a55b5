#pragma once
/// Statistics of a study's rows: the number of variants with each status, and for each figure mean, standard
/// deviation, extremes with their variants, quantiles, a histogram and Sobol indices. They take two passes
/// over the rows in order, and memory that does not grow with the number of rows: quantiles of up to kBins values are exact, of
/// more to a bin, 1/kBins of the range.
///
/// Of a saltelli sample, mean, deviation and quantiles are of the rows A and B alone, which are independent: each other row
/// has all but one of its parameters from A, so that many add next to nothing to what is known, and would count as much.
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "app/variants/sobol_indices.hpp"
#include "app/variants/variant_study.hpp"

namespace drev::app {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

struct Quantile {
  double part = 0.0, value = 0.0;
  /// 95 % interval, from order statistics; not a number where that of the mean is not known, and at an end beyond all values.
  double low = kUnknown, high = kUnknown;
};

struct FigureStatistics {
  FigureColumn column;
  std::uint64_t count = 0;  ///< number of finite values; the others are left out
  double mean = 0.0, deviation = 0.0;
  /// Half the 95 % interval of the mean for independent variants, t s/sqrt(n) with Student's t; not a number where it is not known: of
  /// what is no sample, and of a single point or value.
  double mean_error = kUnknown;
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
  void look_again(std::uint64_t variant, const double* row);
  void finish();

  const std::vector<FigureStatistics>& figures() const { return figures_; }
  std::uint64_t count(VariantStatus status) const { return statuses_[static_cast<std::size_t>(status)]; }

 private:
  /// Whether the mean is of this row, too.
  bool is_independent(std::uint64_t variant) const { return group_ == 0 || variant % group_ < 2; }
  double bin_of(std::size_t figure, double value) const;

  std::vector<FigureStatistics> figures_;
  std::array<std::uint64_t, kVariantStatuses> statuses_{};
  std::vector<std::uint64_t> used_;                   // number of finite values of independent rows
  std::vector<double> squares_;                       // sums of squared distances from the mean
  std::vector<std::vector<std::uint64_t>> bins_;      // their counts in kBins bins from min to max
  std::vector<std::vector<double>> values_;           // of figures that have at most kBins of them
  std::size_t group_ = 0;                             // number of rows of a block of saltelli; 0: none
  std::vector<SobolIndices> indices_;                 // Sobol indices of each figure
  std::vector<std::vector<double>> values_of_group_;  // values of each figure in the block
  bool has_intervals_ = false;
};

}  // namespace drev::app
