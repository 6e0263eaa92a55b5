#include "app/results/branches_result.hpp"

#include <drev/core/units.hpp>

#include <algorithm>
#include <cmath>
#include <map>

#include "app/base/csv_cell.hpp"
#include "app/base/parameter_text.hpp"
#include "app/base/text_layout.hpp"
#include "app/results/branches_largest.hpp"
#include "app/results/coupling_notes.hpp"
#include "app/results/run_json.hpp"
#include "app/results/sweep_result.hpp"
#include "app/run/excitation.hpp"

namespace drev::app {

namespace {

constexpr int kFigureDigits = 6;
constexpr int kCurveDigits = 4;  // digits of a speed that a step along the curve gives
constexpr int kErrorDigits = 2;
constexpr double kNoWidth = 1e-6;   // width of a stable stretch relative to its speed that is rounding [-]
constexpr double kLeftOver = 1e-9;  // unbalanced mean torque above which it is reported [N m]

std::string rpm_text(double speed) { return short_digits(to_rpm(speed), 8); }

std::string state_of(const SweptMotion& motion) {
  return !motion.judged ? "" : motion.stable ? "stable" : "unstable";
}

/// The speed at which stability changes between two consecutive motions of a branch: that of the located
/// change next to the stable one; without a located change, that of the stable motion.
double edge_of_stability(const NonlinearSweep& sweep, int branch, double stable, double unstable) {
  double edge = stable, nearest = std::abs(unstable - stable);
  for (const SweptChange& change : sweep.changes) {
    if (change.branch != branch || change.kind == BranchChange::contact) continue;
    const double distance = std::abs(change.speed - stable);
    if ((change.speed - stable) * (change.speed - unstable) > 0.0 || distance > nearest) continue;
    edge = change.speed, nearest = distance;
  }
  return edge;
}

/// "810 to 1150", with as many digits as tell the ends apart; one speed where they are the same.
std::string stretch_text(double first, double last) {
  if (std::abs(last - first) <= kNoWidth * first) return rpm_text(first);
  int digits = kCurveDigits;
  while (short_digits(to_rpm(first), digits) == short_digits(to_rpm(last), digits)) ++digits;
  return short_digits(to_rpm(first), digits) + " to " + short_digits(to_rpm(last), digits);
}

/// The speed ranges of the stable stretches of a branch, in the order of its arc: "810 to 1150 rpm".
std::string stable_text(const NonlinearSweep& sweep, std::size_t number) {
  const SweptBranch& branch = sweep.branches[number];
  const auto speed = [&](std::size_t motion) { return branch.motions[motion].speed; };
  const auto b = static_cast<int>(number);
  std::vector<std::string> stretches;
  for (std::size_t i = 0; i < branch.motions.size();) {
    std::size_t end = i;
    while (end < branch.motions.size() && branch.motions[end].stable) ++end;
    if (end > i) {
      const double first = i > 0 ? edge_of_stability(sweep, b, speed(i), speed(i - 1)) : speed(i);
      const double last = end < branch.motions.size()
                              ? edge_of_stability(sweep, b, speed(end - 1), speed(end))
                              : speed(end - 1);
      const bool asked = std::any_of(branch.motions.begin() + static_cast<std::ptrdiff_t>(i),
                                     branch.motions.begin() + static_cast<std::ptrdiff_t>(end),
                                     [](const SweptMotion& motion) { return motion.asked; });
      if (asked || std::abs(last - first) > kNoWidth * first) stretches.push_back(stretch_text(first, last));
    }
    i = std::max(end, i + 1);
  }
  if (!branch.motions.empty() && !branch.motions.front().judged) return "not judged";
  return stretches.empty() ? "nowhere" : join(stretches);
}

std::string branches_table(const NonlinearSweep& sweep) {
  std::vector<std::vector<std::string>> rows{{"curve", "turns a cycle", "stable [rpm], along it"}};
  for (std::size_t b = 0; b < sweep.branches.size(); ++b)
    rows.push_back(
        {std::to_string(b + 1), short_digits(sweep.branches[b].turns, kFigureDigits), stable_text(sweep, b)});
  return columns_text(rows);
}

/// Where a curve was left between the speeds, with the multiplier there: near 1, it grows beyond all bounds.
std::string left_text(const SweptBranch& branch, const NonlinearSweepOptions& options) {
  std::string text;
  for (const SweptMotion* motion : {&branch.motions.front(), &branch.motions.back()}) {
    if (motion->speed <= options.speeds.front() || motion->speed >= options.speeds.back()) continue;
    text += std::string(text.empty() ? ": it was left at " : " and at ") + digits(to_rpm(motion->speed), 9) +
            " rpm" +
            (motion->judged ? ", where its largest multiplier is " + digits(motion->multiplier, kFigureDigits)
                            : "");
  }
  return text;
}

std::string changes_table(const NonlinearSweep& sweep) {
  if (sweep.changes.empty())
    return std::all_of(sweep.branches.begin(), sweep.branches.end(),
                       [](const SweptBranch& b) { return b.whole; })
               ? "The curves neither fold nor lose their stability.\n"
               : "No fold and no loss of stability was located, as far as the curves could be followed.\n";
  std::vector<std::vector<std::string>> rows{
      {"at [rpm]", "within [rpm]", "curve", "what", "half range", "jumps to"}};
  for (const SweptChange& change : sweep.changes)
    rows.push_back(
        {digits(to_rpm(change.speed), 9),
         std::isfinite(change.error) ? digits(to_rpm(change.error), kErrorDigits) : "unknown",
         std::to_string(change.branch + 1), to_text(change.kind),
         change.motion.maximum.size() > 0 ? digits(change.motion.half_range()[0], kFigureDigits) : "",
         change.jumps_to.size() > 0 ? digits(change.jumps_to[0], kFigureDigits) : ""});
  return columns_text(rows) + wrap("Half ranges are of " + sweep.sections.front().name + ".", 0);
}

std::string runs_table(const NonlinearSweep& sweep) {
  if (sweep.runs.empty()) return {};
  std::string text;
  std::vector<std::vector<std::string>> rows{
      {"run at [rpm]", "cycles", "repeats after", "section", "mean", "+-", "deviation", "lowest", "highest"}};
  for (const SweptRun& run : sweep.runs) {
    if (!run.reason.empty()) {
      text += wrap("No statistics at " + rpm_text(run.speed) + " rpm: " + run.reason + ".", 0);
      continue;
    }
    for (std::size_t c = 0; c < sweep.sections.size(); ++c) {
      const auto at = static_cast<Eigen::Index>(c);
      rows.push_back({rpm_text(run.speed), std::to_string(run.cycles),
                      run.repeats > 0 ? std::to_string(run.repeats) : "-", sweep.sections[c].name,
                      digits(run.mean[at], kFigureDigits), digits(run.mean_error[at], 2),
                      digits(run.deviation[at], kFigureDigits), digits(run.lowest[at], kFigureDigits),
                      digits(run.highest[at], kFigureDigits)});
    }
  }
  if (rows.size() > 1)
    text += std::string(sweep.excess.found
                            ? "No curve of motions is followed (see below); what a run does:\n"
                            : "Harmonic balance found no stable motion at these speeds; what a run does:\n") +
            columns_text(rows);
  return text;
}

/// The largest unbalanced mean torque of all motions, and the number of given speeds at which there is any,
/// counted by the largest of the motions at a speed.
LeftOver left_over_of(const NonlinearSweep& sweep, std::size_t part) {
  LeftOver left;
  std::map<double, double> asked;
  const auto note = [&](const Vector& over, double speed, bool is_asked) {
    if (over.size() <= static_cast<Eigen::Index>(part)) return;
    const double value = std::abs(over[static_cast<Eigen::Index>(part)]);
    if (value > left.most) {
      left.most = value;
      left.at_rpm = to_rpm(speed);
    }
    if (is_asked) asked[to_rpm(speed)] = std::max(asked[to_rpm(speed)], value);
  };
  for (const SweptBranch& branch : sweep.branches)
    for (const SweptMotion& motion : branch.motions) note(motion.left_over, motion.speed, motion.asked);
  for (const SweptRun& run : sweep.runs) note(run.left_over, run.speed, true);
  for (const auto& [rpm, value] : asked) left.note(value, rpm, kLeftOver);
  return left;
}

std::string notes_text(const System& system, const NonlinearSweepOptions& options,
                       const NonlinearSweep& sweep) {
  std::string text;
  for (const std::string& note : branches_notes(system, options, sweep)) text += wrap(note, 0);
  return text;
}

/// Element [section] of a vector over sections in one motion, or one number.
template <class Of>
Json along(const SweptBranch& branch, const Of& of) {
  Json list = Json::array();
  for (const SweptMotion& motion : branch.motions) list.push_back(of(motion));
  return list;
}

Json branch_object(const NonlinearSweep& sweep, const SweptBranch& branch) {
  Json sections = Json::array();
  for (Eigen::Index c = 0; c < static_cast<Eigen::Index>(sweep.sections.size()); ++c) {
    const auto of = [&](const Vector SweptMotion::*values) {
      return along(branch, [&](const SweptMotion& m) { return number((m.*values)[c]); });
    };
    Json amplitude = Json::array(), phase = Json::array();
    for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(sweep.orders.size()); ++k) {
      amplitude.push_back(
          along(branch, [&](const SweptMotion& m) { return number(std::abs(m.amplitude(k, c))); }));
      phase.push_back(
          along(branch, [&](const SweptMotion& m) { return number(to_deg(std::arg(m.amplitude(k, c)))); }));
    }
    sections.push_back(
        {{"half_range", along(branch, [&](const SweptMotion& m) { return number(m.half_range()[c]); })},
         {"maximum", of(&SweptMotion::maximum)},
         {"minimum", of(&SweptMotion::minimum)},
         {"mean", of(&SweptMotion::mean)},
         {"heat_W", of(&SweptMotion::heat)},
         {"twist_maximum", of(&SweptMotion::twist_maximum)},
         {"twist_minimum", of(&SweptMotion::twist_minimum)},
         {"amplitude", amplitude},
         {"phase_deg", phase}});
  }
  return {{"cycle_deg", number(360.0 * branch.turns)},
          {"whole", branch.whole},
          {"run_rpm", branch.run_speed > 0.0 ? number(to_rpm(branch.run_speed)) : Json()},
          {"speed_rpm", along(branch, [](const SweptMotion& m) { return number(to_rpm(m.speed)); })},
          {"asked", along(branch, [](const SweptMotion& m) { return Json(m.asked); })},
          {"stable", along(branch, [](const SweptMotion& m) { return m.judged ? Json(m.stable) : Json(); })},
          {"multiplier",
           along(branch, [](const SweptMotion& m) { return m.judged ? number(m.multiplier) : Json(); })},
          {"separates", along(branch, [](const SweptMotion& m) { return Json(m.separates); })},
          {"harmonics", along(branch, [](const SweptMotion& m) { return Json(m.harmonics); })},
          {"error", along(branch, [](const SweptMotion& m) { return number(m.error); })},
          {"sections", sections}};
}

std::string table_cell(double value) { return std::isfinite(value) ? to_text(value) : ""; }

/// Whether a run does not vibrate, beside the largest value of any of its sections.
bool at_rest(const SweptRun& run) {
  constexpr double kAtRest = 1e-9;  // range of a section that is rounding [-]
  const double largest = std::max(run.highest.cwiseAbs().maxCoeff(), run.lowest.cwiseAbs().maxCoeff());
  return (run.highest - run.lowest).maxCoeff() <= kAtRest * largest;
}

std::string excess_sentence(const NonlinearSweep& sweep) {
  const NonlinearSweep::Excess& excess = sweep.excess;
  const std::string turns = short_digits(sweep.turns, kFigureDigits) + " turns";
  const std::string why = excess.needed > 0
                              ? "in a cycle of " + turns + " the loads excite harmonics up to " +
                                    std::to_string(excess.needed) + " (order " +
                                    short_digits(excess.needed / sweep.turns, kFigureDigits) +
                                    "), and at most " + std::to_string(excess.most) + " can be solved for"
                              : "a load does not repeat in a cycle of " + turns;
  return "No curve of motions is followed: " + why + ". A curve would leave out " +
         digits(100.0 * excess.left_out, 2) +
         " % of the vibration of a section or mesh (rms, with closed contacts)." +
         (excess.needed > 0
              ? " Loads over the nominal angle (twist_feedback = false) leave room for more harmonics."
              : "");
}

}  // namespace

