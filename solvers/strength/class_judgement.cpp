#include <drev/core/error.hpp>
#include <drev/core/units.hpp>
#include <drev/solvers/strength/class_judgement.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <optional>
#include <set>

#include "core/names/rounded_text.hpp"
#include "solvers/strength/exceeded_ranges.hpp"
#include "solvers/strength/iacs_m68.hpp"

namespace drev {

namespace {

/// Values at the speeds of the sweep, at the section's peaks and at the points beside the speeds, where they are known, by
/// ascending speed; the largest one of a speed.
std::vector<CurvePoint> curve_of(const LinearSweep& sweep, const LimitedCurve& limited) {
  std::vector<CurvePoint> all, curve;
  for (std::size_t i = 0; i < sweep.speeds.size(); ++i)
    all.push_back({sweep.speeds[i], limited.value(sweep, static_cast<Eigen::Index>(i))});
  const auto add = [&](double speed, double half_range, double mean) {
    if (const double value = limited.quantity(half_range, mean); !std::isnan(value))
      all.push_back({speed, value});
  };
  for (const SweepPeak& peak : sweep.peaks)
    if (peak.section == limited.section) add(peak.speed, peak.half_range, peak.mean);
  for (const SweepPoint& p : sweep.points)
    add(p.speed, p.half_range(limited.section), p.mean[limited.section]);
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.speed < b.speed; });
  for (const CurvePoint& p : all) {
    if (curve.empty() || curve.back().speed != p.speed)
      curve.push_back(p);
    else
      curve.back().value = std::fmax(curve.back().value, p.value);
  }
  return curve;
}

void take_lower(TorqueLimit& limit, double continuous, double transient, const char* rule) {
  if (!std::isnan(continuous) && !(limit.continuous <= continuous)) {
    limit.continuous = continuous;
    limit.rule = rule;
  }
  if (!std::isnan(transient) && !(limit.transient <= transient)) limit.transient = transient;
}

class Judge {
 public:
  Judge(const LinearSweep& sweep, const Strength& strength) : sweep_(sweep), strength_(strength) {}

  /// The half range of a torque over its limit.
  LimitedCurve torque_curve(int section, int number) const {
    const SectionStrength& data = strength_.sections[static_cast<std::size_t>(number)];
    LimitedCurve curve{
        section, number, [](double half_range, double) { return half_range; },
        [this, &data](const CurvePoint& p) { return p.value / limit(data, p.speed).continuous; }};
    curve.transient_ratio = [this, &data](const CurvePoint& p) {
      return p.value / limit(data, p.speed).transient;
    };
    curve.points = curve_of(sweep_, curve);
    return curve;
  }

  /// Highest speed for which IACS UR M68.5 has a limit, if sections are judged by it and the sweep goes beyond; else not a
  /// number.
  double rule_ends() const {
    double speed = iacs_m68::kHighestRatio * strength_.rated_speed;
    while (speed / strength_.rated_speed > iacs_m68::kHighestRatio) speed = std::nextafter(speed, 0.0);
    return sweep_.speeds.back() > speed ? speed : SectionStrength::kNone;
  }

  /// Adds the torque at the highest speed of the rule to the curve: solved, or interpolated.
  void add_rule_end(const SweepAt& sweep_at, std::vector<LimitedCurve>& curves) const {
    const double end = rule_ends();
    const auto ruled = [&](const LimitedCurve& curve) {
      return curve.strength >= 0 &&
             !std::isnan(strength_.sections[static_cast<std::size_t>(curve.strength)].tensile_strength);
    };
    std::optional<LinearSweep> there;
    for (LimitedCurve& curve : curves) {
      std::vector<CurvePoint>& points = curve.points;
      const auto above = std::upper_bound(points.begin(), points.end(), end,
                                          [](double speed, const CurvePoint& p) { return speed < p.speed; });
      if (!ruled(curve) || above == points.begin() || above == points.end() || (above - 1)->speed == end)
        continue;
      const CurvePoint &low = *(above - 1), &high = *above;
      double value = low.value + (end - low.speed) / (high.speed - low.speed) * (high.value - low.value);
      if (sweep_at) {
        if (!there) there = sweep_at({end});
        value = curve.value(*there, 0);
      }
      if (std::isfinite(value)) points.insert(above, {end, value});
    }
  }

