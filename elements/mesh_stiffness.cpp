#include <drev/core/units.hpp>
#include <drev/elements/mesh_stiffness.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

namespace drev {

MeshStiffness MeshStiffness::step(double single, double both, double contact_ratio) {
  return MeshStiffness(Law(Step{single, both, contact_ratio}));
}

MeshStiffness MeshStiffness::fourier(double mean, std::vector<Harmonic> harmonics) {
  return MeshStiffness(Law(Fourier{mean, std::move(harmonics)}));
}

MeshStiffness MeshStiffness::fourier_of_step(double single, double both, double contact_ratio,
                                             int harmonics) {
  const double w = contact_ratio - 1.0;
  std::vector<Harmonic> series;
  for (int n = 1; n <= harmonics; ++n) {
    const double angle = kPi * n * w;
    series.push_back({.order = static_cast<double>(n),
                      .amplitude = 2.0 * (both - single) * std::sin(angle) / (kPi * n),
                      .phase = -angle});
  }
  return fourier(single + (both - single) * w, std::move(series));
}

MeshStiffness MeshStiffness::table(std::vector<double> phases, std::vector<double> stiffnesses) {
  return MeshStiffness(Law(PeriodicTable(std::move(phases), std::move(stiffnesses), 1.0)));
}

/// A value over the period that is not positive, if there is one; else some positive value. A stretch of half
/// width r about a point is left as soon as value - |slope| r - curvature r^2/2, which no value in it is below, is
/// positive; the others are halved.
double MeshStiffness::low_value_of(const Fourier& series) {
  constexpr double kFinest = 1e-9;  // part of the period: narrower positive minima are taken as they are
  double size = 0.0, curvature = 0.0, phases = 0.0;
  for (const Harmonic& h : series.harmonics) {
    size += std::abs(h.amplitude);
    curvature += std::abs(h.amplitude) * std::pow(kTwoPi * h.order, 2);
    phases += h.phase;
  }
  if (size < series.mean || !std::isfinite(curvature + phases)) return series.mean - size;
  // mean + Re sum c_n z^n at z = exp(2 pi i s), by Horner's rule: far cheaper than cosines where n is large.
  std::vector<std::complex<double>> c(1, series.mean);
  for (const Harmonic& h : series.harmonics) {
    const auto n = static_cast<std::size_t>(h.order);
    if (c.size() <= n) c.resize(n + 1);
    c[n] += std::polar(1.0, h.phase) * h.amplitude;
  }
  struct Stretch {
    double middle, r;
  };
  std::vector<Stretch> open;
  const auto count = static_cast<double>(c.size());
  for (double i = 0.0; i < count; i += 1.0) open.push_back({(i + 0.5) / count, 0.5 / count});
  double lowest = series.mean;
  while (!open.empty() && lowest > 0.0) {
    const auto [middle, r] = open.back();
    open.pop_back();
    const std::complex<double> z = std::polar(1.0, kTwoPi * middle);
    std::complex<double> sum, slope;
    for (auto n = c.rbegin(); n != c.rend(); ++n) slope = slope * z + sum, sum = sum * z + *n;
    const double value = sum.real(), steepness = kTwoPi * std::abs((slope * z).imag());
    lowest = std::min(lowest, value);
    if (value - steepness * r - 0.5 * curvature * r * r > 0.0 || r < kFinest) continue;
    for (const double side : {-0.5, 0.5}) open.push_back({middle + side * r, 0.5 * r});
  }
  return lowest;
}

CurvePoint MeshStiffness::at(double phase) const {
  if (const auto* k = std::get_if<double>(&law_)) return {*k, 0.0};
  if (const auto* step = std::get_if<Step>(&law_)) {
    const double s = phase - std::floor(phase);
    return {s < step->contact_ratio - 1.0 ? step->both : step->single, 0.0};
  }
  if (const auto* series = std::get_if<Fourier>(&law_)) {
    const CurvePoint sum = sum_at(series->harmonics, kTwoPi * phase);
    return {series->mean + sum.value, kTwoPi * sum.slope};
  }
  return std::get<PeriodicTable>(law_).at(phase);
}

double MeshStiffness::mean() const {
  if (const auto* k = std::get_if<double>(&law_)) return *k;
  if (const auto* step = std::get_if<Step>(&law_))
    return step->single + (step->both - step->single) * (step->contact_ratio - 1.0);
  if (const auto* series = std::get_if<Fourier>(&law_)) return series->mean;
  return std::get<PeriodicTable>(law_).mean();
}

TableStretch MeshStiffness::stretch(double phase, double direction) const {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  constexpr double kOnKnot = 1e-13;
  if (const auto* table = std::get_if<PeriodicTable>(&law_)) return table->stretch(phase, direction);
  const auto* step = std::get_if<Step>(&law_);
  if (step == nullptr) return {mean(), 0.0, -kInfinite, kInfinite};
  const double nudge = kOnKnot * std::max(1.0, std::abs(phase));
  const double beyond = direction > 0.0 ? phase + nudge : phase - nudge;
  const double base = std::floor(beyond), middle = base + step->contact_ratio - 1.0;
  if (beyond < middle) return {step->both, 0.0, base, middle};
  return {step->single, 0.0, middle, base + 1.0};
}

std::optional<double> MeshStiffness::next_knot(double phase, double direction) const {
  if (const auto* table = std::get_if<PeriodicTable>(&law_)) return table->next_knot(phase, direction);
  if (!std::holds_alternative<Step>(law_)) return std::nullopt;
  const TableStretch here = stretch(phase, direction);
  return direction > 0.0 ? here.high : here.low;
}

void MeshStiffness::check(ParameterCheck& check, const std::string& parameter) const {
  if (const auto* k = std::get_if<double>(&law_)) {
    check.positive(parameter, *k, "N/m");
  } else if (const auto* step = std::get_if<Step>(&law_)) {
    check.positive(parameter + ".single", step->single, "N/m");
    check.positive(parameter + ".double", step->both, "N/m");
    if (!(step->contact_ratio > 1.0 && step->contact_ratio < 2.0))
      check.fail(parameter + ".contact_ratio", to_text(step->contact_ratio), "",
                 "must be greater than 1 and less than 2");
  } else if (const auto* series = std::get_if<Fourier>(&law_)) {
    check.positive(parameter + ".mean", series->mean, "N/m");
    check_harmonics(check, parameter + ".harmonics", series->harmonics, "N/m", true);
    const bool in_range =
        std::all_of(series->harmonics.begin(), series->harmonics.end(), [](const Harmonic& h) {
          return h.order >= 1.0 && h.order <= kMostOrder && h.order == std::floor(h.order);
        });
    for (std::size_t i = 0; i < series->harmonics.size(); ++i)
      if (series->harmonics[i].order > kMostOrder)
        check.fail(parameter + ".harmonics[" + std::to_string(i) + "].order",
                   to_text(series->harmonics[i].order), "", "must be at most " + to_text(kMostOrder));
    const double low = in_range && series->mean > 0.0 ? low_value_of(*series) : 1.0;
    if (low <= 0.0)
      check.fail(parameter, to_text(low), "N/m", "is a value in the mesh period; it must stay > 0");
  } else {
    const auto& table = std::get<PeriodicTable>(law_);
    table.check(check, parameter, "mesh periods", "N/m");
    for (const double k : table.values())
      if (k <= 0.0) return check.positive(parameter + ".values", k, "N/m");
  }
}

}  // namespace drev