std::vector<std::string> branches_notes(const System& system, const NonlinearSweepOptions& options,
                                        const NonlinearSweep& sweep) {
  std::vector<std::string> notes;
  double error = 0.0;
  bool judged = true, unknown = false;
  for (const SweptBranch& branch : sweep.branches)
    for (const SweptMotion& motion : branch.motions) {
      if (motion.asked && std::isfinite(motion.error)) error = std::max(error, motion.error);
      unknown = unknown || (motion.asked && !std::isfinite(motion.error));
      judged = judged && motion.judged;
    }
  if (!sweep.branches.empty())
    notes.push_back("Largest error of a motion at the speeds asked for: " + digits(error, 1) +
                    " of its section's largest value" +
                    (error > options.tolerance
                         ? ", more than the " + short_digits(options.tolerance, 2) + " asked for"
                         : std::string()) +
                    (unknown ? "; of some it is unknown" : "") + "." +
                    (error > NonlinearSweep::kTrusted || unknown
                         ? " So few harmonics tell neither their stability nor where it changes."
                         : ""));
  for (std::size_t b = 0; b < sweep.branches.size(); ++b)
    if (sweep.branches[b].run_speed > 0.0)
      notes.push_back("Curve " + std::to_string(b + 1) + " starts from the motion that a run at " +
                      rpm_text(sweep.branches[b].run_speed) + " rpm settled on.");
  double of_runs = -1.0;
  for (const SweptRun& run : sweep.runs)
    if (run.repeats > 0 && !at_rest(run)) of_runs = std::max(of_runs, run.error);
  if (of_runs >= 0.0)
    notes.push_back(
        "Where a run repeats, its figures are those of a stable periodic motion that harmonic balance did "
        "not "
        "find: it takes more harmonics than were tried, or a law stays within its gap throughout, so that "
        "the mean position there may be any. From one repetition to the next they change by " +
        digits(of_runs, 1) +
        " of their section's largest value at most, with what the decay leaves to come.");
  std::vector<std::string> resting;
  for (const SweptRun& run : sweep.runs)
    if (run.repeats > 0 && at_rest(run)) resting.push_back(rpm_text(run.speed));
  if (!resting.empty())
    notes.push_back("Nothing vibrates at " + join(resting) +
                    " rpm: runs settle on their means, and what they state beside these is rounding.");
  if (!judged) notes.push_back("Stability is not judged with more than 200 unknowns.");
  for (std::size_t b = 0; b < sweep.branches.size(); ++b)
    if (!sweep.branches[b].whole)
      notes.push_back("Curve " + std::to_string(b + 1) + " could not be followed to its end" +
                      left_text(sweep.branches[b], options) + ".");
  if (!sweep.unsolved.empty() && !sweep.excess.found) {
    std::vector<std::string> speeds;
    for (const double speed : sweep.unsolved) speeds.push_back(rpm_text(speed));
    notes.push_back("Harmonic balance found no motion at " + join(speeds) + " rpm.");
  }
  for (const std::string& note : excitation_notes(options, sweep)) notes.push_back(note);
  for (const std::string& note : coupling_notes(system, sweep)) notes.push_back(note);
  return notes;
}

