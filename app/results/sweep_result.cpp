#include "app/results/sweep_result.hpp"

#include <drev/core/law/frequency_stiffness.hpp>
#include <drev/core/units.hpp>

#include <algorithm>
#include <cmath>

#include "app/base/csv_cell.hpp"
#include "app/base/parameter_text.hpp"
#include "app/base/text_layout.hpp"
#include "app/results/run_json.hpp"
#include "app/run/excitation.hpp"

namespace drev::app {

namespace {

constexpr int kDigits = 6;
constexpr std::size_t kCriticalsShown = 20;
constexpr double kRounding = 1e-12;  // mean relative to the largest mean that is rounding [-]
constexpr double kBent = 1e-3;       // force off the straight line that is reported, relative to it [-]
constexpr double kBalanced = 1e-6;   // unbalanced torque relative to the mean torques that is reported [-]

Vector absolute_sum(const SweepSection& section) { return section.amplitude.cwiseAbs().colwise().sum(); }

const std::string& name_of(const LinearSweep& sweep, int section) {
  return sweep.sections[static_cast<std::size_t>(section)].name;
}

double largest(const Vector& values) { return values.size() > 0 ? values.cwiseAbs().maxCoeff() : 0.0; }

/// The value with the largest amount, with its sign.
double farthest(const Vector& values) {
  Eigen::Index at = 0;
  if (values.size() > 0) values.cwiseAbs().maxCoeff(&at);
  return values.size() > 0 ? values[at] : 0.0;
}

std::string bounded(double value) { return std::isfinite(value) ? digits(value, kDigits) : "unbounded"; }

std::string sections_text(const SweepRequest& request, const LinearSweep& sweep) {
  std::vector<std::vector<std::string>> rows{
      {"section", "half range", "at [rpm]", "largest mean", "twist half range", "heat [W]"}};
  if (request.absolute_sum) rows.front().emplace_back("absolute sum");
  double largest_mean = 0.0;
  for (const SweepSection& s : sweep.sections) largest_mean = std::max(largest_mean, largest(s.mean));
  for (std::size_t c = 0; c < sweep.sections.size(); ++c) {
    const SweepSection& s = sweep.sections[c];
    const auto section = static_cast<int>(c);
    const SweepLargest half = largest_half_range(sweep, section);
    const double mean = largest(s.mean) > kRounding * largest_mean ? farthest(s.mean) : 0.0;
    rows.push_back(
        {s.name, bounded(half.value), digits(to_rpm(half.speed), kDigits), digits(mean, kDigits),
         s.twist_unit.empty() ? "" : bounded(largest_twist(sweep, section).value) + " " + s.twist_unit,
         bounded(largest_heat(sweep, section).value)});
    if (request.absolute_sum) rows.back().push_back(bounded(absolute_sum(s).maxCoeff()));
  }
  return columns_text(rows);
}

std::string criticals_text(const LinearSweep& sweep) {
  const std::string note = sweep.modes_note.empty() ? "" : wrap("Criticals: " + sweep.modes_note, 0);
  if (sweep.criticals.empty() && sweep.modes.lambda.size() == 0 && !note.empty()) return note;
  if (sweep.criticals.empty())
    return note + "No order that the loads hold meets a natural frequency within the speeds.\n";
  std::vector<SweepCritical> shown = sweep.criticals;
  std::stable_sort(shown.begin(), shown.end(),
                   [](const auto& a, const auto& b) { return a.own_amplitude > b.own_amplitude; });
  if (shown.size() > kCriticalsShown) shown.resize(kCriticalsShown);
  std::stable_sort(shown.begin(), shown.end(),
                   [](const auto& a, const auto& b) { return a.speed < b.speed; });
  std::vector<std::vector<std::string>> rows{
      {"critical [rpm]", "order", "mode", "at [Hz]", "damping ratio", "amplitude", "half range", "in"}};
  for (const SweepCritical& c : shown)
    rows.push_back({digits(to_rpm(c.speed), kDigits), short_digits(c.order, kDigits),
                    std::to_string(c.mode + 1), digits(c.frequency_Hz, kDigits), digits(c.damping_ratio, 3),
                    bounded(c.amplitude), bounded(c.half_range), name_of(sweep, c.section)});
  std::string text = columns_text(rows);
  if (shown.size() < sweep.criticals.size())
    text += "... the " + std::to_string(shown.size()) + " largest of " +
            std::to_string(sweep.criticals.size()) + "; --json and --out have all\n";
  return note + text;
}

Json section_object(const SweepRequest& request, const SweepSection& s) {
  Json amplitude = Json::array(), phase = Json::array();
  for (Eigen::Index k = 0; k < s.amplitude.rows(); ++k) {
    amplitude.push_back(numbers(Vector(s.amplitude.row(k).cwiseAbs())));
    phase.push_back(numbers(Vector(s.amplitude.row(k).cwiseArg()), to_deg(1.0)));
  }
  Json separates;
  if (s.contact) {
    separates = Json::array();
    for (Eigen::Index i = 0; i < s.mean.size(); ++i) separates.push_back(s.separates(i));
  }
  Json twist;
  if (!s.twist_unit.empty())
    twist = {
        {"unit", s.twist_unit}, {"mean", numbers(s.twist_mean)}, {"half_range", numbers(s.twist_half_range)}};
  return {{"name", s.name},
          {"unit", s.unit},
          {"half_range", numbers(s.half_range())},
          {"maximum", numbers(s.maximum)},
          {"minimum", numbers(s.minimum)},
          {"maximum_at_deg", numbers(s.maximum_angle, to_deg(1.0))},
          {"minimum_at_deg", numbers(s.minimum_angle, to_deg(1.0))},
          {"mean", numbers(s.mean)},
          {"heat_W", numbers(s.heat)},
          {"heat_peak_W", number(s.heat_peak)},
          {"heat_peak_rpm", number(to_rpm(s.heat_peak_speed))},
          {"twist", twist},
          {"separates", separates},
          {"absolute_sum", request.absolute_sum ? numbers(absolute_sum(s)) : Json()},
          {"amplitude", amplitude},
          {"phase_deg", phase}};
}

std::string cell(double value) { return std::isfinite(value) ? to_text(value) : ""; }

}  // namespace

void LeftOver::note(double left_over, double speed_rpm, double little) {
  ++speeds;
  if (!(std::abs(left_over) > little)) return;
  ++count;
  if (!(std::abs(left_over) > most)) return;
  most = std::abs(left_over);
  at_rpm = speed_rpm;
}

std::string left_over_sentence(const LeftOver& left, const std::string& part, const std::string& moving,
                               const std::string& balance) {
  return "Mean torque does not balance at " + std::to_string(left.count) + " of " +
         std::to_string(left.speeds) + " speeds: up to " + digits(left.most, kDigits) + " N m, at " +
         short_digits(left.at_rpm, 8) + " rpm, are left over " +
         (left.of > 0.0 ? "of mean torques of up to " + digits(left.of, kDigits) + " N m " : "") +
         "on the part of " + part + " (referred to the reference shaft). " +
         (balance.empty() ? moving : "It is taken up at " + balance + ".");
}

namespace {

/// The torque or force of a section at which its law is farthest off the straight line y = k x; 0: nowhere.
double most_bent(const ScalarForce& law, double k, const SweepSection& section) {
  double off = 0.0, at = 0.0;
  for (Eigen::Index i = 0; i < section.mean.size(); ++i)
    for (const double y : {section.mean[i] + section.maximum[i], section.mean[i] + section.minimum[i]}) {
      const double beside = std::abs(law.evaluate({.x = y / k}).y - y);
      if (std::isfinite(beside) && beside > kBent * std::abs(y) && beside > off) off = beside, at = y;
    }
  return at;
}

/// Laws without a gap that are not the straight line through zero that a linear sweep takes them for, at the torques found. Of
/// stiffness that follows a phase it takes the mean.
void note_bent_laws(const System& system, const LinearSweep& sweep, std::vector<std::string>& notes) {
  for (const ScalarTerm& term : system.scalars()) {
    const double k = term.force->closed_stiffness();
    if (term.force->gap() || term.phase_node >= 0 || !(k > 0.0)) continue;
    const std::string start =
        system.element_instances()[static_cast<std::size_t>(index(term.element))].name + ".";
    for (const SweepSection& section : sweep.sections) {
      const double at = section.name.starts_with(start) ? most_bent(*term.force, k, section) : 0.0;
      if (at == 0.0) continue;
      notes.push_back(section.name + ": taken as a straight line with the stiffness at zero deflection, " +
                      digits(k, kDigits) + " " + (section.unit == "N" ? "N/m" : "N m/rad") +
                      "; where that gives " + digits(at, 4) + " " + section.unit + ", the law gives " +
                      digits(term.force->evaluate({.x = at / k}).y, 4) +
                      ". 'drev sweep' without '--contact closed' follows it");
    }
  }
}

/// Speeds at which the vibration stated is one of several [rpm].
std::vector<double> several_amplitudes(const SweepRequest& request, const LinearSweep& sweep) {
  std::vector<double> speeds;
  for (std::size_t i = 0; i < sweep.several_amplitudes.size(); ++i)
    if (sweep.several_amplitudes[i] != 0) speeds.push_back(request.speeds_rpm[i]);
  return speeds;
}

}  // namespace

bool follows_mean_torque(const SweepRequest& request) {
  const auto& terms = request.model.system.frequency_terms();
  return std::any_of(terms.begin(), terms.end(),
                     [](const FrequencyTerm& term) { return term.stiffness->follows_mean_torque(); });
}

std::vector<std::string> left_over_notes(const SweepRequest& request, const LinearSweep& sweep) {
  std::vector<std::string> notes;
  for (std::size_t f = 0; f < sweep.floating_parts.size(); ++f) {
    LeftOver left{.of = sweep.unbalanced_scale[f]};
    for (std::size_t i = 0; i < request.speeds_rpm.size(); ++i)
      left.note(sweep.unbalanced[f][static_cast<Eigen::Index>(i)], request.speeds_rpm[i],
                kBalanced * left.of);
    if (left.count > 0)
      notes.push_back(left_over_sentence(
          left, sweep.floating_parts[f],
          std::string("Means are those of the train that this speeds up; --balance NODE takes it up at a "
                      "node. ") +
              (follows_mean_torque(request) ? "Couplings whose stiffness follows the mean torque have that "
                                              "under these means."
                                            : "Vibration does not depend on it."),
          request.options.balance));
  }
  return notes;
}

std::vector<std::string> sweep_notes(const SweepRequest& request, const LinearSweep& sweep) {
  std::vector<std::string> notes;
  if (sweep.growth.rate > 0.0)
    notes.push_back("The train is unstable: " + sweep.growth.text() +
                    (std::isnan(sweep.growth_speed)
                         ? ""
                         : ", fastest at about " + digits(to_rpm(sweep.growth_speed), 4) + " rpm") +
                    ". The steady vibration stated solves the equations, but no run settles on it.");
  for (std::string& note : left_over_notes(request, sweep)) notes.push_back(std::move(note));
  if (const std::vector<double> speeds = several_amplitudes(request, sweep); !speeds.empty())
    notes.push_back("At " + std::to_string(speeds.size()) + " of " + std::to_string(sweep.speeds.size()) +
                    " speeds, from " + digits(speeds.front(), kDigits) + " to " +
                    digits(speeds.back(), kDigits) +
                    " rpm, several amplitudes satisfy the tables of the elements that follow the amplitude: "
                    "the largest is stated. The train may jump to a smaller one.");
  if (std::isnan(sweep.cycle))
    notes.emplace_back(
        "The orders have no common cycle: maxima, minima and half ranges of their sum are not stated.");
  for (const LinearSweep::LeftOut& load : sweep.left_out)
    notes.push_back(load.load + ": " + digits(100.0 * load.share, 3) +
                    " % of what alternates in it (rms) is in none of the orders");
  if (const LinearSweep::LeftOut& most = sweep.most_left_out; most.share > 0.0)
    notes.push_back(
        (sweep.left_out.empty()
             ? "Up to " + digits(100.0 * most.share, 2) + " % of what alternates in a load (" + most.load +
                   ", rms) is in none of the orders. That is a part of a load"
             : "What is in none of the orders is stated as a part of the loads") +
        ": half ranges may be off by a larger part. A sweep with more '--orders' shows by how much.");
  for (std::size_t c = 0; c < sweep.sections.size() && request.options.close_contacts; ++c) {
    const SweepSection& section = sweep.sections[c];
    Eigen::Index count = 0;
    for (Eigen::Index i = 0; i < section.mean.size(); ++i) count += section.separates(i) ? 1 : 0;
    std::vector<std::string> between;
    for (const SweepPeak& peak : sweep.peaks)
      if (peak.section == static_cast<int>(c) && !peak.at_end &&
          section.separates(peak.mean, peak.maximum, peak.minimum))
        between.push_back(digits(to_rpm(peak.speed), kDigits));
    if (count > 0 || !between.empty())
      notes.push_back(section.name + ": changes its sign at " + std::to_string(count) + " of " +
                      std::to_string(section.mean.size()) + " speeds" +
                      (between.empty() ? "" : " and between them at " + join(between) + " rpm") +
                      ": the teeth separate there, and what is said of these speeds does not hold; "
                      "'drev sweep' without '--contact closed' follows them");
  }
  if (request.options.close_contacts) note_bent_laws(request.model.system, sweep, notes);
  return notes;
}

Json critical_object(const LinearSweep& sweep, const SweepCritical& c) {
  return {{"speed_rpm", number(to_rpm(c.speed))},
          {"order", number(c.order)},
          {"mode", c.mode + 1},
          {"frequency_Hz", number(c.frequency_Hz)},
          {"damping_ratio", number(c.damping_ratio)},
          {"section", name_of(sweep, c.section)},
          {"amplitude", number(c.amplitude)},
          {"own_amplitude", number(c.own_amplitude)},
          {"half_range", number(c.half_range)}};
}

std::string sweep_as_text(const SweepRequest& request, const LinearSweep& sweep) {
  const std::string& name = request.model.entry->name;
  std::string text = name + ": " + wrap(parameters_text(request.model.parameters), name.size() + 2);
  text += std::to_string(sweep.orders.size()) + " orders " + short_digits(sweep.orders.front(), kDigits) +
          " to " + short_digits(sweep.orders.back(), kDigits) + ", " + std::to_string(sweep.speeds.size()) +
          " speeds " + short_digits(request.speeds_rpm.front(), kDigits) + " to " +
          short_digits(request.speeds_rpm.back(), kDigits) + " rpm " +
          of_reference(request.model.model_case.model) +
          (request.options.close_contacts ? ", contacts closed" : "") + "\n\n";
  text += sections_text(request, sweep) + "\n" + criticals_text(sweep);
  const std::vector<std::string> notes = sweep_notes(request, sweep);
  if (!notes.empty()) text += "\n";
  for (const std::string& note : notes) text += wrap(note, 0);
  if (!request.model.model_case.note.empty()) text += "\n" + wrap(request.model.model_case.note, 0);
  return text;
}

Json sweep_object(const SweepRequest& request, const LinearSweep& sweep) {
  Json object = result_object("sweep");
  object["model"] = request.model.entry->name;
  object["parameters"] = parameters_object(request.model.parameters);
  object["contact"] = request.options.close_contacts ? Json("closed") : Json();
  Json sections = Json::array(), peaks = Json::array(), criticals = Json::array(), floating = Json::array(),
       left_out = Json::array();
  for (const SweepSection& section : sweep.sections) sections.push_back(section_object(request, section));
  for (const SweepPeak& peak : sweep.peaks)
    peaks.push_back({{"section", name_of(sweep, peak.section)},
                     {"speed_rpm", number(to_rpm(peak.speed))},
                     {"half_range", number(peak.half_range)},
                     {"maximum", number(peak.maximum)},
                     {"minimum", number(peak.minimum)},
                     {"mean", number(peak.mean)},
                     {"twist_half_range", number(peak.twist_half_range)},
                     {"heat_W", number(peak.heat)},
                     {"at_end", peak.at_end}});
  for (const SweepCritical& critical : sweep.criticals) criticals.push_back(critical_object(sweep, critical));
  for (std::size_t f = 0; f < sweep.floating_parts.size(); ++f)
    floating.push_back({{"node", sweep.floating_parts[f]},
                        {"left_over_Nm", numbers(sweep.unbalanced[f])},
                        {"mean_torques_Nm", number(sweep.unbalanced_scale[f])}});
  for (const LinearSweep::LeftOut& load : sweep.left_out)
    left_out.push_back({{"load", load.load}, {"share", number(load.share)}});
  object["reference_shaft"] = text_or_null(reference_node(request.model.model_case.model));
  object["speeds_rpm"] = request.speeds_rpm;
  object["orders"] = sweep.orders;
  object["cycle_deg"] = number(to_deg(sweep.cycle));
  object["sections"] = std::move(sections);
  object["peaks"] = std::move(peaks);
  object["criticals"] = std::move(criticals);
  object["criticals_note"] = text_or_null(sweep.modes_note);
  object["growing_mode"] = sweep.growth.rate > 0.0
                               ? Json({{"rate_per_s", number(sweep.growth.rate)},
                                       {"frequency_Hz", number(sweep.growth.frequency_Hz)},
                                       {"speed_rpm", number(to_rpm(sweep.growth_speed))}})
                               : Json();
  object["floating_parts"] = std::move(floating);
  object["balance"] = text_or_null(request.options.balance);
  object["input_power_W"] = numbers(sweep.input_power);
  object["dissipated_power_W"] = numbers(sweep.dissipated_power);
  object["left_out"] = std::move(left_out);
  object["most_left_out"] =
      sweep.most_left_out.share > 0.0
          ? Json({{"load", sweep.most_left_out.load}, {"share", number(sweep.most_left_out.share)}})
          : Json();
  object["several_amplitudes_rpm"] = several_amplitudes(request, sweep);
  object["note"] = text_or_null(request.model.model_case.note);
  return object;
}

std::string sweep_as_csv(const SweepRequest& request, const LinearSweep& sweep) {
  std::string text = "speed_rpm";
  for (const SweepSection& s : sweep.sections) {
    for (const char* what : {"half_range", "maximum", "minimum", "mean", "heat_W"})
      text += "," + csv_cell(s.name + " " + what);
    if (!s.twist_unit.empty()) text += "," + csv_cell(s.name + " twist_half_range_" + s.twist_unit);
    if (request.absolute_sum) text += "," + csv_cell(s.name + " absolute_sum");
  }
  text += "\n";
  for (std::size_t i = 0; i < sweep.speeds.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    text += to_text(request.speeds_rpm[i]);
    for (const SweepSection& s : sweep.sections) {
      for (const double value :
           {0.5 * (s.maximum[at] - s.minimum[at]), s.maximum[at], s.minimum[at], s.mean[at], s.heat[at]})
        text += "," + cell(value);
      if (!s.twist_unit.empty()) text += "," + cell(s.twist_half_range[at]);
      if (request.absolute_sum) text += "," + cell(s.amplitude.col(at).cwiseAbs().sum());
    }
    text += "\n";
  }
  return text;
}

std::string orders_as_csv(const SweepRequest& request, const LinearSweep& sweep) {
  std::string text = "speed_rpm,order";
  for (const SweepSection& s : sweep.sections)
    text += "," + csv_cell(s.name + " amplitude") + "," + csv_cell(s.name + " phase_deg");
  text += "\n";
  for (std::size_t i = 0; i < sweep.speeds.size(); ++i)
    for (std::size_t k = 0; k < sweep.orders.size(); ++k) {
      text += to_text(request.speeds_rpm[i]) + "," + to_text(sweep.orders[k]);
      for (const SweepSection& s : sweep.sections) {
        const std::complex<double> a =
            s.amplitude(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i));
        text += "," + cell(std::abs(a)) + "," + cell(to_deg(std::arg(a)));
      }
      text += "\n";
    }
  return text;
}

std::string criticals_as_csv(const LinearSweep& sweep) {
  std::string text =
      "speed_rpm,order,mode,frequency_Hz,damping_ratio,section,amplitude,own_amplitude,half_range\n";
  for (const SweepCritical& c : sweep.criticals)
    text += to_text(to_rpm(c.speed)) + "," + to_text(c.order) + "," + std::to_string(c.mode + 1) + "," +
            to_text(c.frequency_Hz) + "," + to_text(c.damping_ratio) + "," +
            csv_cell(name_of(sweep, c.section)) + "," + cell(c.amplitude) + "," + cell(c.own_amplitude) +
            "," + cell(c.half_range) + "\n";
  return text;
}

}  // namespace drev::app
