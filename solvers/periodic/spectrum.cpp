#include <drev/core/error.hpp>
#include <drev/core/units.hpp>
#include <drev/solvers/periodic/spectrum.hpp>

#include <algorithm>
#include <cmath>
#include <complex>

#include "core/dense/fourier.hpp"

namespace drev {

namespace {

/// Coefficients a_m of a window in its periodic form: w_j = sum_m a_m cos(2 pi m j / N).
std::vector<double> window_terms(Window window) {
  switch (window) {
    case Window::rectangular:
      return {1.0};
    case Window::hann:
      return {0.5, -0.5};
    case Window::hamming:
      return {0.54, -0.46};
    case Window::flat_top:
      return {0.21557895, -0.41663158, 0.277263158, -0.083578947, 0.006947368};
  }
  return {1.0};
}

/// Amplitude that a tone of amplitude 1 shows at a line x lines away from it (N large):
///   R(x) = |sin(pi x) / (pi x) sum_m a_m x^2 / (x^2 - m^2)| / a_0,  R(m) = |a_m| / (2 a_0)
double window_response(const std::vector<double>& terms, double x) {
  const auto nearest = static_cast<std::size_t>(std::lround(std::abs(x)));
  if (std::abs(std::abs(x) - static_cast<double>(nearest)) < 1e-9)
    return nearest == 0 ? 1.0 : nearest < terms.size() ? 0.5 * std::abs(terms[nearest]) / terms[0] : 0.0;
  double sum = terms[0];
  for (std::size_t m = 1; m < terms.size(); ++m)
    sum += terms[m] * x * x / (x * x - static_cast<double>(m * m));
  return std::abs(std::sin(kPi * x) / (kPi * x) * sum) / terms[0];
}

/// Distance of the tone from its largest line, 0 to 0.5 lines, from the ratio of the larger neighbour to that
/// line.
double distance_from_line(const std::vector<double>& terms, double neighbour_share) {
  double low = 0.0, high = 0.5;
  for (int i = 0; i < 50; ++i) {
    const double x = 0.5 * (low + high);
    const double share = window_response(terms, 1.0 - x) / window_response(terms, x);
    (share < neighbour_share ? low : high) = x;
  }
  return 0.5 * (low + high);
}

}  // namespace

Spectrum spectrum(const std::vector<double>& samples, double dt, const SpectrumOptions& options) {
  const std::size_t dropped = options.drop_end_point && !samples.empty() ? 1 : 0;
  const std::size_t n = samples.size() - dropped;
  std::vector<Finding> findings;
  ParameterCheck check("spectrum", findings);
  check.positive("dt", dt, "s");
  check.all_finite("samples", samples, "");
  if (n < 4)
    check.fail("samples", std::to_string(samples.size()), "",
               std::string("must be at least ") + (options.drop_end_point ? "5" : "4") +
                   (options.drop_end_point ? ", the end point among them" : ""));
  if (!findings.empty()) throw ModelError(findings);

  const std::vector<double> terms = window_terms(options.window);
  double mean = 0.0;
  if (options.remove_mean) {
    for (std::size_t j = 0; j < n; ++j) mean += samples[j];
    mean /= static_cast<double>(n);
  }
  std::vector<double> windowed(n);
  double window_sum = 0.0;
  for (std::size_t j = 0; j < n; ++j) {
    double w = 0.0;
    for (std::size_t m = 0; m < terms.size(); ++m)
      w += terms[m] * std::cos(kTwoPi * static_cast<double>((m * j) % n) / static_cast<double>(n));
    windowed[j] = w * (samples[j] - mean);
    window_sum += w;
  }
  std::vector<std::complex<double>> lines;
  FourierTransform transform;
  transform.forward(lines, windowed);

  Spectrum result;
  result.window = options.window;
  for (std::size_t k = 0; k <= n / 2; ++k) {
    const double sides = k == 0 || 2 * k == n ? 1.0 : 2.0;
    result.frequency_Hz.push_back(static_cast<double>(k) / (static_cast<double>(n) * dt));
    result.amplitude.push_back(sides * std::abs(lines[k]) / window_sum);
    result.phase.push_back(std::arg(lines[k]));
  }
  return result;
}

std::vector<SpectrumPeak> spectrum_peaks(const Spectrum& spectrum, int count, double min_separation_Hz) {
  std::vector<Finding> findings;
  ParameterCheck check("spectrum peaks", findings);
  if (count < 1) check.fail("count", std::to_string(count), "", "must be >= 1");
  check.non_negative("min_separation_Hz", min_separation_Hz, "Hz");
  if (!findings.empty()) throw ModelError(findings);

  const std::vector<double>& a = spectrum.amplitude;
  const std::vector<double> terms = window_terms(spectrum.window);
  const double step = spectrum.frequency_Hz.size() > 1 ? spectrum.frequency_Hz[1] : 0.0;
  std::vector<SpectrumPeak> found;
  for (std::size_t k = 1; k + 1 < a.size(); ++k) {
    if (!(a[k] > a[k - 1] && a[k] >= a[k + 1])) continue;
    const bool upward = a[k + 1] >= a[k - 1];
    const double x = distance_from_line(terms, (upward ? a[k + 1] : a[k - 1]) / a[k]);
    found.push_back({spectrum.frequency_Hz[k] + (upward ? x : -x) * step, a[k] / window_response(terms, x)});
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const SpectrumPeak& x, const SpectrumPeak& y) { return x.amplitude > y.amplitude; });
  std::vector<SpectrumPeak> kept;
  for (const SpectrumPeak& peak : found) {
    const bool near = std::any_of(kept.begin(), kept.end(), [&](const SpectrumPeak& other) {
      return std::abs(other.frequency_Hz - peak.frequency_Hz) < min_separation_Hz;
    });
    if (!near) kept.push_back(peak);
    if (static_cast<int>(kept.size()) == count) break;
  }
  return kept;
}

}  // namespace drev