std::vector<std::string> excitation_notes(const NonlinearSweepOptions& options, const NonlinearSweep& sweep) {
  std::vector<std::string> notes;
  if (sweep.excess.found) notes.push_back(excess_sentence(sweep));
  for (std::size_t f = 0; f < sweep.floating_parts.size(); ++f) {
    const LeftOver left = left_over_of(sweep, f);
    if (left.most > kLeftOver)
      notes.push_back(
          left_over_sentence(left, sweep.floating_parts[f],
                             "The motions are those of the train that this speeds up; --balance NODE "
                             "takes it up at a node.",
                             options.balance));
  }
  return notes;
}

std::string branches_as_text(const ModelRequest& model, const NonlinearSweepOptions& options,
                             const NonlinearSweep& sweep) {
  const std::string& name = model.entry->name;
  std::string text = name + ": " + wrap(parameters_text(model.parameters), name.size() + 2);
  text += "periodic motions of " + short_digits(sweep.turns, kFigureDigits) + " turns a cycle, " +
          std::to_string(sweep.speeds.size()) + " speeds " + rpm_text(sweep.speeds.front()) + " to " +
          rpm_text(sweep.speeds.back()) + " rpm " + of_reference(model.model_case.model) + "\n\n";
  if (!sweep.branches.empty()) text += branches_table(sweep) + "\n";
  if (const std::string largest = largest_as_text(sweep); !largest.empty()) text += largest + "\n";
  if (!sweep.branches.empty()) text += changes_table(sweep) + "\n";
  for (const std::string& part :
       {runs_table(sweep), notes_text(model.system, options, sweep), wrap(model.model_case.note, 0)})
    if (!part.empty() && part != "\n") text += part + "\n";
  text.pop_back();
  return text;
}

