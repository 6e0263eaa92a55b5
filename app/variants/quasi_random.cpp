#include "app/variants/quasi_random.hpp"

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <boost/random/sobol.hpp>
#include <cmath>
#include <numbers>

namespace drev::app {

std::vector<double> sobol_point(std::uint64_t i, std::size_t dimensions, std::uint64_t seed) {
  boost::random::sobol sequence(dimensions);
  sequence.seed(i);
  std::vector<double> point(dimensions);
  for (std::size_t d = 0; d < dimensions; ++d)
    point[d] = to_unit(sequence() ^ hashed(d + 1, hashed(seed, 0)));
  return point;
}

double normal_part(double z) {
  const double part = 0.5 * std::erfc(-z / std::numbers::sqrt2);
  return std::clamp(part, to_unit(0), to_unit(~std::uint64_t{0}));
}

double normal_quantile(double part) { return -std::numbers::sqrt2 * boost::math::erfc_inv(2.0 * part); }

}  // namespace drev::app
