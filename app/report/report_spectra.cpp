#include "app/report/report_spectra.hpp"

#include <drev/solvers/periodic/spectrum.hpp>

#include <algorithm>
#include <cmath>

#include "app/run/run_result.hpp"

namespace drev::app {

namespace {

constexpr std::size_t kFewest = 64;
constexpr std::size_t kLines = 6000;  // largest number of lines of each channel in the page
constexpr int kPeaks = 6;
constexpr double kRoundingOfSamples = 1e-12;  // over the largest of them: a peak below is none

/// The largest number up to n with the prime factors 2, 3, 5 only, for which the transform is fast.
std::size_t fast_size(std::size_t n) {
  for (std::size_t best = n; best > 1; --best) {
    std::size_t rest = best;
    for (const std::size_t factor : {2UL, 3UL, 5UL})
      while (rest % factor == 0) rest /= factor;
    if (rest == 1) return best;
  }
  return 1;
}

/// Samples at from, from + dt, ...: cubics through the four nearest of the tail, which need not be evenly
/// spaced (constant steps are cut at breakpoints).
std::vector<double> resampled(const ReportHistory& history, std::size_t series, double from, double dt,
                              std::size_t count) {
  std::vector<double> values(count);
  const std::size_t n = history.tail_size();
  std::size_t next = 2;  // number of the third of the four
  for (std::size_t i = 0; i < count; ++i) {
    const double t = from + dt * static_cast<double>(i);
    while (next + 2 < n && history.tail_time(next) < t) ++next;
    double sum = 0.0;
    for (std::size_t j = next - 2; j < next + 2; ++j) {
      double weight = history.tail_value(series, j);
      for (std::size_t k = next - 2; k < next + 2; ++k)
        if (k != j) weight *= (t - history.tail_time(k)) / (history.tail_time(j) - history.tail_time(k));
      sum += weight;
    }
    values[i] = sum;
  }
  return values;
}

/// The largest of each `pool` neighbouring lines, without the mean (line 0).
std::vector<float> pooled(const std::vector<double>& amplitude, std::size_t lines, std::size_t pool) {
  std::vector<float> out;
  for (std::size_t k = 1; k <= lines; ++k) {
    if ((k - 1) % pool == 0) out.push_back(0.0F);
    out.back() = std::max(out.back(), static_cast<float>(amplitude[k]));
  }
  return out;
}

}  // namespace

std::string base64(const void* data, std::size_t bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto* in = static_cast<const unsigned char*>(data);
  std::string text;
  text.reserve((bytes + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes; i += 3) {
    const auto byte = [&](std::size_t k) -> unsigned { return i + k < bytes ? in[i + k] : 0U; };
    const unsigned word = byte(0) << 16 | byte(1) << 8 | byte(2);
    for (unsigned k = 0; k < 4; ++k) text += i + k <= bytes ? kDigits[word >> (18 - 6 * k) & 63U] : '=';
  }
  return text;
}

Json spectra_object(const ReportHistory& history, double begin, double cycle, double nominal,
                    double highest) {
  const std::size_t n = history.tail_size();
  if (n < kFewest) return nullptr;
  const double end = history.tail_time(n - 1);
  begin = std::max({begin, history.tail_time(0), 0.5 * end});
  const double speed = history.mean_speed(begin);
  if (speed > 0.0 && std::abs(speed - nominal) > kSpeedOff * nominal) cycle *= nominal / speed;
  double span = end - begin;
  const double step = (end - history.tail_time(0)) / static_cast<double>(n - 1);
  std::size_t count = fast_size(static_cast<std::size_t>(span / step));
  if (const double cycles = cycle > 0.0 ? std::floor(span / cycle * (1.0 + 1e-9)) : 0.0; cycles >= 1.0) {
    const auto whole = fast_size(static_cast<std::size_t>(cycles));
    span = cycle * static_cast<double>(whole);
    count = whole * fast_size(static_cast<std::size_t>(std::llround(cycle / step)));
  }
  if (count < kFewest / 4) return nullptr;
  const double dt = span / static_cast<double>(count), line = 1.0 / span;
  const auto lines = static_cast<std::size_t>(
      std::min(static_cast<double>(count / 2 - 1), std::ceil(highest / line)));  // highest may be infinite
  const std::size_t pool = (lines + kLines - 1) / kLines;
  Json channels = Json::array();
  for (std::size_t s = 0; s < history.channel_count(); ++s) {
    const auto samples = resampled(history, s, end - span, dt, count);
    if (!std::all_of(samples.begin(), samples.end(), [](double x) { return std::isfinite(x); })) continue;
    const Spectrum all =
        spectrum(samples, dt, {.window = Window::hann, .drop_end_point = false, .remove_mean = true});
    Json peaks = Json::array();
    double largest = 0.0;
    for (const double y : samples) largest = std::max(largest, std::abs(y));
    for (const SpectrumPeak& peak : spectrum_peaks(all, kPeaks, 3.0 * line)) {
      if (!(peak.amplitude > kRoundingOfSamples * largest)) break;
      peaks.push_back({{"frequency_Hz", peak.frequency_Hz}, {"amplitude", peak.amplitude}});
    }
    channels.push_back({{"name", history.series()[s].name},
                        {"unit", history.series()[s].unit},
                        {"amplitude", base64(pooled(all.amplitude, lines, pool))},
                        {"peaks", std::move(peaks)}});
  }
  return {{"from", end - span},
          {"speed", speed},
          {"to", end},
          {"samples", count},
          {"resolution_Hz", line},
          {"line_Hz", line * static_cast<double>(pool)},
          {"pooled", pool},
          {"channels", std::move(channels)}};
}

}  // namespace drev::app