  /// The half range of a contact's force over its mean.
  LimitedCurve chatter_curve(int section) const {
    LimitedCurve curve{section, -1,
                       [](double half_range, double mean) { return half_range / std::abs(mean); },
                       [](const CurvePoint& p) { return p.value; }};
    curve.points = curve_of(sweep_, curve);
    return curve;
  }

  SectionJudgement section(const LimitedCurve& curve) const {
    const SectionStrength& data = strength_.sections[static_cast<std::size_t>(curve.strength)];
    const SweepSection& s = sweep_.sections[static_cast<std::size_t>(curve.section)];
    SectionJudgement found;
    found.section = curve.section, found.strength = curve.strength;
    if (!std::isnan(data.diameter)) {
      found.modulus = polar_section_modulus(data.diameter, data.bore);
      found.stress = data.stress_concentration / found.modulus * s.half_range();
    }
    for (const double speed : sweep_.speeds) found.limits.push_back(limit(data, speed));
    for (const CurvePoint& p : curve.points) {
      const double used = curve.ratio(p);
      if (!(used > found.utilisation) && (std::isnan(used) || found.judged())) continue;
      found.utilisation = used, found.utilisation_speed = p.speed, found.rule = limit(data, p.speed).rule;
    }
    if (!std::isnan(data.tensile_strength)) {
      found.rule_ends = rule_ends();
      if (!std::isnan(found.rule_ends)) found.rule_beyond = limit(data, sweep_.speeds.back()).rule;
    }
    found.exceeded = curve.ranges;
    for (ExceededRange& range : found.exceeded) range.passing = passing(data, range, curve.points);
    add_barred(data, curve.section, found);
    const SweepLargest heat = largest_heat(sweep_, curve.section);
    found.heat = heat.value, found.heat_speed = heat.speed;
    found.permissible_heat = data.permissible_heat;
    for (Eigen::Index i = 0; i < s.heat.size(); ++i)
      if (std::isnan(s.heat[i])) found.heat_unknown.push_back(sweep_.speeds[static_cast<std::size_t>(i)]);
    return found;
  }

  void add_chatter(const LimitedCurve& curve, std::vector<ChatterRange>& chatter) const {
    const SweepSection& s = sweep_.sections[static_cast<std::size_t>(curve.section)];
    std::set<double> separated;
    const auto note = [&](double speed, double mean, double maximum, double minimum) {
      if (s.separates(mean, maximum, minimum)) separated.insert(speed);
    };
    for (std::size_t i = 0; i < sweep_.speeds.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      note(sweep_.speeds[i], s.mean[at], s.maximum[at], s.minimum[at]);
    }
    for (const SweepPeak& peak : sweep_.peaks)
      if (peak.section == curve.section) note(peak.speed, peak.mean, peak.maximum, peak.minimum);
    for (const SweepPoint& p : sweep_.points)
      note(p.speed, p.mean[curve.section], p.maximum[curve.section], p.minimum[curve.section]);
    for (const ExceededRange& range : curve.ranges)
      chatter.push_back({curve.section, range,
                         std::distance(separated.lower_bound(range.from), separated.upper_bound(range.to))});
  }

 private:
  TorqueLimit limit(const SectionStrength& data, double speed) const {
    return torque_limit(data, speed / strength_.rated_speed);
  }

  ExceededRange::Passing passing(const SectionStrength& data, const ExceededRange& range,
                                 const std::vector<CurvePoint>& curve) const {
    using Passing = ExceededRange::Passing;
    if (range.to / strength_.rated_speed >= iacs_m68::kNoBarredRange) return Passing::near_rated;
    bool given = true;
    for (const CurvePoint& p : curve) {
      if (p.speed < range.from || p.speed > range.to) continue;
      const double transient = limit(data, p.speed).transient;
      if (p.value > transient) return Passing::above_limit;
      given = given && !std::isnan(transient);
    }
    if (!given) return Passing::no_limit;
    return std::isnan(strength_.rated_speed) ? Passing::no_rated_speed : Passing::permitted;
  }

