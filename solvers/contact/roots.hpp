#pragma once
/// Polynomials on [0, end] by their coefficients g_0, g_1, ...: value, and the first crossing from
/// g >= 0 to g < 0 with a certificate that none was missed.
///
/// With B >= |g''| on [0, b] (B = sum k (k-1) |g_k| b^(k-2)), b = end, or less for what lies near 0,
/// an interval of centre c and radius r
///   has no root                if |g(c)| > |g'(c)| r + B r^2/2,
///   is monotone                if |g'(c)| > B r: its ends tell; safeguarded Newton finds it,
///   is halved                  otherwise, the left half first.
/// At the smallest radius g and g' both vanish except for rounding (a graze): it crosses if g < 0
/// behind. Source: interval Newton isolation with a centred second-order form, R. E. Moore, R. B.
/// Kearfott, M. J. Cloud, Introduction to Interval Analysis, SIAM, 2009.
#include <optional>
#include <span>
#include <vector>

namespace drev {

/// g(s) by Horner's rule.
double polynomial_value(std::span<const double> g, double s);
/// g'(s) and g''(s).
double polynomial_slope(std::span<const double> g, double s);
double polynomial_curvature(std::span<const double> g, double s);
/// g times another one.
void multiply_polynomial(std::span<const double> by, std::vector<double>& g);

/// First s in (0, end] at which g falls below zero. g_0 must be > 0, or 0 with the first
/// coefficient that is not 0 positive: the root at 0 is divided out and not found again.
std::optional<double> first_crossing(std::span<const double> g, double end);

}  // namespace drev
