#include "app/results/campbell_result.hpp"

#include <drev/core/units.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/base/parameter_text.hpp"
#include "app/base/text_layout.hpp"
#include "app/results/run_json.hpp"
#include "app/run/excitation.hpp"

namespace drev::app {

namespace {

constexpr int kSignificant = 6;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Not a number: the mode does not swing.
double frequency_of(std::complex<double> lambda) { return lambda == 0.0 ? kNone : to_hz(lambda.imag()); }

/// Below kRounding the damping ratio of an undamped mode: 0 without a sign. Not a number: the mode does not swing.
double damping_ratio_of(std::complex<double> lambda) {
  constexpr double kRounding = 1e-12;
  if (lambda == 0.0) return kNone;
  const double ratio = -lambda.real() / std::abs(lambda);
  return std::abs(ratio) > kRounding ? ratio : 0.0;
}

/// Amplitude of a critical speed that comes from its mode relative to the largest finite one [-]; 1 where it is infinite.
double relative(const LinearSweep& sweep, const SweepCritical& critical) {
  double largest = 0.0;
  for (const SweepCritical& c : sweep.criticals)
    if (std::isfinite(c.own_amplitude)) largest = std::max(largest, c.own_amplitude);
  if (!std::isfinite(critical.own_amplitude)) return 1.0;
  return largest > 0.0 ? critical.own_amplitude / largest : 0.0;
}

/// Values as a range where they depend on the speed, without those that are not numbers.
std::string range_text(const std::vector<double>& values, int significant) {
  double low = kNone, high = kNone;
  for (const double value : values) low = std::fmin(low, value), high = std::fmax(high, value);
  if (std::isnan(low)) return "-";
  const std::string from = digits(low, significant), to = digits(high, significant);
  return from == to ? from : from + " .. " + to;
}

/// The speeds [rpm] at which a mode swings, from the first to the last of each run of them.
std::string speeds_text(const Vector& speeds, const std::vector<double>& frequencies) {
  std::string text;
  for (std::size_t i = 0, end = 0; i < frequencies.size(); i = end + 1) {
    for (end = i; end < frequencies.size() && !std::isnan(frequencies[end]);) ++end;
    if (end == i) continue;
    const auto rpm_text = [&](std::size_t at) {
      return short_digits(to_rpm(speeds[static_cast<Eigen::Index>(at)]), kSignificant);
    };
    text += (text.empty() ? "" : ", ") + rpm_text(i) + (end > i + 1 ? " .. " + rpm_text(end - 1) : "");
  }
  return text;
}

/// What modes and criticals lack, and what their stiffness rests on; empty: nothing.
std::string criticals_note(const SweepRequest& request, const LinearSweep& sweep) {
  std::string text = sweep.modes_note;
  if (!follows_mean_torque(request)) return text;
  for (const std::string& note : left_over_notes(request, sweep))
    text += (text.empty() ? "" : text.back() == '.' ? " " : ". ") + note;
  return text;
}

std::string csv_value(double value) { return std::isnan(value) ? "" : to_text(value); }

}  // namespace

std::string campbell_as_text(const SweepRequest& request, const LinearSweep& sweep) {
  const std::string& name = request.model.entry->name;
  std::string text = name + ": " + wrap(parameters_text(request.model.parameters), name.size() + 2);
  text += "speeds " + short_digits(request.speeds_rpm.front(), kSignificant) + " to " +
          short_digits(request.speeds_rpm.back(), kSignificant) + " rpm " +
          of_reference(request.model.model_case.model) +
          (request.options.close_contacts ? ", contacts closed" : "") + "\n\n";
  std::vector<std::vector<std::string>> modes{{"mode", "frequency [Hz]", "damping ratio"}};
  const bool some_stop = (sweep.modes.lambda.array() == 0.0).any();
  if (some_stop) modes.front().emplace_back("swings at [rpm]");
  for (Eigen::Index m = 0; m < sweep.modes.lambda.rows(); ++m) {
    std::vector<double> frequencies, ratios;
    for (const std::complex<double> lambda : sweep.modes.lambda.row(m))
      frequencies.push_back(frequency_of(lambda)), ratios.push_back(damping_ratio_of(lambda));
    modes.push_back({std::to_string(m + 1), range_text(frequencies, kSignificant), range_text(ratios, 4)});
    if (some_stop) modes.back().push_back(speeds_text(sweep.modes.speeds, frequencies));
  }
  text += columns_text(modes) + "\n";
  if (const std::string note = criticals_note(request, sweep); !note.empty())
    text += wrap("Criticals: " + note, 0) + "\n";
  if (sweep.criticals.empty())
    return text + "No order that the loads hold meets a natural frequency within the speeds.\n";
  std::vector<std::vector<std::string>> rows{{"critical [rpm]", "order", "mode", "at [Hz]", "damping ratio",
                                              "amplitude", "of the mode", "relative", "in"}};
  for (const SweepCritical& c : sweep.criticals)
    rows.push_back({digits(to_rpm(c.speed), kSignificant), short_digits(c.order, kSignificant),
                    std::to_string(c.mode + 1), digits(c.frequency_Hz, kSignificant),
                    digits(c.damping_ratio, 3),
                    std::isfinite(c.amplitude) ? digits(c.amplitude, kSignificant) : "unbounded",
                    std::isfinite(c.own_amplitude) ? digits(c.own_amplitude, kSignificant) : "unbounded",
                    digits(relative(sweep, c), 3), sweep.sections[static_cast<std::size_t>(c.section)].name});
  return text + columns_text(rows);
}

Json campbell_object(const SweepRequest& request, const LinearSweep& sweep) {
  Json object = result_object("campbell"), speeds = Json::array(), modes = Json::array(),
       criticals = Json::array();
  object["model"] = request.model.entry->name;
  object["parameters"] = parameters_object(request.model.parameters);
  object["contact"] = request.options.close_contacts ? Json("closed") : Json();
  for (const double speed : sweep.modes.speeds) speeds.push_back(number(to_rpm(speed)));
  for (Eigen::Index m = 0; m < sweep.modes.lambda.rows(); ++m) {
    Json frequency = Json::array(), damping = Json::array();
    for (const std::complex<double> lambda : sweep.modes.lambda.row(m)) {
      frequency.push_back(number(frequency_of(lambda)));
      damping.push_back(number(damping_ratio_of(lambda)));
    }
    modes.push_back({{"mode", m + 1}, {"frequency_Hz", frequency}, {"damping_ratio", damping}});
  }
  for (const SweepCritical& c : sweep.criticals) {
    Json critical = critical_object(sweep, c);
    critical["relative"] = number(relative(sweep, c));
    criticals.push_back(std::move(critical));
  }
  object["reference_shaft"] = text_or_null(reference_node(request.model.model_case.model));
  object["from_rpm"] = request.speeds_rpm.front();
  object["to_rpm"] = request.speeds_rpm.back();
  object["orders"] = sweep.orders;
  object["mode_speeds_rpm"] = std::move(speeds);
  object["modes"] = std::move(modes);
  object["criticals"] = std::move(criticals);
  object["criticals_note"] = text_or_null(criticals_note(request, sweep));
  object["balance"] = text_or_null(request.options.balance);
  object["note"] = text_or_null(request.model.model_case.note);
  return object;
}

std::string campbell_modes_as_csv(const LinearSweep& sweep) {
  std::string text = "speed_rpm";
  for (Eigen::Index m = 1; m <= sweep.modes.lambda.rows(); ++m)
    text += ",mode_" + std::to_string(m) + "_frequency_Hz,mode_" + std::to_string(m) + "_damping_ratio";
  text += "\n";
  for (Eigen::Index i = 0; i < sweep.modes.speeds.size(); ++i) {
    text += to_text(to_rpm(sweep.modes.speeds[i]));
    for (const std::complex<double> lambda : sweep.modes.lambda.col(i))
      text += "," + csv_value(frequency_of(lambda)) + "," + csv_value(damping_ratio_of(lambda));
    text += "\n";
  }
  return text;
}

}  // namespace drev::app
