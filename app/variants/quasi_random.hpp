#pragma once
/// Numbers between 0 and 1 that are functions of their index alone.
#include <cstddef>
#include <cstdint>
#include <vector>

namespace drev::app {

/// Hash of (i, key): SplitMix64's finaliser (Steele, Lea, Flood 2014) of their sum.
constexpr std::uint64_t hashed(std::uint64_t i, std::uint64_t key) {
  std::uint64_t z = key + (i + 1) * 0x9e3779b97f4a7c15U;
  z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9U;
  z = (z ^ z >> 27) * 0x94d049bb133111ebU;
  return z ^ z >> 31;
}

/// The middle of one of 2^52 equal parts of 0..1: never 0, never 1.
constexpr double to_unit(std::uint64_t bits) {
  return (static_cast<double>(bits >> 12) + 0.5) / static_cast<double>(std::uint64_t{1} << 52);
}

inline constexpr std::size_t kMostDimensions = 200;

/// Point i of the Sobol sequence in up to kMostDimensions dimensions, with digits shifted by the seed.
std::vector<double> sobol_point(std::uint64_t i, std::size_t dimensions, std::uint64_t seed);

/// Distribution function Phi(z) of the standard normal distribution, kept inside 0..1; and its inverse, 0 <
/// part < 1.
double normal_part(double z);
double normal_quantile(double part);

}  // namespace drev::app
