#include <drev/core/units.hpp>
#include <drev/elements/mesh_stiffness.hpp>

#include <algorithm>
#include <cmath>

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

std::optional<double> MeshStiffness::next_knot(double phase, double direction) const {
  constexpr double kOnKnot = 1e-13;
  if (const auto* step = std::get_if<Step>(&law_)) {
    const double nudge = kOnKnot * std::max(1.0, std::abs(phase));
    const double beyond = direction > 0.0 ? phase + nudge : phase - nudge;
    const double base = std::floor(beyond), middle = base + step->contact_ratio - 1.0;
    if (direction > 0.0) return beyond < middle ? middle : base + 1.0;
    return beyond > middle ? middle : base;
  }
  if (const auto* table = std::get_if<PeriodicTable>(&law_)) return table->next_knot(phase, direction);
  return std::nullopt;
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
    // A series has no closed-form minimum: sample it well above its highest order.
    double highest = 1.0;
    for (const Harmonic& h : series->harmonics) highest = std::max(highest, h.order);
    const int samples = static_cast<int>(std::min(32.0 * highest, 4096.0));
    double lowest = series->mean;
    for (int i = 0; i < samples; ++i) lowest = std::min(lowest, at(double(i) / samples).value);
    if (series->mean > 0.0 && lowest <= 0.0)
      check.fail(parameter, to_text(lowest), "N/m", "is the lowest over the mesh period; it must stay > 0");
  } else {
    const auto& table = std::get<PeriodicTable>(law_);
    table.check(check, parameter, "mesh periods", "N/m");
    for (const double k : table.values())
      if (k <= 0.0) return check.positive(parameter + ".values", k, "N/m");
  }
}

}  // namespace drev
