#include "app/results/run_text.hpp"

#include <drev/core/units.hpp>

#include <algorithm>
#include <cmath>

#include "app/base/parameter_text.hpp"
#include "app/base/text_layout.hpp"

namespace drev::app {

namespace {

constexpr std::size_t kModesShown = 6;

/// A largest value with its significant digits and its error; with the usual digits if it was not checked.
std::string value_text(const Largest& l) {
  const bool angle = l.unit == "rad";
  const double factor = angle ? to_deg(1.0) : 1.0;
  const std::string unit = angle ? " deg" : " " + l.unit;
  if (!l.error) return digits(factor * l.value, angle ? 4 : 5) + unit;
  return earned_digits(factor * l.value, factor * *l.error) + " +- " + short_digits(factor * *l.error, 2) +
         unit;
}

std::string speed_text(double rad_per_s) { return digits(to_rpm(rad_per_s), 5) + " rpm"; }

/// The element and the nodes that it connects.
std::string place_text(const Model& model, const Largest& l) {
  const std::string place = l.place();
  for (const ElementInstance& placement : model.element_instances()) {
    if (placement.name != place) continue;
    std::vector<std::string> nodes;
    for (const NodeRef& node : placement.nodes) nodes.push_back(model.name_of(node));
    return place + " (" + join(nodes, " to ") + ")";
  }
  return place;
}

/// "between A and B" for the difference of two nodes, "of A" for one.
std::string deflection_place(const Model& model, const Largest& l) {
  const std::string place = l.place();
  const auto& names = model.node_names();
  const auto is_node = [&](const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  for (std::size_t cut = place.find('-'); cut != std::string::npos; cut = place.find('-', cut + 1)) {
    const std::string first = place.substr(0, cut), second = place.substr(cut + 1);
    if (is_node(first) && is_node(second)) return "between " + second + " and " + first;
  }
  return "of " + place;
}

std::string modes_row(const RunResult& r) {
  if (!r.modes) return labelled("Modes", "not found: " + r.modes_reason);
  std::vector<std::string> shown;
  for (const double f : r.modes->frequency_Hz)
    if (shown.size() < kModesShown) shown.push_back(digits(f, 5));
  return labelled("Lowest modes", (shown.empty() ? "none" : join(shown) + " Hz") + ", and " +
                                      std::to_string(r.modes->rigid_modes) + " rigid; contacts closed");
}

std::string force_rows(const ModelCase& model_case, const RunResult& r) {
  const Model& model = model_case.model;
  const bool torque = model_case.torques.empty() || model_case.torques.front().ends_with("_Nm");
  const std::string name = torque ? "torque" : "force";
  std::string text;
  if (r.force)
    text += labelled("Largest " + name, value_text(*r.force) + " in " + place_text(model, *r.force) + " at " +
                                            short_digits(r.force->at, 4) + " s");
  if (!r.static_force && model_case.static_turn == 0.0) return text;
  if (!r.static_force)
    return text + labelled("Static " + name, "none, and so no dynamic amplification: " + r.static_reason);
  if (const auto amplification = r.amplification())
    text += labelled("Dynamic amplification",
                     digits(*amplification, 3) + ": the largest " + name + " over the largest in static " +
                         "equilibrium over one turn, " + value_text(*r.static_force) + " in " +
                         place_text(model, *r.static_force));
  return text;
}

/// The row with the time span that the figures belong to, and the evidence for their accuracy.
std::string span_row(const RunResult& r) {
  std::string text = r.span.from > 0.0 ? "of the run from " + short_digits(r.span.from, 6) + " s to " +
                                             short_digits(r.summary.t_end, 6) + " s"
                                       : "of the whole run, " + short_digits(r.summary.t_end, 6) + " s";
  text += ", which starts " + r.span.start;
  if (!r.span.reason.empty()) text += "; " + r.span.reason;
  if (!r.accuracy) text += "; unchecked: --accuracy gives their errors";
  return labelled("Figures", text);
}

/// Rows of the critical speeds passed, and of the speeds at which orders are largest.
std::string run_up_rows(const SpeedsPassed& up) {
  constexpr std::size_t kCriticalsShown = 5;
  std::string text = speed_text(up.range.first) + " to " + speed_text(up.range.last);
  if (up.range.lowest < std::min(up.range.first, up.range.last) ||
      up.range.highest > std::max(up.range.first, up.range.last))
    text += ", between " + speed_text(up.range.lowest) + " and " + speed_text(up.range.highest);
  if (!up.orders.shaft.empty()) text += ", actual mean speeds of " + up.orders.shaft;
  text = labelled("Run-up", text);
  std::vector<std::string> criticals;
  for (const Crossing& c : up.criticals)
    if (criticals.size() < kCriticalsShown)
      criticals.push_back(speed_text(c.speed) + " (order " + short_digits(c.order, 4) + ", " +
                          digits(up.frequency_Hz[static_cast<std::size_t>(c.mode)], 4) + " Hz)");
  text += labelled("Criticals passed", (!criticals.empty()   ? join(criticals)
                                        : up.unknown.empty() ? "none"
                                                             : "none known") +
                                           "; the most excited first, contacts closed");
  const std::string turns = short_digits(up.turns, 4) + " turns";
  if (!up.orders.channels.empty())
    text += labelled("Orders", "mean amplitudes over windows of " + turns +
                                   ", below the highest one where a resonance is passed within a window");
  for (std::size_t c = 0; c < up.orders.channels.size(); ++c) {
    const std::vector<std::vector<double>>& amplitude = up.orders.amplitude[c];
    double largest = 0.0;
    std::size_t order = 0, window = 0;
    for (std::size_t k = 0; k < amplitude.size(); ++k)
      for (std::size_t w = 0; w < amplitude[k].size(); ++w)
        if (amplitude[k][w] > largest) largest = amplitude[k][w], order = k, window = w;
    if (largest > 0.0)
      text += "  " + wrap(up.orders.channels[c] + ": order " + short_digits(up.orders.orders[order], 4) +
                              " largest in the " + turns + " about " + speed_text(up.orders.speed[window]) +
                              ", amplitude " + digits(largest, 4) + " " + up.orders.units[c],
                          4);
  }
  return text;
}

std::string contact_line(const std::string& name, long front, long back, const std::string& separated,
                         double share, const std::string& force) {
  return "  " + pad_right(name, kLabel - 2) + pad_left(std::to_string(front), 8) +
         pad_left(std::to_string(back), 8) + pad_left(separated, 15) +
         pad_left(digits(100.0 * share, 3), 10) + pad_left(force, 18) + "\n";
}

/// Quantiles of a distribution: "0.012, 0.045, 0.09 m/s".
std::string quantiles_text(const Distribution& d, const std::string& unit) {
  return digits(d.quantile(0.5), 3) + ", " + digits(d.quantile(0.9), 3) + ", " + digits(d.quantile(0.99), 3) +
         " " + unit;
}

/// Rows on the severity of flank impacts; empty without impacts.
std::string impact_rows(const RunResult& r, double duration) {
  std::string text;
  for (const Contacts& c : r.contacts) {
    const ContactRecord& k = c.record;
    if (k.impacts() == 0) continue;
    std::string line = "speed " + quantiles_text(k.speed(), c.speed_unit());
    if (k.force().count() > 0) line += "; force " + quantiles_text(k.force(), c.force_unit);
    text += "  " + pad_right(k.element, kLabel - 2) +
            wrap(line + (std::isfinite(k.impact_energy)
                             ? "; rattle index " + digits(k.rattle_index(duration), 3) + " W"
                             : "; no rattle index, both nodes are prescribed"),
                 kLabel);
  }
  if (text.empty()) return {};
  return labelled("Impacts", "not exceeded in 50, 90 and 99 % of them; rattle index: impact power") + text;
}

/// Errors of a contact's row, in its columns; a question mark: unknown. Empty where they were not checked.
std::string contact_error_line(const Contacts& c, double duration) {
  if (!c.known) return {};
  const auto text = [](double error, int width, double factor = 1.0, const std::string& unit = "") {
    return pad_left(std::isfinite(error) ? short_digits(factor * error, 2) + unit : "?", width);
  };
  const ContactFigures& k = *c.known;
  return "  " + pad_right("  +-", kLabel - 2) + text(k.front_impacts.error, 8) +
         text(k.back_impacts.error, 8) + text(k.time_separated.error, 15) +
         text(k.time_separated.error, 10, 100.0 / duration) +
         text(k.largest_force.error, 18, 1.0, " " + c.force_unit) + "\n";
}

/// A figure of a contact with its significant digits where its error is known, otherwise with the usual
/// digits.
std::string contact_digits(const Contacts& c, double value, Estimate ContactFigures::*figure, int usual) {
  if (!c.known || !std::isfinite(((*c.known).*figure).error)) return digits(value, usual);
  return earned_digits(value, ((*c.known).*figure).error);
}

std::string contact_rows(const RunResult& r) {
  if (r.contacts.empty()) {
    if (!r.mesh_force) return {};
    return labelled("Largest mesh force", value_text(*r.mesh_force) + " in " + r.mesh_force->place() +
                                              " at " + short_digits(r.mesh_force->at, 4) +
                                              " s; no backlash, so no impacts");
  }
  std::string text = pad_right("Contacts", kLabel) + pad_left("front", 8) + pad_left("back", 8) +
                     pad_left("separated [s]", 15) + pad_left("[%]", 10) + pad_left("largest force", 18) +
                     "\n";
  const double duration = r.span_length() > 0.0 ? r.span_length() : 1.0;
  long front = 0, back = 0;
  double separated = 0.0;
  const Contacts* hardest = &r.contacts.front();
  for (const Contacts& c : r.contacts) {
    const ContactRecord& k = c.record;
    text += contact_line(
        k.element, k.front_impacts, k.back_impacts,
        contact_digits(c, k.time_separated, &ContactFigures::time_separated, 4), k.time_separated / duration,
        contact_digits(c, k.largest_force, &ContactFigures::largest_force, 5) + " " + c.force_unit);
    text += contact_error_line(c, duration);
    front += k.front_impacts;
    back += k.back_impacts;
    separated += k.time_separated;
    if (k.largest_force > hardest->record.largest_force) hardest = &c;
  }
  if (r.contacts.size() > 1)
    text += contact_line("all", front, back, digits(separated, 4),
                         separated / (duration * static_cast<double>(r.contacts.size())),
                         digits(hardest->record.largest_force, 5) + " " + hardest->force_unit);
  return text + impact_rows(r, duration);
}

std::string energy_row(const EnergyBalance& e) {
  if (!(e.scale > 0.0)) return labelled("Energy balance", "no energy but that of the nominal rotation");
  if (std::abs(e.relative_error()) < 1e-12) return labelled("Energy balance", "holds to rounding");
  return labelled("Energy balance", "off by " + digits(100.0 * e.relative_error(), 2) + " % of " +
                                        digits(e.scale, 3) + " J" +
                                        (e.worst_imbalance > 0.0 ? " (gained)" : " (lost)") + ", worst at " +
                                        short_digits(e.worst_time, 4) + " s");
}

std::string method_text(const RunResult& r) {
  std::string text = r.summary.scheme;
  if (r.method.tolerance > 0.0) text += ", tolerance " + short_digits(r.method.tolerance, 3);
  if (r.method.step > 0.0)
    text +=
        (r.method.controlled() ? ", steps of at most " : ", step ") + short_digits(r.method.step, 4) + " s";
  return text;
}

/// The effort of the run: the usual work of the method, and any other work that was done.
std::string effort_text(const RunResult& r) {
  const RunSummary& s = r.summary;
  const bool exact = r.method.exact(), controlled = r.method.controlled();
  std::vector<std::string> items;
  const auto add = [&](bool shown, long count, const char* what) {
    if (shown || count > 0) items.push_back(std::to_string(count) + " " + what);
  };
  add(true, s.steps, "steps");
  add(controlled, s.rejected, "rejected");
  add(!exact && !controlled, s.halved, "halved");
  add(exact, s.contact_changes, "contact changes located");
  add(false, s.located, "kinks or knots located");
  add(false, s.fallbacks, "with a force inside its jump");
  add(false, s.forced, "of the least length, with an error above their share");
  add(!exact && !controlled, s.iterations, "iterations");
  add(false, s.solves, exact ? "matrix-vector products" : "linear solves");
  return join(items) + ", " + digits(r.run_time, 3) + " s";
}

/// A value with the digits that its error leaves significant, and the error.
std::string figure_text(const Figure& f) {
  const bool known = std::isfinite(f.error);
  return earned_digits(f.value, f.error) + " +- " +
         (known ? short_digits(f.error, 2) : std::string("unknown")) + (f.unit.empty() ? "" : " " + f.unit);
}

std::string accuracy_rows(double asked, const AccuracyResult& a) {
  std::string text = labelled(
      "Accuracy asked", short_digits(asked, 3) + (a.reached ? ": reached" : ": not reached: " + a.reason));
  text += labelled("Growth", "a small difference grows " +
                                 short_digits(a.growth.growth.empty() ? 1.0 : a.growth.growth.back(), 3) +
                                 " times at most, exp(" + short_digits(a.growth.rate, 3) + " t) +- " +
                                 short_digits(a.growth.rate_error, 2) + " 1/s on the whole");
  for (const Figure& f : a.figures)
    text += "  " + f.name + ": " + figure_text(f) +
            (f.kind == Figure::Kind::interval ? " (95 % interval)"
             : f.keeps(asked)                 ? ""
                                              : " (not kept)") +
            "\n";
  return text;
}

/// Rows of load cycles, with the damage by Miner's rule where there is an S-N line.
std::string rainflow_rows(const RunResult& r) {
  std::string text;
  for (const RainflowWatch::Result& counted : r.rainflow) {
    std::string row = counted.of.channel.name() + ": " + short_digits(counted.histogram.cycles(), 8) +
                      " cycles, largest range " + digits(counted.histogram.largest(), 6) + " " +
                      counted.of.channel.unit();
    if (counted.of.line.given())
      row += "; Miner's sum " + digits(counted.damage, 4) + " in " + short_digits(r.span_length(), 4) + " s" +
             (counted.damage > 0.0
                  ? ", 1 after " + digits(r.span_length() / counted.damage / 3600.0, 3) + " h of the same"
                  : "");
    text += labelled(text.empty() ? "Rainflow counts" : "", row);
  }
  return text;
}

/// Rows of work, heat and stored energy of each element, by descending loss.
std::string element_rows(const RunResult& r) {
  if (r.elements.empty()) return {};
  std::vector<ElementTotals::Row> rows = r.elements;
  std::stable_sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) {
    return a.dissipated.value_or(0.0) > b.dissipated.value_or(0.0);
  });
  const auto cell = [](const std::optional<double>& value) { return value ? digits(*value, 6) : "-"; };
  std::vector<std::vector<std::string>> table{
      {"element", "work [J]", "dissipated [J]", "mean dissipation [W]", "largest stored [J]"}};
  for (const ElementTotals::Row& row : rows)
    table.push_back(
        {row.element, cell(row.work), cell(row.dissipated), cell(row.mean_loss()), cell(row.largest_stored)});
  return "\n" + columns_text(table) + "\n";
}

}  // namespace

