#pragma once
/// Exact line search along a Newton direction. The derivative g(alpha) of the potential is monotone and,
/// between the kinks of piecewise-linear laws, linear: its zero is found by bisection over the kinks and
/// one interpolation; for smooth laws the interpolation is repeated (safeguarded secant). With it
/// Newton's method cannot cycle at a dead zone: a strictly convex potential falls in every step.
#include <algorithm>
#include <cmath>
#include <vector>

namespace drev {

/// alpha > 0 with g(alpha) = 0; the largest alpha tried if g stays negative that far; the place of the
/// sign change if g jumps over zero. g(0) = g_0 < 0 is required (a descent direction). kinks: values of
/// alpha at which g changes slope, in any order (sorted in place).
template <class Slope>
double exact_line_search(const Slope& g, double g_0, std::vector<double>& kinks) {
  constexpr double kLargest = 1024.0, kRelative = 1e-12;
  double low = 0.0, g_low = g_0, high = 1.0, g_high = g(1.0);
  while (g_high < 0.0 && high < kLargest) {
    low = high, g_low = g_high;
    high *= 2.0, g_high = g(high);
  }
  if (g_high <= 0.0) return high;
  std::sort(kinks.begin(), kinks.end());
  auto first = std::upper_bound(kinks.begin(), kinks.end(), low);
  auto last = std::lower_bound(first, kinks.end(), high);
  while (first != last) {
    const auto middle = first + (last - first) / 2;
    const double value = g(*middle);
    if (value <= 0.0) {
      low = *middle, g_low = value;
      first = middle + 1;
    } else {
      high = *middle, g_high = value;
      last = middle;
    }
  }
  // No kink between low and high any more: the first interpolation is exact for linear pieces.
  for (int i = 0; i < 60 && high - low > kRelative * high; ++i) {
    double alpha = low - g_low * (high - low) / (g_high - g_low);
    if (i > 3 && i % 2 == 0) alpha = 0.5 * (low + high);
    const double value = g(alpha);
    if (std::abs(value) <= kRelative * std::abs(g_0)) return alpha;
    (value < 0.0 ? low : high) = alpha;
    (value < 0.0 ? g_low : g_high) = value;
  }
  return 0.5 * (low + high);
}

}  // namespace drev
