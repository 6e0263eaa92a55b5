#include "app/results/class_result.hpp"

#include <drev/core/units.hpp>

#include <algorithm>
#include <cmath>

#include "app/base/parameter_text.hpp"
#include "app/base/text_layout.hpp"
#include "app/results/run_json.hpp"
#include "app/run/excitation.hpp"

namespace drev::app {

namespace {

constexpr int kShown = 6;
constexpr double kMega = 1e6;

Json class_numbers(const Vector& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(number(value));
  return list;
}

std::string rpm_range(double from, double to) {
  return digits(to_rpm(from), 5) + " to " + digits(to_rpm(to), 5) + " rpm";
}

/// Where an end is known no better than between two speeds of the sweep: the speeds outside.
std::string kept_text(const ExceededRange& range) {
  constexpr double kShownPart = 1e-5;
  std::vector<std::string> kept;
  if (range.from - range.kept_below > kShownPart * range.from)
    kept.push_back(digits(to_rpm(range.kept_below), 5));
  if (range.kept_above - range.to > kShownPart * range.to)
    kept.push_back(digits(to_rpm(range.kept_above), 5));
  return kept.empty() ? "" : " (interpolated; no longer exceeded at " + join(kept) + " rpm)";
}

/// What may be done in a range in which the limit for continuous running is exceeded.
std::string passing_text(ExceededRange::Passing passing) {
  switch (passing) {
    case ExceededRange::Passing::permitted:
      return "may be barred and passed quickly";
    case ExceededRange::Passing::near_rated:
      return "must not be passed: it reaches 0.8 of the rated speed, no barred range";
    case ExceededRange::Passing::above_limit:
      return "must not be passed: it exceeds the limit for passing, no barred range";
    case ExceededRange::Passing::no_limit:
      return "whether it may be passed is not judged: no limit for passing is given";
    case ExceededRange::Passing::no_rated_speed:
      return "whether it may be passed is not judged: no rated speed is given";
  }
  return "";
}

std::string percent(double part, int significant) {
  return std::isfinite(part) ? digits(100.0 * part, significant) + " %" : "unbounded";
}

std::string bounded(double value, int significant) {
  return std::isinf(value) ? "unbounded" : digits(value, significant);
}

std::string exceeded_text(const ExceededRange& range) {
  return rpm_range(range.from, range.to) + kept_text(range) +
         (range.open_from || range.open_to ? " (and perhaps beyond)" : "") + ", " + percent(range.worst, 4) +
         " at " + digits(to_rpm(range.worst_speed), 5) + " rpm; " + passing_text(range.passing);
}

Json range_object(const ExceededRange& range) {
  return {{"from_rpm", number(to_rpm(range.from))},
          {"to_rpm", number(to_rpm(range.to))},
          {"kept_below_rpm", number(to_rpm(range.kept_below))},
          {"kept_above_rpm", number(to_rpm(range.kept_above))},
          {"open_from", range.open_from},
          {"open_to", range.open_to},
          {"worst", number(range.worst)},
          {"worst_rpm", number(to_rpm(range.worst_speed))},
          {"may_be_passed", range.may_be_passed()},
          {"passing", to_text(range.passing)}};
}

Json barred_object(const LinearSweep& sweep, const RuleBarredRange& barred) {
  const SweepCritical& critical = sweep.criticals[static_cast<std::size_t>(barred.critical)];
  const bool permitted = barred.to > 0.0;
  return {{"critical_rpm", number(to_rpm(barred.speed))},
          {"order", number(critical.order)},
          {"mode", critical.mode + 1},
          {"speed_ratio", number(barred.speed_ratio)},
          {"from_rpm", permitted ? number(to_rpm(barred.from)) : Json()},
          {"to_rpm", permitted ? number(to_rpm(barred.to)) : Json()}};
}

const SectionStrength& strength_of(const ClassCase& c, const SectionJudgement& judged) {
  return c.request.model.model_case.strength->sections[static_cast<std::size_t>(judged.strength)];
}

/// Half range [N m], stresses [Pa] and limit [N m] where the utilisation is largest, also between the speeds; of a section
/// that is not judged the largest half range, without a limit. Not a number: not known.
struct WorstVibration {
  double half_range, local_stress, nominal_stress, permissible;
};

/// The stress that the section's rule limits: M68 the nominal one.
bool by_nominal_stress(const SectionJudgement& judged) { return judged.rule == "IACS UR M68.5"; }

WorstVibration worst_vibration(const ClassCase& c, const SectionJudgement& judged) {
  const SectionStrength& data = strength_of(c, judged);
  WorstVibration worst{
      .half_range = 0.0, .local_stress = 0.0, .nominal_stress = 0.0, .permissible = std::nan("")};
  if (judged.judged()) {
    const double rated = c.request.model.model_case.strength->rated_speed;
    worst.permissible = torque_limit(data, judged.utilisation_speed / rated).continuous;
    worst.half_range = judged.utilisation * worst.permissible;
  } else {
    worst.half_range = largest_half_range(c.sweep, judged.section).value;
  }
  worst.nominal_stress = worst.half_range / judged.modulus;
  worst.local_stress = data.stress_concentration * worst.nominal_stress;
  return worst;
}

Json speeds_rpm(const std::vector<double>& speeds) {
  Json list = Json::array();
  for (const double speed : speeds) list.push_back(number(to_rpm(speed)));
  return list;
}

/// Null: not decided, or neither heat nor a limit of it is known.
Json heat_exceeds(const SectionJudgement& judged) {
  if (judged.heat_undecided() || std::isnan(judged.heat)) return {};
  return judged.heat_exceeds();
}

/// "at all 2 speeds", "at 3 of 21 speeds, from 1400 to 1500 rpm".
std::string part_of_speeds(const std::vector<double>& part, std::size_t all) {
  if (part.size() == all) return all > 1 ? "at all " + std::to_string(all) + " speeds" : "at the only speed";
  return "at " + std::to_string(part.size()) + " of " + std::to_string(all) + " speeds, " +
         (part.size() > 1 ? "from " + short_digits(to_rpm(part.front()), 5) + " to " : "") +
         short_digits(to_rpm(part.back()), 5) + " rpm";
}

/// Limits that are given but could not be judged: sentences with part, quantity, speeds and reason.
std::vector<std::string> undecided_texts(const ClassCase& c) {
  std::vector<std::string> texts;
  if (c.judgement.unstable)
    texts.push_back("No limit is known to be kept: the train is unstable (" + c.sweep.growth.text() +
                    "), and no run settles on the vibration that is judged.");
  const std::vector<double>& without = c.judgement.without_motion;
  const std::size_t answered = c.sweep.speeds.size();
  if (!without.empty())
    texts.push_back("No limit is judged " + part_of_speeds(without, answered + without.size()) +
                    ": no motion was found there.");
  for (const SectionJudgement& j : c.judgement.sections) {
    const std::string& name = c.sweep.sections[static_cast<std::size_t>(j.section)].name;
    if (j.torque_undecided())
      texts.push_back(name + ": torque not judged at any of the speeds: IACS UR M68.5 has no limit above " +
                      short_digits(to_rpm(j.rule_ends), 5) + " rpm, 1.05 of the rated speed.");
    if (j.heat_undecided())
      texts.push_back(name + ": permissible heat of " + digits(j.permissible_heat, 4) + " W not judged " +
                      part_of_speeds(j.heat_unknown, answered) +
                      ": no periodic motion that was found is stable there, and a run in time does not give "
                      "the heat.");
  }
  return texts;
}

Json accepted_value(const ClassJudgement& judgement) {
  const ClassJudgement::Verdict verdict = judgement.verdict();
  return verdict == ClassJudgement::Verdict::undecided ? Json()
                                                       : Json(verdict == ClassJudgement::Verdict::within);
}

const char* verdict_text(const ClassJudgement& judgement) {
  switch (judgement.verdict()) {
    case ClassJudgement::Verdict::within:
      return "within all limits that are given";
    case ClassJudgement::Verdict::exceeded:
      return "LIMITS EXCEEDED";
    case ClassJudgement::Verdict::undecided:
      return "NOT DECIDED: limits that are given could not be judged";
  }
  return "";
}

Json judged_object(const ClassCase& c, const SectionJudgement& judged) {
  const SectionStrength& data = strength_of(c, judged);
  const WorstVibration worst = worst_vibration(c, judged);
  const SweepSection& section = c.sweep.sections[static_cast<std::size_t>(judged.section)];
  Json permissible = Json::array(), transient = Json::array(), exceeded = Json::array(),
       barred = Json::array();
  for (const TorqueLimit& limit : judged.limits) {
    permissible.push_back(number(limit.continuous));
    transient.push_back(number(limit.transient));
  }
  for (const ExceededRange& range : judged.exceeded) exceeded.push_back(range_object(range));
  for (const RuleBarredRange& range : judged.barred) barred.push_back(barred_object(c.sweep, range));
  return {{"section", section.name},
          {"diameter_m", number(data.diameter)},
          {"bore_m", number(data.bore)},
          {"modulus_m3", number(judged.modulus)},
          {"stress_concentration", number(data.stress_concentration)},
          {"half_range_Nm", class_numbers(section.half_range())},
          {"stress_Pa", judged.stress.size() > 0 ? class_numbers(judged.stress) : Json()},
          {"permissible_Nm", std::move(permissible)},
          {"transient_Nm", std::move(transient)},
          {"utilisation", judged.judged() ? number(judged.utilisation) : Json()},
          {"utilisation_at_rpm", judged.judged() ? number(to_rpm(judged.utilisation_speed)) : Json()},
          {"worst_half_range_Nm", number(worst.half_range)},
          {"worst_stress_Pa", number(worst.local_stress)},
          {"worst_nominal_stress_Pa", number(worst.nominal_stress)},
          {"worst_permissible_Nm", number(worst.permissible)},
          {"rule", text_or_null(judged.rule)},
          {"rule_ends_rpm", number(to_rpm(judged.rule_ends))},
          {"rule_beyond", text_or_null(judged.rule_beyond)},
          {"stress_of_rule", by_nominal_stress(judged) ? "nominal" : "local"},
          {"unbounded", std::isinf(worst.half_range)},
          {"exceeded", std::move(exceeded)},
          {"barred_by_rule", std::move(barred)},
          {"heat_W", number(judged.heat)},
          {"heat_at_rpm", number(to_rpm(judged.heat_speed))},
          {"heat_exceeds", heat_exceeds(judged)},
          {"heat_unknown_rpm", speeds_rpm(judged.heat_unknown)},
          {"permissible_heat_W", number(data.permissible_heat)}};
}

Json case_object(const ClassCase& c) {
  Json sections = Json::array(), chatter = Json::array();
  for (const SectionJudgement& judged : c.judgement.sections) sections.push_back(judged_object(c, judged));
  for (const ChatterRange& range : c.judgement.chatter) {
    Json object = range_object(range.range);
    object.erase("may_be_passed");
    object.erase("passing");
    object["section"] = c.sweep.sections[static_cast<std::size_t>(range.section)].name;
    object["separated_speeds"] = range.separated;
    chatter.push_back(std::move(object));
  }
  return {{"name", c.name},
          {"parameters", parameters_object(c.request.model.parameters)},
          {"sections", std::move(sections)},
          {"chatter", std::move(chatter)},
          {"accepted", accepted_value(c.judgement)},
          {"undecided", undecided_texts(c)},
          {"not_judged", c.judgement.not_judged},
          {"notes", c.notes}};
}

/// Whether contacts are treated as closed, or there are none.
bool linear_contacts(const SweepRequest& request) {
  return request.options.close_contacts || request.model.system.scalars().empty();
}

std::string case_text(const ClassCase& c) {
  std::vector<std::vector<std::string>> rows{
      {"section", "half range", "stress [MPa]", "permissible", "used", "at [rpm]", "heat [W]", "by"}};
  std::string ranges;
  for (const SectionJudgement& j : c.judgement.sections) {
    const SectionStrength& data = strength_of(c, j);
    const SweepSection& s = c.sweep.sections[static_cast<std::size_t>(j.section)];
    const WorstVibration worst = worst_vibration(c, j);
    const double stress = by_nominal_stress(j) ? worst.nominal_stress : worst.local_stress;
    const std::string by_torque = j.rule.empty() ? "torque not judged" : j.rule;
    rows.push_back(
        {s.name, bounded(worst.half_range, kShown),
         std::isnan(stress) ? ""
                            : bounded(stress / kMega, 4) + (by_nominal_stress(j) ? " nominal" : " local"),
         j.judged() ? digits(worst.permissible, kShown) : "", j.judged() ? percent(j.utilisation, 3) : "",
         j.judged() ? digits(to_rpm(j.utilisation_speed), 5) : "",
         (std::isnan(j.heat) ? "-" : digits(j.heat, 4)) +
             (std::isnan(data.permissible_heat) ? "" : " of " + digits(data.permissible_heat, 4)),
         by_torque + (j.heat_judged()      ? ", permissible heat"
                      : j.heat_undecided() ? ", heat not judged"
                                           : "")});
    for (const ExceededRange& range : j.exceeded)
      ranges += wrap(s.name + ": exceeded from " + exceeded_text(range), 2);
    for (const RuleBarredRange& b : j.barred) {
      const SweepCritical& critical = c.sweep.criticals[static_cast<std::size_t>(b.critical)];
      ranges += wrap(s.name + ": critical at " + digits(to_rpm(b.speed), 5) + " rpm (order " +
                         short_digits(critical.order, 4) + ", mode " + std::to_string(critical.mode + 1) +
                         "), speed ratio " + digits(b.speed_ratio, 3) +
                         (b.to > 0.0 ? ": barred by IACS UR M68.5 from " + rpm_range(b.from, b.to)
                                     : ": IACS UR M68.5 permits no barred range from a ratio of 0.8 on"),
                     2);
    }
    if (!std::isnan(j.rule_ends))
      ranges += wrap(
          s.name + ": IACS UR M68.5 has no limit above " + digits(to_rpm(j.rule_ends), 5) +
              " rpm, 1.05 of the rated speed; from there to " + digits(to_rpm(c.sweep.speeds.back()), 5) +
              " rpm " +
              (j.rule_beyond.empty() ? "the torque is not judged" : "the " + j.rule_beyond + " alone holds"),
          2);
    if (j.heat_exceeds())
      ranges += wrap(
          s.name + ": heat exceeds what is permitted, at " + digits(to_rpm(j.heat_speed), 5) + " rpm", 2);
  }
  for (const ChatterRange& range : c.judgement.chatter)
    ranges += wrap(
        c.sweep.sections[static_cast<std::size_t>(range.section)].name +
            ": vibratory force exceeds the mean from " + rpm_range(range.range.from, range.range.to) +
            kept_text(range.range) + ", up to " + bounded(range.range.worst, 3) + " times at " +
            digits(to_rpm(range.range.worst_speed), 5) + " rpm: the gears hammer" +
            (c.request.options.close_contacts
                 ? "; without '--contact closed' the teeth are followed"
                 : "; they separate at " + std::to_string(range.separated) + " of the computed speeds in it"),
        2);
  std::string text = columns_text(rows);
  if (!ranges.empty()) text += "\n" + ranges;
  for (const std::string& note : c.notes) text += "\n" + wrap(note, 0);
  if (!c.judgement.not_judged.empty())
    text += "\n" + wrap("Without a limit, not judged: " + join(c.judgement.not_judged) + ".", 0);
  return text;
}

}  // namespace

std::vector<std::string> class_rules(const Strength& strength) {
  std::vector<std::string> rules{
      "Vibratory torque: (maximum - minimum)/2 of the synthesis of all orders with their phases over the "
      "cycle. "
      "Nominal stress: torque over the polar section modulus pi (d^4 - b^4)/(16 d)."};
  const auto any = [&](auto has) {
    return std::any_of(strength.sections.begin(), strength.sections.end(), has);
  };
  if (any([](const auto& s) { return !std::isnan(s.tensile_strength); }))
    rules.push_back(
        "IACS UR M68 (Rev.2 April 2015, Rev.3 February 2021), clause M68.5: nominal stress in continuous "
        "running "
        "tau_C = (sigma_B + 160)/18 C_K C_D (3 - 2 lambda^2) for lambda < 0.9, (sigma_B + 160)/18 C_K C_D "
        "1.38 for "
        "0.9 <= lambda <= 1.05; while a barred range is passed tau_T = 1.7 tau_C / sqrt(C_K); C_D = 0.35 + "
        "0.93 "
        "d^-0.2; N/mm2, mm. Barred range 16 n_c/(18 - lambda) to (18 - lambda) n_c/16, none from lambda = "
        "0.8 on. Above lambda = 1.05 the rule has no value: limits by number hold there, or none.");
  if (any([](const auto& s) { return !std::isnan(s.permissible_stress); }))
    rules.push_back("Permissible stress by number: local stress, stress concentration times nominal stress.");
  if (any([](const auto& s) { return !std::isnan(s.permissible_torque); }))
    rules.push_back("Permissible vibratory torque by number, as makers of couplings give it.");
  if (!strength.misfire.empty())
    rules.push_back("Misfire: the same calculation with the model's parameters of [class] misfire.");
  return rules;
}

std::vector<std::string> class_limits(bool closed) {
  return {
      "Tensile strengths are taken as given: which may enter by shaft and material (M68.3) is not judged.",
      "IACS UR M68 is not for crankshafts (UR M53), gearing shafts, shafts of generators, motors and "
      "turbines, "
      "nor for ice (M68.1): a section is judged by it only where shape_factor and tensile_strength are "
      "given.",
      "Not judged: minimum diameters (M68.4), crankshaft fatigue (M53), bending and axial vibration, shock, "
      "slots and keyways beyond C_K, how fast a barred range is passed.",
      closed ? "Chatter is vibratory over mean force of a contact taken as closed; how far teeth separate is "
               "not in it."
             : "Barred ranges by rule about criticals are not given where contacts open: no order meets a "
               "natural frequency there."};
}

std::string class_as_text(const std::vector<ClassCase>& cases) {
  const SweepRequest& request = cases.front().request;
  const std::string& name = request.model.entry->name;
  const double rated = request.model.model_case.strength->rated_speed;
  std::string text = name + ": " + wrap(parameters_text(request.model.parameters), name.size() + 2);
  text += std::to_string(request.speeds_rpm.size()) + " speeds " +
          short_digits(request.speeds_rpm.front(), kShown) + " to " +
          short_digits(request.speeds_rpm.back(), kShown) + " rpm " +
          of_reference(request.model.model_case.model) +
          (std::isnan(rated) ? "" : ", rated speed " + short_digits(to_rpm(rated), kShown) + " rpm") + "\n";
  for (const ClassCase& c : cases) {
    text += "\n" + std::string(c.name == "normal" ? "Normal firing" : "Misfire") + ": " +
            verdict_text(c.judgement) + "\n";
    for (const std::string& undecided : undecided_texts(c)) text += wrap("- " + undecided, 2);
    text += case_text(c);
  }
  text += "\n";
  for (const std::string& rule : class_rules(*request.model.model_case.strength))
    text += wrap("- " + rule, 2);
  for (const std::string& limit : class_limits(linear_contacts(request))) text += wrap("- " + limit, 2);
  if (!request.model.model_case.note.empty()) text += "\n" + wrap(request.model.model_case.note, 0);
  return text;
}

Json class_object(const std::vector<ClassCase>& cases, const Json& mass_elastic) {
  const SweepRequest& request = cases.front().request;
  const Strength& strength = *request.model.model_case.strength;
  Json object = result_object("class");
  object["model"] = request.model.entry->name;
  object["contact"] = request.options.close_contacts ? Json("closed") : Json();
  object["rated_rpm"] = number(to_rpm(strength.rated_speed));
  object["reference_shaft"] = text_or_null(reference_node(request.model.model_case.model));
  object["speeds_rpm"] = request.speeds_rpm;
  object["cases"] = Json::array();
  for (const ClassCase& c : cases) object["cases"].push_back(case_object(c));
  object["rules"] = class_rules(strength);
  object["not_covered"] = class_limits(linear_contacts(request));
  Json nodes = Json::array(), joints = Json::array();
  for (const Json& node : mass_elastic.at("nodes"))
    nodes.push_back(
        {{"name", node.at("name")}, {"ratio", node.at("ratio")}, {"inertia", node.at("inertia")}});
  for (const Json& joint : mass_elastic.at("joints")) {
    Json between = Json::array();
    for (const Json& node : joint.at("nodes"))
      between.push_back(mass_elastic.at("nodes")[node.get<std::size_t>()].at("name"));
    joints.push_back({{"name", joint.at("name")},
                      {"kind", joint.at("kind")},
                      {"nodes", std::move(between)},
                      {"stiffness", joint.value("stiffness", Json())},
                      {"damping", joint.value("damping", Json())}});
  }
  object["mass_elastic"] = {{"nodes", std::move(nodes)}, {"joints", std::move(joints)}};
  object["note"] = text_or_null(request.model.model_case.note);
  return object;
}

}  // namespace drev::app