std::string warning_of(const RunResult& r) {
  if (r.ok()) return {};
  std::string head = "RUN FAILED (" + r.status + ")";
  if (r.status == "energy_error") head = "DO NOT TRUST THIS RUN (energy_error)";
  if (r.status == "interrupted") head = "RUN INTERRUPTED";
  if (r.status == "output_error") head = "RUN GIVEN UP (output_error)";
  return head + ": " + r.reason;
}

std::vector<std::string> notes_of(const RunResult& r) {
  std::vector<std::string> notes;
  if (const PartSpeed* part = r.off_speed()) {
    const bool nominal = r.run_up && r.run_up->orders.shaft.empty();  // run_up.hpp
    notes.push_back(
        "the model turns at " + speed_text(part->actual) + " on the mean, not at the nominal " +
        speed_text(part->nominal) + " (" + digits(100.0 * part->deviation(), 3) +
        " %): only a balance of torques holds the speed of the part with " + part->node +
        (nominal ? "; orders over the run-up are per turn at the nominal speed, which the loads follow"
                 : "; orders are per turn at the actual speed"));
  }
  if (r.run_up && !r.run_up->unknown.empty())
    notes.push_back("the orders of " + join(r.run_up->unknown) +
                    " are not known, and their resonances not among the criticals: a torque of each does not "
                    "repeat within two turns of its node");
  return notes;
}

