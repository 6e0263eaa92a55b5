#include "app/report/sweep_report.hpp"

#include <drev/core/units.hpp>
#include <drev/solvers/strength/class_judgement.hpp>

#include <algorithm>
#include <cmath>

#include "app/report/report_campbell.hpp"
#include "app/report/report_model.hpp"
#include "app/report/report_origin.hpp"
#include "app/report/report_spectra.hpp"
#include "app/results/campbell_result.hpp"

namespace drev::app {

namespace {

std::string floats(const Vector& values) {
  std::vector<float> list;
  for (const double value : values) list.push_back(static_cast<float>(value));
  return base64(list);
}

/// The amplitudes order by order, each over all speeds.
std::string amplitudes(const SweepSection& section) {
  std::vector<float> list;
  for (Eigen::Index k = 0; k < section.amplitude.rows(); ++k)
    for (Eigen::Index i = 0; i < section.amplitude.cols(); ++i)
      list.push_back(static_cast<float>(std::abs(section.amplitude(k, i))));
  return base64(list);
}

/// Local maxima of the half range, including those between the speeds; the largest first.
Json peaks_of(const LinearSweep& sweep, int number_of_section) {
  const SweepLargest largest = largest_half_range(sweep, number_of_section);
  Json list = Json::array();
  for (const SweepPeak& peak : sweep.peaks)
    if (peak.section == number_of_section)
      list.push_back({{"speed_rpm", number(to_rpm(peak.speed))}, {"half_range", number(peak.half_range)}});
  const double first = list.empty()                      ? 0.0
                       : list[0]["half_range"].is_null() ? HUGE_VAL
                                                         : list[0]["half_range"].get<double>();
  if (list.empty() || first < largest.value)
    list.insert(list.begin(),
                Json{{"speed_rpm", number(to_rpm(largest.speed))}, {"half_range", number(largest.value)}});
  return list;
}

/// The criticals as they are in a section, whose own list names one of the sections for each, without those that are small there.
Json criticals_in(const LinearSweep& sweep, std::size_t section) {
  constexpr double kSmall = 1e-3;  // relative to the largest one in the section [-]
  const auto bounded = [](double amplitude) { return std::isfinite(amplitude) ? amplitude : 0.0; };
  double largest = 0.0;
  for (const SweepCritical& critical : sweep.criticals)
    largest = std::max(largest, bounded(critical.in_sections[section].amplitude));
  Json list = Json::array();
  for (const SweepCritical& critical : sweep.criticals)
    if (const SweepCritical::InSection& in = critical.in_sections[section]; in.amplitude > kSmall * largest)
      list.push_back({{"speed_rpm", number(to_rpm(in.speed))},
                      {"order", critical.order},
                      {"mode", critical.mode + 1},
                      {"amplitude", number(in.amplitude)},
                      {"of_mode", in.is_mode()}});
  return list;
}

/// The means of a section, with 0 where they are rounding relative to the largest mean.
Vector rounded_means(const SweepSection& section, double largest) {
  constexpr double kRounding = 1e-12;
  Vector mean = section.mean;
  for (double& value : mean)
    if (std::abs(value) <= kRounding * largest) value = 0.0;
  return mean;
}

Json sweep_data(const std::string& name, const std::vector<double>& speeds_rpm, const LinearSweep& sweep,
                const std::vector<DrawnLimit>& limits) {
  Json sections = Json::array(), criticals = Json::array();
  double largest_mean = 0.0;
  for (const SweepSection& s : sweep.sections)
    largest_mean = std::max(largest_mean, s.mean.cwiseAbs().maxCoeff());
  for (std::size_t c = 0; c < sweep.sections.size(); ++c) {
    const SweepSection& s = sweep.sections[c];
    Json drawn = Json::array();
    for (const DrawnLimit& limit : limits)
      if (limit.section == static_cast<int>(c))
        drawn.push_back({{"name", limit.name}, {"values", floats(limit.values)}});
    sections.push_back({{"name", s.name},
                        {"unit", s.unit},
                        {"half_range", floats(s.half_range())},
                        {"maximum", floats(s.maximum)},
                        {"minimum", floats(s.minimum)},
                        {"mean", floats(rounded_means(s, largest_mean))},
                        {"heat", floats(s.heat)},
                        {"largest_heat", number(largest_heat(sweep, static_cast<int>(c)).value)},
                        {"amplitude", amplitudes(s)},
                        {"unbounded", std::isinf(largest_half_range(sweep, static_cast<int>(c)).value)},
                        {"peaks", peaks_of(sweep, static_cast<int>(c))},
                        {"criticals", criticals_in(sweep, c)},
                        {"limits", std::move(drawn)}});
  }
  for (const SweepCritical& critical : sweep.criticals) criticals.push_back(critical_object(sweep, critical));
  return {{"name", name},
          {"speeds_rpm", speeds_rpm},
          {"orders", sweep.orders},
          {"sections", std::move(sections)},
          {"criticals", std::move(criticals)}};
}

}  // namespace

std::vector<DrawnLimit> limits_of(const Strength& strength, const std::vector<std::string>& sections,
                                  const std::vector<double>& speeds) {
  std::vector<DrawnLimit> limits;
  for (const SectionStrength& s : strength.sections) {
    const auto found = std::find(sections.begin(), sections.end(), s.element + ".torque_Nm");
    if (found == sections.end()) continue;
    const auto add = [&](const std::string& name, double TorqueLimit::*value) {
      DrawnLimit limit{static_cast<int>(found - sections.begin()), name,
                       Vector(static_cast<Eigen::Index>(speeds.size()))};
      for (std::size_t i = 0; i < speeds.size(); ++i)
        limit.values[static_cast<Eigen::Index>(i)] = torque_limit(s, speeds[i] / strength.rated_speed).*value;
      if (!limit.values.array().isNaN().all()) limits.push_back(std::move(limit));
    };
    add("permissible", &TorqueLimit::continuous);
    add("permissible while passed", &TorqueLimit::transient);
  }
  return limits;
}

Json sweep_report_data(const SweepRequest& request, const LinearSweep& sweep, const std::string& title,
                       const std::string& words, const std::vector<DrawnLimit>& limits,
                       const std::vector<SweepBeside>& beside) {
  const ModelRequest& m = request.model;
  Json data = page_data("sweep", title, m, words);
  data["contact"] = request.options.close_contacts ? Json("closed") : Json();
  data["notes"] = sweep_notes(request, sweep);
  data["shaft"] = reference_name(m.model_case.model);
  data["criticals_note"] = text_or_null(sweep.modes_note);
  data["campbell"] = sweep.modes.lambda.size() > 0 ? campbell_object(request, sweep) : Json();
  data["sweeps"] = Json::array({sweep_data("", request.speeds_rpm, sweep, limits)});
  for (const SweepBeside& other : beside)
    data["sweeps"].push_back(sweep_data(other.name, request.speeds_rpm, *other.sweep, {}));
  return data;
}

}  // namespace drev::app