Json branches_object(const ModelRequest& model, const NonlinearSweepOptions& options,
                     const NonlinearSweep& sweep) {
  Json object = result_object("branches");
  object["model"] = model.entry->name;
  object["parameters"] = parameters_object(model.parameters);
  Json sections = Json::array(), branches = Json::array(), changes = Json::array(), runs = Json::array(),
       floating = Json::array(), speeds = Json::array(), unsolved = Json::array();
  for (const auto& section : sweep.sections)
    sections.push_back({{"name", section.name},
                        {"unit", section.unit},
                        {"twist_unit", text_or_null(section.twist_unit)},
                        {"contact", section.contact}});
  for (const SweptBranch& branch : sweep.branches) branches.push_back(branch_object(sweep, branch));
  for (const SweptChange& change : sweep.changes)
    changes.push_back({{"what", to_text(change.kind)},
                       {"branch", change.branch + 1},
                       {"speed_rpm", number(to_rpm(change.speed))},
                       {"error_rpm", number(to_rpm(change.error))},
                       {"half_range", numbers(change.motion.half_range())},
                       {"jumps_to", change.jumps_to.size() > 0 ? numbers(change.jumps_to) : Json()}});
  for (const SweptRun& run : sweep.runs)
    runs.push_back({{"speed_rpm", number(to_rpm(run.speed))},
                    {"cycles", run.cycles},
                    {"repeats_after", run.repeats > 0 ? Json(run.repeats) : Json()},
                    {"error", number(run.error)},
                    {"reason", text_or_null(run.reason)},
                    {"mean", numbers(run.mean)},
                    {"mean_error", numbers(run.mean_error)},
                    {"deviation", numbers(run.deviation)},
                    {"lowest", numbers(run.lowest)},
                    {"highest", numbers(run.highest)},
                    {"left_over_Nm", numbers(run.left_over)}});
  for (std::size_t f = 0; f < sweep.floating_parts.size(); ++f)
    floating.push_back(
        {{"node", sweep.floating_parts[f]}, {"left_over_Nm", number(left_over_of(sweep, f).most)}});
  for (const double speed : sweep.speeds) speeds.push_back(number(to_rpm(speed)));
  for (const double speed : sweep.unsolved) unsolved.push_back(number(to_rpm(speed)));
  object["reference_shaft"] = text_or_null(reference_node(model.model_case.model));
  object["speeds_rpm"] = std::move(speeds);
  object["orders"] = sweep.orders;
  object["cycle_deg"] = number(360.0 * sweep.turns);
  object["tolerance"] = number(options.tolerance);
  object["sections"] = std::move(sections);
  object["branches"] = std::move(branches);
  object["changes"] = std::move(changes);
  object["runs"] = std::move(runs);
  object["largest"] = largest_objects(sweep);
  const NonlinearSweep::Excess& excess = sweep.excess;
  object["excess"] = excess.found ? Json({{"needed", excess.needed > 0 ? Json(excess.needed) : Json()},
                                          {"most", excess.most},
                                          {"left_out", number(excess.left_out)}})
                                  : Json();
  object["unsolved_rpm"] = std::move(unsolved);
  object["floating_parts"] = std::move(floating);
  object["balance"] = text_or_null(options.balance);
  object["notes"] = coupling_notes(model.system, sweep);
  object["note"] = text_or_null(model.model_case.note);
  return object;
}