/// Rows on sticking and sliding of contacts with dry friction.
std::string friction_rows(const RunSummary& s) {
  constexpr std::size_t kEventsShown = 12;
  if (s.friction_changes == 0) return "";
  std::string text;
  for (std::size_t i = 0; i < std::min(kEventsShown, s.friction_events.size()); ++i) {
    const FrictionEvent& e = s.friction_events[i];
    text += (i > 0 ? "; " : "") + e.element + " " + e.becomes + " at " + short_digits(e.t, 6) + " s";
  }
  const long left_out = s.friction_changes - static_cast<long>(kEventsShown);
  if (left_out > 0) text += "; and " + std::to_string(left_out) + " more (--json lists the first thousand)";
  return labelled("Friction", text);
}

std::string run_as_text(const RunRequest& request, const RunResult& r) {
  const RunSummary& s = r.summary;
  const Model& model = request.model.model_case.model;
  std::string text;
  if (!r.ok()) text += "*** " + warning_of(r) + "\n\n";
  for (const std::string& warning : s.warnings) text += "*** WARNING: " + warning + "\n\n";
  for (const std::string& note : notes_of(r)) text += "*** " + wrap("NOTE: " + note, 4) + "\n";
  text += request.model.entry->name + ": " +
          wrap(parameters_text(request.model.parameters), request.model.entry->name.size() + 2);
  text += "\n" + modes_row(r);
  if (r.deflection || r.force || !r.contacts.empty() || r.mesh_force) text += span_row(r);
  if (r.deflection)
    text += labelled("Largest deflection", value_text(*r.deflection) + " " +
                                               deflection_place(model, *r.deflection) + " at " +
                                               short_digits(r.deflection->at, 4) + " s");
  if (!r.force && !r.ok())
    text += labelled("Largest values", "none: the run failed at " + short_digits(s.t_end, 6) + " s");
  text += force_rows(request.model.model_case, r) + contact_rows(r) + friction_rows(s);
  if (r.run_up) text += run_up_rows(*r.run_up);
  text += rainflow_rows(r) + element_rows(r);
  text += energy_row(s.energy);
  text += labelled("Method", method_text(r) + ", to t = " + short_digits(s.t_end, 6) + " s");
  text += labelled("Why this method", r.method_reason);
  text += labelled("Reduction", r.reduction.reason);
  text += labelled("Effort", effort_text(r));
  if (r.accuracy) text += accuracy_rows(*request.accuracy, *r.accuracy);
  if (!request.model.model_case.note.empty()) text += labelled("Note", request.model.model_case.note);
  return text;
}

}  // namespace drev::app
