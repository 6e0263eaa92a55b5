#include "app/results/run_json.hpp"

#include <drev/core/units.hpp>
#include <drev/core/version.hpp>

#include <unistd.h>

#include "app/base/json_values.hpp"
#include "app/results/run_text.hpp"

namespace drev::app {

namespace {

/// Value of a quantity in one unit; null if the model gives it in another unit, or not at all.
Json in_unit(const std::optional<Largest>& largest, const std::string& unit, double factor = 1.0) {
  return largest && largest->unit == unit ? number(factor * largest->value) : Json(nullptr);
}

Json place_of(const std::optional<Largest>& largest, const std::string& unit) {
  return largest && largest->unit == unit ? Json(largest->place()) : Json(nullptr);
}

Json distribution_object(const Distribution& d) {
  const bool any = d.count() > 0;
  Json object{{"count", d.count()}, {"mean", any ? number(d.mean()) : Json()}};
  object["p50"] = any ? number(d.quantile(0.5)) : Json();
  object["p90"] = any ? number(d.quantile(0.9)) : Json();
  object["p99"] = any ? number(d.quantile(0.99)) : Json();
  object["max"] = any ? number(d.largest()) : Json();
  return object;
}

Json flanks_object(const Distribution& front, const Distribution& back, const Distribution& both,
                   const std::string& unit) {
  return {{"unit", unit},
          {"front", distribution_object(front)},
          {"back", distribution_object(back)},
          {"both", distribution_object(both)}};
}

/// Error of one figure of a contact; null: not checked, or unknown.
Json contact_error(const Contacts& c, Estimate ContactFigures::*figure) {
  return c.known ? number(((*c.known).*figure).error) : Json();
}

Json contact_object(const Contacts& c, double duration) {
  const bool newton = c.force_unit == "N";
  const Json force_error = contact_error(c, &ContactFigures::largest_force);
  return {{"element", c.record.element},
          {"front_contacts", c.record.front_impacts},
          {"back_contacts", c.record.back_impacts},
          {"time_separated_s", number(c.record.time_separated)},
          {"time_separated_share", duration > 0.0 ? number(c.record.time_separated / duration) : Json()},
          {"max_force_N", newton ? number(c.record.largest_force) : Json()},
          {"max_torque_Nm", newton ? Json() : number(c.record.largest_force)},
          {"max_at_time_s", number(c.record.largest_force_time)},
          {"front_contacts_error", contact_error(c, &ContactFigures::front_impacts)},
          {"back_contacts_error", contact_error(c, &ContactFigures::back_impacts)},
          {"time_separated_error_s", contact_error(c, &ContactFigures::time_separated)},
          {"max_force_error_N", newton ? force_error : Json()},
          {"max_torque_error_Nm", newton ? Json() : force_error},
          {"impact_speed",
           flanks_object(c.record.front_speed, c.record.back_speed, c.record.speed(), c.speed_unit())},
          {"impact_force",
           flanks_object(c.record.front_force, c.record.back_force, c.record.force(), c.force_unit)},
          {"impact_energy_J", number(c.record.impact_energy)},
          {"rattle_index_W", number(c.record.rattle_index(duration))}};
}

/// Error of a largest value; null: not checked.
Json error_of(const std::optional<Largest>& largest) {
  if (!largest || !largest->error) return nullptr;
  return number((largest->unit == "rad" ? to_deg(1.0) : 1.0) * *largest->error);
}
Json error_of(const std::optional<Largest>& largest, const std::string& unit) {
  return largest && largest->unit == unit ? error_of(largest) : Json(nullptr);
}

void add_contacts(Json& results, const RunResult& r) {
  results["max_mesh_force_N"] = in_unit(r.mesh_force, "N");
  results["max_mesh_force_at"] = place_of(r.mesh_force, "N");
  results["max_mesh_force_error"] = error_of(r.mesh_force, "N");
  if (r.contacts.empty()) {  // no gap anywhere, or no figures
    for (const char* key : {"front_contacts", "back_contacts", "time_separated_s"}) results[key] = nullptr;
    results["contacts"] = Json::array();
    return;
  }
  long front = 0, back = 0;
  double separated = 0.0;
  Json list = Json::array();
  for (const Contacts& c : r.contacts) {
    front += c.record.front_impacts;
    back += c.record.back_impacts;
    separated += c.record.time_separated;
    list.push_back(contact_object(c, r.span_length()));
  }
  results["front_contacts"] = front;
  results["back_contacts"] = back;
  results["time_separated_s"] = number(separated);
  results["contacts"] = std::move(list);
}

Json sections_array(const RunResult& r) {
  Json list = Json::array();
  for (const SectionPeaks& s : r.sections)
    list.push_back({{"channel", s.channel},
                    {"unit", s.unit},
                    {"peak_maximum", number(s.whole.max)},
                    {"peak_minimum", number(s.whole.min)},
                    {"maximum", number(s.settled.max)},
                    {"minimum", number(s.settled.min)},
                    {"half_range", number(s.half_range())},
                    {"permissible", number(s.permissible)}});
  return list;
}

Json friction_object(const RunSummary& s) {
  Json events = Json::array();
  for (const FrictionEvent& e : s.friction_events)
    events.push_back({{"time_s", number(e.t)}, {"element", e.element}, {"becomes", e.becomes}});
  return {{"changes", s.friction_changes}, {"events", std::move(events)}};
}

Json rainflow_array(const RunResult& r) {
  Json list = Json::array();
  for (const RainflowWatch::Result& counted : r.rainflow) {
    Json classes = Json::array();
    for (const RainflowHistogram::Class& c : counted.histogram.classes())
      classes.push_back({{"cycles", c.count}, {"mean_range", c.mean_range()}, {"largest_range", c.largest}});
    const bool line = counted.of.line.given();
    list.push_back(
        {{"channel", counted.of.channel.name()},
         {"unit", counted.of.channel.unit()},
         {"cycles", counted.histogram.cycles()},
         {"largest_range", number(counted.histogram.largest())},
         {"stress_per_unit_Pa", number(counted.of.stress_per_unit)},
         {"damage", line ? number(counted.damage) : Json()},
         {"hours_to_failure",
          line && counted.damage > 0.0 ? number(r.span_length() / counted.damage / 3600.0) : Json()},
         {"classes", std::move(classes)}});
  }
  return list;
}

Json elements_array(const RunRequest& request, const RunResult& r) {
  if (!request.energy) return nullptr;
  Json list = Json::array();
  for (const ElementTotals::Row& row : r.elements)
    list.push_back({{"element", row.element},
                    {"work_J", number(row.work)},
                    {"dissipated_J", number(row.dissipated)},
                    {"mean_dissipation_W", number(row.mean_loss())},
                    {"largest_stored_J", number(row.largest_stored)}});
  return list;
}

Json span_object(const RunResult& r) {
  return {{"from_s", number(r.span.from)},
          {"to_s", number(r.summary.t_end)},
          {"start", text_or_null(r.span.start)},
          {"settled", r.span.settled},
          {"reason", text_or_null(r.span.reason)}};
}

Json speed_object(const RunResult& r) {
  if (r.speeds.empty()) return nullptr;
  const PartSpeed& part = r.off_speed() != nullptr ? *r.off_speed() : r.speeds.front();
  return {{"node", part.node},
          {"nominal_rpm", number(to_rpm(part.nominal))},
          {"actual_rpm", number(to_rpm(part.actual))}};
}

Json run_up_object(const SpeedsPassed& up) {
  Json criticals = Json::array(), channels = Json::array(), speeds = Json::array();
  for (const Crossing& c : up.criticals)
    criticals.push_back({{"mode", c.mode + 1},
                         {"frequency_Hz", number(up.frequency_Hz[static_cast<std::size_t>(c.mode)])},
                         {"order", c.order},
                         {"speed_rpm", number(to_rpm(c.speed))},
                         {"static", number(c.answer)}});
  for (const double speed : up.orders.speed) speeds.push_back(number(to_rpm(speed)));
  for (std::size_t c = 0; c < up.orders.channels.size(); ++c) {
    Json phases = Json::array();
    for (const std::vector<double>& order : up.orders.phase[c]) {
      Json over_windows = Json::array();
      for (const double phase : order) over_windows.push_back(number(to_deg(phase)));
      phases.push_back(std::move(over_windows));
    }
    channels.push_back({{"name", up.orders.channels[c]},
                        {"unit", up.orders.units[c]},
                        {"amplitude", up.orders.amplitude[c]},
                        {"phase_deg", std::move(phases)}});
  }
  return {{"slowest_rpm", number(to_rpm(up.range.slowest))},
          {"fastest_rpm", number(to_rpm(up.range.fastest))},
          {"criticals", std::move(criticals)},
          {"shaft", text_or_null(up.orders.shaft)},
          {"turns", up.turns},
          {"window", "hann"},
          {"bandwidth_orders", OrderTracking::kBandwidth / up.turns},
          {"resolution_orders", OrderTracking::kResolution / up.turns},
          {"orders", up.orders.orders},
          {"time_s", up.orders.time},
          {"speed_rpm", std::move(speeds)},
          {"channels", std::move(channels)}};
}

/// Whether every largest value and every figure of contacts has a known error.
bool all_checked(const RunResult& r) {
  bool any = !r.contacts.empty(), all = true;
  for (const auto* largest : {&r.force, &r.deflection, &r.mesh_force}) {
    any |= largest->has_value();
    all &= !largest->has_value() || (*largest)->error.has_value();
  }
  for (const Contacts& c : r.contacts)
    all &= c.known && std::isfinite(c.known->largest_force.error + c.known->time_separated.error);
  return any && all;
}

Json results_object(const RunRequest& request, const RunResult& r) {
  Json results;
  results["of"] = span_object(r);
  results["sections"] = sections_array(r);
  results["rainflow"] = rainflow_array(r);
  results["elements"] = elements_array(request, r);
  results["checked"] = all_checked(r);
  results["deflection_deg"] = in_unit(r.deflection, "rad", to_deg(1.0));
  results["deflection_m"] = in_unit(r.deflection, "m");
  results["deflection_of"] = r.deflection ? Json(r.deflection->place()) : Json();
  results["deflection_error"] = error_of(r.deflection);
  results["max_torque_Nm"] = in_unit(r.force, "N m");
  results["max_torque_at"] = place_of(r.force, "N m");
  results["max_force_N"] = in_unit(r.force, "N");
  results["max_force_at"] = place_of(r.force, "N");
  results["max_at_time_s"] = r.force ? number(r.force->at) : Json();
  results["max_error"] = error_of(r.force);
  results["static_torque_Nm"] = in_unit(r.static_force, "N m");
  results["static_force_N"] = in_unit(r.static_force, "N");
  results["static_at"] = r.static_force ? Json(r.static_force->place()) : Json();
  results["static_reason"] = text_or_null(r.static_reason);
  results["dynamic_amplification"] = number(r.amplification());
  add_contacts(results, r);
  results["friction"] = r.summary.friction_changes > 0 ? friction_object(r.summary) : Json();
  results["frequencies_Hz"] = Json();
  results["rigid_modes"] = Json();
  if (r.modes) {
    results["frequencies_Hz"] = r.modes->frequency_Hz;
    results["rigid_modes"] = r.modes->rigid_modes;
  }
  return results;
}

Json energy_object(const EnergyBalance& e) {
  return {{"kinetic_J", number(e.kinetic)},
          {"stored_J", number(e.stored)},
          {"input_J", number(e.input)},
          {"dissipated_J", number(e.dissipated)},
          {"imbalance_J", number(e.imbalance)},
          {"worst_imbalance_J", number(e.worst_imbalance)},
          {"worst_at_time_s", number(e.worst_time)},
          {"scale_J", number(e.scale)}};
}

Json accuracy_object(double asked, const AccuracyResult& a) {
  Json figures = Json::array();
  for (const Figure& f : a.figures)
    figures.push_back({{"name", f.name},
                       {"unit", text_or_null(f.unit)},
                       {"value", number(f.value)},
                       {"error", number(f.error)},
                       {"kind", f.kind == Figure::Kind::interval ? "95 % interval" : "estimate"},
                       {"keeps_accuracy", f.kind == Figure::Kind::estimate ? Json(f.keeps(asked)) : Json()}});
  return {{"asked", asked},
          {"reached", a.reached},
          {"reason", text_or_null(a.reason)},
          {"horizon_s", number(a.horizon)},
          {"growth", a.growth.growth.empty() ? Json() : number(a.growth.growth.back())},
          {"growth_rate_per_s", number(a.growth.rate)},
          {"growth_rate_error_per_s", number(a.growth.rate_error)},
          {"coarse", to_text(a.coarse)},
          {"fine", to_text(a.fine)},
          {"figures", std::move(figures)}};
}

Json reduction_object(const std::optional<double>& within, const ReductionNote& r) {
  return {{"within", number(within)},
          {"used", r.used},
          {"coordinates", r.coordinates},
          {"unknowns", r.of},
          {"modes", r.used ? Json(r.modes) : Json()},
          {"static_shapes", r.used ? Json(r.static_shapes) : Json()},
          {"error", number(r.error)},
          {"error_of", text_or_null(r.channel)},
          {"reason", r.reason}};
}

/// The part of the result that every run has, finished or not.
Json head_object(const RunRequest& request, const std::string& scheme, const Method& method,
                 const std::string& status, const std::string& reason) {
  Json object = result_object("run");
  object["model"] = request.model.entry->name;
  object["parameters"] = parameters_object(request.model.parameters);
  object["method"] = scheme;
  object["method_reason"] = request.method_reason;
  object["step_s"] = method.step > 0.0 ? number(method.step) : Json();
  object["tolerance"] = method.tolerance > 0.0 ? number(method.tolerance) : Json();
  object["status"] = status;
  object["reason"] = text_or_null(reason);
  return object;
}

}  // namespace

Json result_object(const char* kind) {
  return {{"$schema", "urn:drev:results:1"}, {"kind", kind}, {"drev", DREV_VERSION}};
}

Json run_object(const RunRequest& request, const RunResult& r) {
  const RunSummary& s = r.summary;
  const bool exact = r.method.exact(), controlled = r.method.controlled();
  Json object = head_object(request, s.scheme, r.method, r.status, r.reason);
  object["warnings"] = s.warnings;
  object["method_reason"] = r.method_reason;
  object["reduction"] = reduction_object(request.reduce, r.reduction);
  object["notes"] = notes_of(r);
  object["speed"] = speed_object(r);
  object["results"] = results_object(request, r);
  object["run_up"] = r.run_up ? run_up_object(*r.run_up) : Json();
  object["accuracy"] = r.accuracy ? accuracy_object(*request.accuracy, *r.accuracy) : Json();
  object["energy_error"] = r.status == "failed" ? Json() : number(s.energy.relative_error());
  object["energy"] = energy_object(s.energy);
  object["t_end_s"] = number(s.t_end);
  object["steps"] = s.steps;
  object["halved_steps"] = s.halved;
  object["rejected_steps"] = controlled ? Json(s.rejected) : Json();
  object["forced_steps"] = controlled ? Json(s.forced) : Json();
  object["fallback_steps"] = exact ? Json() : Json(s.fallbacks);
  object["contact_changes"] = exact ? Json(s.contact_changes) : Json();
  object["located"] = controlled ? Json(s.located) : Json();
  object["iterations"] = s.iterations;
  object["solves"] = s.solves;
  object["run_time_s"] = number(r.run_time);
  object["phases"] = {{"modes_s", number(r.modes_time)},
                      {"static_s", number(r.static_time)},
                      {"reduction_s", number(r.reduction_time)},
                      {"accuracy_s", number(r.accuracy_time)},
                      {"simulation_s", number(r.run_time)}};
  object["note"] = text_or_null(request.model.model_case.note);
  return object;
}

std::string run_as_json(const RunRequest& request, const RunResult& result) {
  return json_text(run_object(request, result));
}

std::string running_as_json(const RunRequest& request) {
  Json object =
      head_object(request, request.method.name, request.method, "running",
                  "the run has not ended: it still goes on, its process was killed, or the disk was full");
  object["process"] = ::getpid();
  object["duration_s"] = number(request.model.model_case.duration);
  object["record"] = request.record;
  object["every_s"] = number(request.every);
  object["note"] = text_or_null(request.model.model_case.note);
  return json_text(object);
}

}  // namespace drev::app