std::string motions_as_csv(const NonlinearSweep& sweep) {
  std::string text = "curve,turns,speed_rpm,asked,state,multiplier,separates,error";
  for (const auto& section : sweep.sections) {
    for (const char* what : {"half_range", "maximum", "minimum", "mean", "heat_W"})
      text += "," + csv_cell(section.name + " " + what);
    for (const char* what : {"twist_maximum_", "twist_minimum_"})
      text += "," + csv_cell(section.name + " " + what + section.twist_unit);
  }
  text += "\n";
  for (std::size_t b = 0; b < sweep.branches.size(); ++b)
    for (const SweptMotion& m : sweep.branches[b].motions) {
      text += std::to_string(b + 1) + "," + to_text(sweep.branches[b].turns) + "," +
              to_text(to_rpm(m.speed)) + "," + (m.asked ? "1," : "0,") + state_of(m) + "," +
              (m.judged ? table_cell(m.multiplier) : "") + "," + (m.separates ? "1," : "0,") +
              table_cell(m.error);
      for (Eigen::Index c = 0; c < m.maximum.size(); ++c)
        for (const double value : {m.half_range()[c], m.maximum[c], m.minimum[c], m.mean[c], m.heat[c],
                                   m.twist_maximum[c], m.twist_minimum[c]})
          text += "," + table_cell(value);
      text += "\n";
    }
  return text;
}

