#pragma once
/// The parameters at which a figure of a model is smallest or largest.
///
/// If all parameters have values and there are no more combinations than variants allowed, all combinations
/// are computed, and the best one is certain. Otherwise a quarter of the variants is a Latin hypercube,
/// computed in lockstep by threads, and the others come from NLopt (S. G. Johnson, The NLopt
/// nonlinear-optimization package) in the unit cube, one after the other:
///
///   values and orders   ESCH, an evolution strategy (C. H. da Silva Santos, M. S. Goncalves, H. E. Hernandez-Figueroa,
///                       Designing Novel Photonic Devices by Bio-Inspired Computing, IEEE Photonics Technology Letters
///                       22, 2010), from the best point. An order of N is N - 1 numbers: the cylinder with the
///                       k-th smallest number is the k-th after cylinder 1 (random keys, J. C. Bean, ORSA Journal
///                       on Computing 6, 1994)
///   uniform             Subplex (T. Rowan, Functional Stability Analysis of Numerical Algorithms, 1990), which needs no
///                       derivatives and no smoothness, from the best points one after another; if there are
///                       also values and orders, in the last quarter of the variants with these fixed
///
/// There is no proof that a search has found the global optimum.
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "app/variants/variant_study.hpp"

namespace drev::app {

struct OptimumOptions {
  static constexpr std::uint64_t kMostVariants = 1000000;
  std::size_t figure = 0;  ///< number in study.figures()
  bool largest = false;
  std::uint64_t variants = 1000;  ///< largest number of variants
  std::uint64_t seed = 1;
  int threads = 1;
  std::function<bool(double part)> go_on = {};  ///< called with the part done, 0 to 1; false: ends the search
};

/// A variant that was computed.
struct TriedVariant {
  ParameterValues values = {};
  VariantStatus status = VariantStatus::failed;
  std::string reason = {};  ///< why it failed, or what its run warns of; empty: neither
  double figure = std::numeric_limits<double>::quiet_NaN();  ///< not finite: the variant has none
};

struct Optimum {
  std::vector<TriedVariant> tried = {};  ///< variants in order of computation, each once
  std::vector<std::size_t> order = {};   ///< numbers of the variants with a figure, the best first
  bool all = false;                      ///< true: these are all combinations, those that failed among them
  bool interrupted = false;
};

/// study: its plan is all combinations, or the initial Latin hypercube. Parameters of normal distributions
/// are refused, since they have no bounds.
Optimum find_optimum(const VariantStudy& study, const OptimumOptions& options);

/// Number of variants in the initial Latin hypercube of a search with this many variants.
std::uint64_t first_sample(std::uint64_t variants);

}  // namespace drev::app