  void add_barred(const SectionStrength& data, int section, SectionJudgement& found) const {
    if (std::isnan(data.tensile_strength) || std::isnan(strength_.rated_speed)) return;
    for (std::size_t c = 0; c < sweep_.criticals.size(); ++c) {
      const SweepCritical& critical = sweep_.criticals[c];
      // Whether the critical speed is in a range in which this section's limit is exceeded.
      const double speed = critical.in_sections.empty()
                               ? critical.speed
                               : critical.in_sections[static_cast<std::size_t>(section)].speed;
      const bool inside =
          std::any_of(found.exceeded.begin(), found.exceeded.end(),
                      [speed](const auto& range) { return speed >= range.from && speed <= range.to; });
      if (!inside) continue;
      const double ratio = speed / strength_.rated_speed;
      const iacs_m68::BarredRange by_rule =
          ratio < iacs_m68::kNoBarredRange ? iacs_m68::barred_range(speed, ratio) : iacs_m68::BarredRange{};
      found.barred.push_back({static_cast<int>(c), speed, ratio, by_rule.from, by_rule.to});
    }
  }

  const LinearSweep& sweep_;
  const Strength& strength_;
};

}  // namespace

const char* to_text(ExceededRange::Passing passing) {
  switch (passing) {
    case ExceededRange::Passing::permitted:
      return "permitted";
    case ExceededRange::Passing::near_rated:
      return "near rated speed";
    case ExceededRange::Passing::above_limit:
      return "above transient limit";
    case ExceededRange::Passing::no_limit:
      return "no transient limit given";
    case ExceededRange::Passing::no_rated_speed:
      return "no rated speed given";
  }
  return "";
}

ClassJudgement::Verdict ClassJudgement::verdict() const {
  if (std::any_of(sections.begin(), sections.end(),
                  [](const auto& s) { return !s.exceeded.empty() || s.heat_exceeds(); }))
    return Verdict::exceeded;
  const bool undecided =
      unstable || !without_motion.empty() || std::any_of(sections.begin(), sections.end(), [](const auto& s) {
        return s.heat_undecided() || s.torque_undecided();
      });
  return undecided ? Verdict::undecided : Verdict::within;
}

TorqueLimit torque_limit(const SectionStrength& s, double speed_ratio) {
  TorqueLimit limit;
  const double modulus = polar_section_modulus(s.diameter, s.bore);
  if (!std::isnan(s.tensile_strength) && !std::isnan(s.shape_factor)) {
    const iacs_m68::Permissible stress =
        iacs_m68::permissible_stress(s.tensile_strength, s.shape_factor, s.diameter, speed_ratio);
    take_lower(limit, stress.continuous * modulus, stress.transient * modulus, "IACS UR M68.5");
  }
  const double per_stress = modulus / s.stress_concentration;
  take_lower(limit, s.permissible_stress * per_stress, s.transient_stress * per_stress, "permissible stress");
  take_lower(limit, s.permissible_torque, s.transient_torque, "permissible torque");
  return limit;
}

namespace {

constexpr int kTypedDigits = 12;  // of a number that was typed in another unit: 72 mm are 0.072 m

}  // namespace