std::string motion_orders_as_csv(const NonlinearSweep& sweep) {
  std::string text = "curve,speed_rpm,state,order";
  for (const auto& section : sweep.sections)
    text += "," + csv_cell(section.name + " amplitude") + "," + csv_cell(section.name + " phase_deg");
  text += "\n";
  for (std::size_t b = 0; b < sweep.branches.size(); ++b)
    for (const SweptMotion& m : sweep.branches[b].motions)
      for (std::size_t k = 0; m.asked && k < sweep.orders.size(); ++k) {
        text += std::to_string(b + 1) + "," + to_text(to_rpm(m.speed)) + "," + state_of(m) + "," +
                to_text(sweep.orders[k]);
        for (Eigen::Index c = 0; c < m.amplitude.cols(); ++c) {
          const std::complex<double> a = m.amplitude(static_cast<Eigen::Index>(k), c);
          text += "," + table_cell(std::abs(a)) + "," + table_cell(to_deg(std::arg(a)));
        }
        text += "\n";
      }
  return text;
}

std::string changes_as_csv(const NonlinearSweep& sweep) {
  std::string text = "speed_rpm,error_rpm,curve,what";
  for (const auto& section : sweep.sections)
    text += "," + csv_cell(section.name + " half_range") + "," + csv_cell(section.name + " jumps_to");
  text += "\n";
  for (const SweptChange& change : sweep.changes) {
    text += to_text(to_rpm(change.speed)) + "," + table_cell(to_rpm(change.error)) + "," +
            std::to_string(change.branch + 1) + "," + to_text(change.kind);
    for (Eigen::Index c = 0; c < change.motion.maximum.size(); ++c)
      text += "," + table_cell(change.motion.half_range()[c]) + "," +
              (change.jumps_to.size() > 0 ? table_cell(change.jumps_to[c]) : "");
    text += "\n";
  }
  return text;
}

}  // namespace drev::app
