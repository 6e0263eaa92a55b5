// Table, JSON, CSV and charts of `drev chart`.
#include <algorithm>
#include <cmath>

#include "app/base/json_values.hpp"
#include "app/base/parameter_text.hpp"
#include "app/base/text_layout.hpp"
#include "app/chart/chart_computation.hpp"
#include "app/chart/svg_chart.hpp"

namespace drev::app {

namespace {

constexpr double kAccuracies[] = {1e-2, 1e-4, 1e-6};
constexpr std::size_t kColumn = 24;

std::string time_text(double seconds) {
  if (seconds < 1e-3) return digits(1e6 * seconds, 2) + " us";
  if (seconds < 1.0) return digits(1e3 * seconds, 2) + " ms";
  return digits(seconds, 2) + " s";
}

std::string knob_text(const Method& m) {
  return m.tolerance > 0.0 ? "tol " + short_digits(m.tolerance, 2) : short_digits(m.step, 3) + " s";
}

bool at_source_step(const WorkPoint& p) {
  return p.method.step > 0.0 && std::abs(p.method.step / kSourceStep - 1.0) < 1e-9;
}

std::string source_step_text(const WorkCurve& curve) {
  for (const WorkPoint& p : curve.points)
    if (at_source_step(p)) return p.ok ? digits(p.error, 2) : "fails";
  return "-";
}

/// The cheapest that keeps the accuracy, and the next.
std::string conclusion(const ChartResult& r, double accuracy) {
  const auto best = r.data.cheapest(accuracy);
  if (!best) return "no method reaches it, or the reference is not known so well.";
  std::string text =
      to_text(best->point->method) + ": " + time_text(best->point->seconds) + " of processor time";
  const WorkPoint* next = nullptr;
  for (const WorkCurve& curve : r.data.curves)
    if (&curve != best->curve)
      if (const WorkPoint* p = r.data.cheapest(curve, accuracy))
        if (next == nullptr || p->seconds < next->seconds) next = p;
  if (next == nullptr) return text + "; no other method reaches it within the limit.";
  return text + "; next " + to_text(next->method) + " with " +
         digits(next->seconds / std::max(best->point->seconds, 1e-9), 2) + " times as much.";
}

/// What the advice is for.
std::string advice_heading(const ChartResult& r) {
  return wrap("Which method should I use? From 0 to " + short_digits(r.data.t_end, 4) + " s:", 0);
}

/// The parameters that are not the default: "drive held, ...".
std::string changed_settings(const Parameters& parameters) {
  std::vector<std::string> items;
  for (std::size_t i = 0; i < parameters.known().size(); ++i)
    if (parameters.values()[i] != parameters.known()[i].default_text)
      items.push_back(parameters.known()[i].name + " " + parameters.values()[i]);
  return items.empty() ? "" : ", " + join(items);
}

}  // namespace

std::string chart_as_text(const ChartRequest& request, const ChartResult& r) {
  const WorkPrecision& data = r.data;
  const std::string name = request.model.entry->name;
  std::string text = name + ": " + wrap(parameters_text(request.model.parameters), name.size() + 2) + "\n";
  text += labelled("Error", "of " + r.quantity + ", the largest over the samples from 0 to " +
                                short_digits(data.t_end, 4) + " s, over its peak, " + digits(data.peak, 4) +
                                " " + data.unit);
  if (!r.horizon_reason.empty()) text += labelled("Horizon", r.horizon_reason);
  text += labelled("Reference", data.reference + "; " + data.check + " agrees with it to " +
                                    digits(data.agreement, 2) + ", and no error below that is known");
  std::size_t label = kLabel;
  for (const WorkCurve& curve : data.curves) label = std::max(label, curve.name.size() + 4);
  text += "\n" + pad_right("Processor time for", label);
  for (const double accuracy : kAccuracies) text += pad_right(short_digits(accuracy, 2), kColumn);
  text += "error at 1 ms\n";
  for (const WorkCurve& curve : data.curves) {
    text += pad_right("  " + curve.name, label);
    for (const double accuracy : kAccuracies) {
      const WorkPoint* p = data.cheapest(curve, accuracy);
      text += pad_right(p ? time_text(p->seconds) + " (" + knob_text(p->method) + ")" : std::string("-"),
                        kColumn);
    }
    text += source_step_text(curve) + "\n";
  }
  text += "\n" + advice_heading(r);
  for (const double accuracy : kAccuracies)
    text += labelled("  for " + short_digits(accuracy, 2), conclusion(r, accuracy));
  return text;
}

std::string chart_as_json(const ChartRequest& request, const ChartResult& r) {
  const WorkPrecision& data = r.data;
  Json object;
  object["model"] = request.model.entry->name;
  object["parameters"] = parameters_object(request.model.parameters);
  object["quantity"] = r.quantity;
  object["t_end_s"] = number(data.t_end);
  object["horizon"] = text_or_null(r.horizon_reason);
  object["peak"] = number(data.peak);
  object["unit"] = data.unit;
  object["reference"] = data.reference;
  object["check"] = data.check;
  object["agreement"] = number(data.agreement);
  object["curves"] = Json::array();
  for (const WorkCurve& curve : data.curves) {
    Json points = Json::array();
    for (const WorkPoint& p : curve.points)
      points.push_back({{"step_s", p.method.step > 0.0 ? number(p.method.step) : Json()},
                        {"tolerance", p.method.tolerance > 0.0 ? number(p.method.tolerance) : Json()},
                        {"error", p.ok ? number(p.error) : Json()},
                        {"processor_time_s", p.ok ? number(p.seconds) : Json()},
                        {"work", p.ok ? number(p.work) : Json()},
                        {"trusted", data.trusted(p)},
                        {"reason", text_or_null(p.reason)}});
    object["curves"].push_back({{"method", curve.name}, {"points", std::move(points)}});
  }
  object["cheapest"] = Json::array();
  for (const double accuracy : kAccuracies) {
    const auto best = data.cheapest(accuracy);
    object["cheapest"].push_back(
        {{"accuracy", accuracy},
         {"method", best ? Json(best->point->method.name) : Json()},
         {"step_s", best && best->point->method.step > 0.0 ? number(best->point->method.step) : Json()},
         {"tolerance",
          best && best->point->method.tolerance > 0.0 ? number(best->point->method.tolerance) : Json()},
         {"processor_time_s", best ? number(best->point->seconds) : Json()}});
  }
  return json_text(object);
}

std::string chart_as_csv(const ChartResult& r) {
  std::string text = "method,step_s,tolerance,error,processor_time_s,work,trusted\n";
  for (const WorkCurve& curve : r.data.curves)
    for (const WorkPoint& p : curve.points) {
      const auto cell = [](double x, bool there) { return there ? short_digits(x, 17) : std::string(); };
      // Method names hold commas: newmark:0.25,0.5.
      text += "\"" + curve.name + "\"," + cell(p.method.step, p.method.step > 0.0) + "," +
              cell(p.method.tolerance, p.method.tolerance > 0.0) + "," + cell(p.error, p.ok) + "," +
              cell(p.seconds, p.ok) + "," + cell(p.work, p.ok) + "," + (r.data.trusted(p) ? "yes" : "no") +
              "\n";
    }
  return text;
}

std::string chart_as_svg(const ChartRequest& request, const ChartResult& r, ChartAxis axis) {
  std::vector<ChartSeries> series;
  double shortest = HUGE_VAL, longest = 0.0;
  ChartSeries source_step{.name = "step of 1 ms", .line = false, .rings = true};
  for (const WorkCurve& curve : r.data.curves) {
    ChartSeries s{.name = curve.name, .markers = true};
    for (const WorkPoint& p : curve.points) {
      const double x = axis == ChartAxis::time ? p.seconds : p.work;
      const double y = std::max(p.error, r.data.agreement);
      if (!p.ok || !(y > 0.0) || !(x > 0.0)) continue;
      s.x.push_back(x), s.y.push_back(y);
      longest = std::max(longest, x), shortest = std::min(shortest, x);
      if (at_source_step(p)) source_step.x.push_back(x), source_step.y.push_back(y);
      if (!r.data.trusted(p)) break;  // finer ones stand on the same line
    }
    if (!s.x.empty()) series.push_back(std::move(s));
  }
  if (!source_step.x.empty()) series.push_back(std::move(source_step));
  if (r.data.agreement > 0.0 && longest > 0.0)
    series.push_back({.name = "below: agreement of reference and check",
                      .x = {shortest, longest},
                      .y = {r.data.agreement, r.data.agreement}});
  const std::string name = request.model.entry->name;
  return svg_chart({.title = name + changed_settings(request.model.parameters) + ": error of " + r.quantity +
                             " from 0 to " + short_digits(r.data.t_end, 3) + " s",
                    .x_label = axis == ChartAxis::time ? "processor time [s]" : "linear solves",
                    .y_label = "largest error over peak",
                    .log_x = true,
                    .log_y = true,
                    .height = 480},
                   series);
}

}  // namespace drev::app