std::vector<Finding> check_strength(const Strength& strength) {
  std::vector<Finding> findings;
  const double none = SectionStrength::kNone;
  for (const SectionStrength& s : strength.sections) {
    const std::string place = "class.sections." + s.element;
    const auto check = [&](const char* parameter, double value, double low, double high, const char* unit,
                           const char* range) {
      if (!std::isnan(value) && !(value >= low && value <= high))
        findings.push_back(
            {place, parameter, rounded_text(value, kTypedDigits), unit, std::string("must be ") + range});
    };
    constexpr double kLeast = 1e-300, kMost = 1e300;
    check("diameter", s.diameter, kLeast, kMost, "m", "> 0");
    // Beside a diameter that is wrong itself, the bore may be right.
    if (!(s.diameter <= 0.0))
      check("bore", s.bore, 0.0, std::isnan(s.diameter) ? 0.0 : std::nextafter(s.diameter, 0.0), "m",
            ">= 0 and < diameter");
    check("stress_concentration", s.stress_concentration, 1.0, kMost, "", ">= 1");
    check("tensile_strength", s.tensile_strength / 1e6, 400.0, 800.0, "MPa",
          "from 400 to 800 MPa (IACS UR M68.3)");
    check("shape_factor", s.shape_factor, kLeast, 1.0, "", "> 0 and <= 1");
    for (const auto& [name, value] :
         {std::pair{"permissible_stress", s.permissible_stress}, {"transient_stress", s.transient_stress}})
      check(name, value, kLeast, kMost, "Pa", "> 0");
    for (const auto& [name, value] :
         {std::pair{"permissible_torque", s.permissible_torque}, {"transient_torque", s.transient_torque}})
      check(name, value, kLeast, kMost, "N m", "> 0");
    const auto ordered = [&](const char* parameter, double transient, double continuous, const char* unit) {
      if (transient < continuous)
        findings.push_back({place, parameter, rounded_text(transient, kTypedDigits), unit,
                            "is below what is permitted in continuous running, " +
                                rounded_text(continuous, kTypedDigits) + " " + unit});
    };
    ordered("transient_stress", s.transient_stress, s.permissible_stress, "Pa");
    ordered("transient_torque", s.transient_torque, s.permissible_torque, "N m");
    check("permissible_heat", s.permissible_heat, kLeast, kMost, "W", "> 0");
    check("sn_range", s.sn.reference, kLeast, kMost, "Pa", "> 0");
    check("sn_cycles", s.sn.cycles, kLeast, kMost, "", "> 0");
    check("sn_slope", s.sn.slope, 1.0, 100.0, "", "from 1 to 100");
    const bool rule = !std::isnan(s.tensile_strength) || !std::isnan(s.shape_factor);
    if (rule && (std::isnan(s.tensile_strength) || std::isnan(s.shape_factor)))
      findings.push_back(
          {place, "tensile_strength", "", "Pa", "IACS UR M68 needs it together with shape_factor"});
    if (rule && std::isnan(strength.rated_speed))
      findings.push_back({"class", "rated_speed", "", "rpm", "is missing: IACS UR M68 needs it"});
    const bool by_stress =
        rule || !std::isnan(s.permissible_stress) || !std::isnan(s.transient_stress) || s.sn.given();
    if (by_stress && std::isnan(s.diameter))
      findings.push_back({place, "diameter", "", "m", "is missing: stresses need it"});
  }
  const double rated = std::isnan(strength.rated_speed) ? 1.0 : strength.rated_speed;
  if (!(rated > 0.0) || rated == none)
    findings.push_back({"class", "rated_speed", to_text(to_rpm(rated)), "rpm", "must be > 0"});
  return findings;
}

SweepAt sweep_between(const System& system, LinearSweepOptions options) {
  options.refine = false;
  return [&system, options](const std::vector<double>& speeds) mutable {
    options.speeds = speeds;
    return sweep_linear(system, options);
  };
}

ClassJudgement judge_sweep(const LinearSweep& sweep, const Strength& strength, const SweepAt& sweep_at) {
  std::vector<Finding> findings = check_strength(strength);
  const bool sound = findings.empty();
  const Judge judge(sweep, strength);
  std::vector<bool> used(strength.sections.size(), false);
  std::vector<LimitedCurve> curves;
  for (std::size_t c = 0; c < sweep.sections.size(); ++c) {
    const SweepSection& s = sweep.sections[c];
    for (std::size_t k = 0; k < strength.sections.size(); ++k) {
      if (s.unit != "N m" || s.name != strength.sections[k].element + ".torque_Nm") continue;
      used[k] = true;
      if (!sound) continue;
      curves.push_back(judge.torque_curve(static_cast<int>(c), static_cast<int>(k)));
    }
    if (s.contact) curves.push_back(judge.chatter_curve(static_cast<int>(c)));
  }
  for (std::size_t k = 0; k < used.size(); ++k)
    if (!used[k])
      findings.push_back({"class.sections", "section", strength.sections[k].element, "",
                          "is the name of no section of the sweep that carries a torque"});
  if (!findings.empty()) throw ModelError(std::move(findings));
  judge.add_rule_end(sweep_at, curves);
  if (sweep_at) add_tops(curves, sweep_at);
  find_exceeded_ranges(curves, sweep_at);
  ClassJudgement found;
  found.unstable = sweep.growth.rate > 0.0;
  std::vector<bool> judged(sweep.sections.size(), false);
  for (const LimitedCurve& curve : curves) {
    if (curve.strength < 0) {
      judge.add_chatter(curve, found.chatter);
      continue;
    }
    const SectionJudgement& section = found.sections.emplace_back(judge.section(curve));
    if (section.judged() || section.heat_limited()) judged[static_cast<std::size_t>(section.section)] = true;
  }
  for (std::size_t c = 0; c < judged.size(); ++c)
    if (!judged[c]) found.not_judged.push_back(sweep.sections[c].name);
  return found;
}

}  // namespace drev
