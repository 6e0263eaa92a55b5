#pragma once
/// What a study's rows say together: how many ended how, and of each figure mean, standard deviation, extremes with
/// their variants, quantiles, a histogram and Sobol indices. In memory that does not grow with their number, from two
/// passes over the rows in order.
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "app/variants/sobol_indices.hpp"
#include "app/variants/variant_study.hpp"

namespace drev::app {

struct Quantile {
  double part = 0.0, value = 0.0;
  double low = 0.0, high = 0.0;  ///< 95 % interval, by the order statistics whose ranks hold it
};

struct FigureStatistics {
  FigureColumn column;
  std::uint64_t count = 0;  ///< of finite values; the others are left out
  double mean = 0.0, deviation = 0.0;
  double mean_error = 0.0;  ///< half the 95 % interval of the mean, 1.96 s / sqrt(n): of independent variants
  double min = 0.0, max = 0.0;
  std::uint64_t at_min = 0, at_max = 0;  ///< variants
  std::vector<Quantile> quantiles = {};
  std::vector<std::uint64_t> histogram = {};  ///< of equal parts from min to max
  std::vector<SobolIndex> indices = {};       ///< of each parameter varied; empty: no saltelli sample
};

class VariantStatistics {
 public:
  static constexpr std::size_t kBins = 8192, kBars = 64;

  explicit VariantStatistics(const VariantStudy& study);

  /// First all rows here, in order, with their numbers from 0 on ...
  void look(std::uint64_t variant, const double* row);
  /// ... then all once more here.
  void look_again(const double* row);
  void finish();

  const std::vector<FigureStatistics>& figures() const { return figures_; }
  std::uint64_t count(VariantStatus status) const { return statuses_[static_cast<std::size_t>(status)]; }

 private:
  double bin_of(std::size_t figure, double value) const;

  std::vector<FigureStatistics> figures_;
  std::array<std::uint64_t, kVariantStatuses> statuses_{};
  std::vector<double> squares_;                       // sums of squared distances from the mean
  std::vector<std::vector<std::uint64_t>> bins_;      // kBins from min to max
  std::size_t group_ = 0;                             // rows of a block of saltelli; 0: none
  std::vector<SobolIndices> indices_;                 // of each figure
  std::vector<std::vector<double>> values_of_group_;  // of each figure
  bool independent_ = false;
};

}  // namespace drev::app
