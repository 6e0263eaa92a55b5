#pragma once
/// The parameters at which a figure of a model is least or largest.
///
/// Where all parameters have values and their combinations are no more than the variants allowed, all are computed: the
/// best one is then certain. Else a quarter of the variants is a Latin hypercube, in lockstep over threads, and the
/// rest is found by NLopt (S. G. Johnson, The NLopt nonlinear-optimization package) in the unit cube, one after the
/// other:
///
///   values and orders   ESCH, an evolution strategy (C. H. da Silva Santos, M. S. Goncalves, H. E. Hernandez-Figueroa,
///                       Designing Novel Photonic Devices by Bio-Inspired Computing, IEEE Photonics Technology Letters
///                       22, 2010), from the best point. An order of N is N - 1 numbers: who has the k-th smallest
///                       number comes k-th behind cylinder 1 (random keys, J. C. Bean, ORSA Journal on Computing 6, 1994)
///   uniform             Subplex (T. Rowan, Functional Stability Analysis of Numerical Algorithms, 1990), which needs no
///                       derivatives and no smoothness, from the best points one after another; with values and orders
///                       beside it for the last quarter of the variants, these held
///
/// Nothing proves that a search has found the least value there is.
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "app/variants/variant_study.hpp"

namespace drev::app {

struct OptimumOptions {
  static constexpr std::uint64_t kMostVariants = 1000000;
  std::size_t figure = 0;  ///< of study.figures()
  bool largest = false;
  std::uint64_t variants = 1000;  ///< at the most
  std::uint64_t seed = 1;
  int threads = 1;
  std::function<bool(double part)> go_on = {};  ///< told the part that is done; false: ends it
};

/// A variant that was computed.
struct TriedVariant {
  ParameterValues values = {};
  VariantStatus status = VariantStatus::failed;
  double figure = std::numeric_limits<double>::quiet_NaN();  ///< not finite: it has none
};

struct Optimum {
  std::vector<TriedVariant> tried = {};  ///< in order of computation, each once
  std::vector<std::size_t> order = {};   ///< of those with a figure, the best first
  bool all = false;                      ///< they are all combinations
  bool interrupted = false;
};

/// study: its plan is all combinations, or the Latin hypercube to begin with. Parameters of normal distributions have no
/// bounds and are not taken.
Optimum find_optimum(const VariantStudy& study, const OptimumOptions& options);

/// So many variants of a search are its Latin hypercube.
std::uint64_t first_sample(std::uint64_t variants);

}  // namespace drev::app
