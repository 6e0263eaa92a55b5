#pragma once
/// The parameters of each variant of a study. Variant i is computed from its number alone, so that memory
/// does not grow with their count and every process gets the same variants.
///
/// Without --sample: every combination of the values, the last parameter varying fastest. With --sample a point
/// u of the unit cube gives each parameter the value x = F^-1(u) of its distribution function F; values and
/// orders are equally likely. u is
///
///   random    independent numbers
///   lhs       Latin hypercube: for each parameter, one u in each of N equal parts of 0..1 (McKay, Beckman,
///             Conover, Technometrics 21, 1979)
///   sobol     Sobol sequence with the direction numbers of Joe and Kuo (Boost), every coordinate's digits
///             shifted by the seed (digital shift), so that each point by itself is uniform
///   saltelli  N blocks of k + 2 variants for k parameters: A, B, and A with parameter j from B, from a Sobol
///             sequence in 2 k dimensions (Saltelli and others, Comput. Phys. Commun. 181, 2010), from which
///             Sobol indices are estimated
///
/// Correlated parameters: z = Phi^-1(u), z' = L z with L L' the correlation matrix, u' = Phi(z') (a Gaussian
/// copula). Normal parameters have these correlations; for others they are those of the underlying normal
/// variables.
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/variants/varied.hpp"

namespace drev::app {

struct Sampling {
  enum class Kind { random, lhs, sobol, saltelli };
  Kind kind = Kind::lhs;
  std::uint64_t points = 0;
  std::uint64_t seed = 1;
};

struct Correlation {
  std::string one, other;
  double value = 0.0;  ///< correlation [-], > -1, < 1
};

class VariantPlan {
 public:
  static constexpr double kMost = 1e12;  ///< largest number of variants

  /// Without sampling, the plan is all combinations of the values, and a distribution among them is a
  /// finding.
  VariantPlan(std::vector<Varied> varied, std::optional<Sampling> sampling,
              std::vector<Correlation> correlations, std::vector<Finding>& findings);

  std::uint64_t count() const { return count_; }
  ParameterValues parameters(std::uint64_t i) const;
  const std::vector<Varied>& varied() const { return varied_; }
  const std::optional<Sampling>& sampling() const { return sampling_; }
  const std::vector<Correlation>& correlations() const { return correlations_; }

 private:
  void read_correlations(std::vector<Finding>& findings);
  double coordinate(std::uint64_t i, std::size_t dimension) const;
  std::vector<double> unit_point(std::uint64_t i) const;

  std::vector<Varied> varied_;
  std::optional<Sampling> sampling_;
  std::vector<Correlation> correlations_;
  Eigen::MatrixXd factor_;  // L; empty: no correlations
  std::uint64_t count_ = 0;
};

/// Reads --sample KIND:N or KIND:N:SEED, --correlate A,B=VALUE. Faults are added to findings.
std::optional<Sampling> read_sampling(const std::string& text, std::vector<Finding>& findings);
std::vector<Correlation> read_correlations(const std::vector<std::string>& words,
                                           std::vector<Finding>& findings);
/// The sampling as it was given.
std::string sampling_text(const Sampling& sampling);

}  // namespace drev::app
