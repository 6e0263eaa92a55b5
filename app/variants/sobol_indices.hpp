#pragma once
/// Sobol indices of a figure f of k independent parameters, from blocks of k + 2 values f(A), f(B), f(AB_1) ... f(AB_k)
/// (variant_plan.hpp):
///
///   first order  S_j = V(E(f | x_j)) / V(f) ~ 1/N sum f(B) (f(AB_j) - f(A)) / V
///   total        T_j = E(V(f | x_i, i != j)) / V(f) ~ 1/(2N) sum (f(A) - f(AB_j))^2 / V
///
/// with V the variance of all f(A) and f(B), f measured from their mean. Source: Saltelli and others, Comput. Phys.
/// Commun. 181 (2010) 259, table 2, rows (b) and (f). Standard errors by the jackknife over 32 parts of the blocks.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace drev::app {

struct SobolIndex {
  double first = 0.0, first_error = 0.0;  ///< index; its standard error (95 % interval: 1.96 times it)
  double total = 0.0, total_error = 0.0;
};

class SobolIndices {
 public:
  SobolIndices(std::size_t parameters, std::uint64_t blocks) : parameters_(parameters), blocks_(blocks) {}

  /// Adds the values of block number `block`; a block with a value that is not finite is left out.
  void add(std::uint64_t block, const std::vector<double>& values) {
    for (const double value : values)
      if (!std::isfinite(value)) return;
    if (!begun_) shift_ = values[0], begun_ = true;
    Sums& part = parts_[static_cast<std::size_t>(block * kParts / blocks_)];
    if (part.one.empty()) part = Sums(parameters_);
    const double a = values[0] - shift_, b = values[1] - shift_;
    part.count += 1.0;
    part.sum += a + b;
    part.square += a * a + b * b;
    for (std::size_t j = 0; j < parameters_; ++j) {
      const double ab = values[2 + j] - shift_;
      part.one[j] += b * (ab - a);
      part.change[j] += ab - a;
      part.all[j] += (a - ab) * (a - ab);
    }
  }

  /// The indices of each parameter; empty: the figure does not vary, or there are fewer than two parts.
  std::vector<SobolIndex> indices() const {
    Sums all(parameters_);
    std::vector<const Sums*> filled;
    for (const Sums& part : parts_)
      if (part.count > 0.0) all.add(part, 1.0), filled.push_back(&part);
    std::vector<SobolIndex> result = all.indices();
    if (result.empty() || filled.size() < 2) return {};
    const auto n = static_cast<double>(filled.size());
    std::vector<std::vector<SobolIndex>> without;
    for (const Sums* part : filled) {
      Sums rest = all;
      rest.add(*part, -1.0);
      without.push_back(rest.indices());
      if (without.back().empty()) return {};
    }
    const auto error = [&](std::size_t j, double SobolIndex::*which) {
      double mean = 0.0, spread = 0.0;
      for (const auto& w : without) mean += w[j].*which / n;
      for (const auto& w : without) spread += (w[j].*which - mean) * (w[j].*which - mean);
      return std::sqrt((n - 1.0) / n * spread);
    };
    for (std::size_t j = 0; j < parameters_; ++j) {
      result[j].first_error = error(j, &SobolIndex::first);
      result[j].total_error = error(j, &SobolIndex::total);
    }
    return result;
  }

 private:
  static constexpr std::uint64_t kParts = 32;

  struct Sums {
    Sums() = default;
    explicit Sums(std::size_t parameters) : one(parameters), change(parameters), all(parameters) {}
    double count = 0.0, sum = 0.0, square = 0.0;
    std::vector<double> one, change, all;
    void add(const Sums& other, double sign) {
      count += sign * other.count, sum += sign * other.sum, square += sign * other.square;
      for (std::size_t j = 0; j < one.size(); ++j) {
        one[j] += sign * other.one[j];
        change[j] += sign * other.change[j];
        all[j] += sign * other.all[j];
      }
    }
    std::vector<SobolIndex> indices() const {
      const double mean = sum / (2.0 * count), variance = square / (2.0 * count) - mean * mean;
      if (!(variance > 1e-24 * square / count) || !(count > 1.0)) return {};
      std::vector<SobolIndex> result(one.size());
      for (std::size_t j = 0; j < one.size(); ++j) {
        result[j].first = (one[j] - mean * change[j]) / count / variance;
        result[j].total = all[j] / (2.0 * count) / variance;
      }
      return result;
    }
  };

  std::size_t parameters_;
  std::uint64_t blocks_;
  bool begun_ = false;
  double shift_ = 0.0;  // the first value, subtracted to avoid cancellation
  std::array<Sums, kParts> parts_;
};

}  // namespace drev::app
