#include "app/report/report_data.hpp"

#include <drev/core/units.hpp>

#include <algorithm>
#include <cmath>

#include "app/report/report_campbell.hpp"
#include "app/report/report_model.hpp"
#include "app/report/report_origin.hpp"
#include "app/report/report_spectra.hpp"
#include "app/results/run_json.hpp"
#include "app/results/run_text.hpp"
#include "app/run/run_computation.hpp"

namespace drev::app {

namespace {

constexpr double kRunSamples = 1e5;   // number of samples of a run, unless --every is given
constexpr double kAboveModes = 3.0;   // end of the spectra over the highest listed natural frequency [-]
constexpr double kAboveSpeed = 40.0;  // end of the spectra as an order, if that is higher

/// The command that reproduces this run.
std::string command_of(const RunRequest& request, const RunResult& result) {
  const Method& method = result.method;
  std::string text = "drev run " + request.words + model_options(request.model.parameters);
  if (request.duration) text += " --duration " + to_text(*request.duration);
  if (request.start != Start::rest) text += std::string(" --start ") + to_text(request.start);
  if (request.settle) text += " --settle " + (request.settle->time ? to_text(*request.settle->time) : "auto");
  text += " --method " + method.name;
  if (request.accuracy)
    return text + " --accuracy " + to_text(*request.accuracy) + (request.energy ? " --energy" : "");
  if (method.step > 0.0) text += " --step " + to_text(method.step);
  if (method.tolerance > 0.0) text += " --tolerance " + to_text(method.tolerance);
  if (request.energy) text += " --energy";
  if (result.reduction.used) text += " --reduce " + to_text(*request.reduce);
  return text;
}

/// Part of each group's time, as one byte: 255 is all of it.
std::string shares(const std::vector<float>& seconds, const ReportHistory& history) {
  std::vector<unsigned char> bytes(seconds.size());
  for (std::size_t i = 0; i < seconds.size(); ++i) {
    const double end = i + 1 < seconds.size() ? history.times()[i + 1] : history.end();
    const double length = end - history.times()[i];
    const double share = length > 0.0 ? static_cast<double>(seconds[i]) / length : 0.0;
    bytes[i] = static_cast<unsigned char>(std::lround(255.0 * std::clamp(share, 0.0, 1.0)));
  }
  return base64(bytes);
}

Json history_object(const ReportHistory& history) {
  Json series = Json::array();
  for (std::size_t s = 0; s < history.series().size(); ++s) {
    const ReportHistory::Series& one = history.series()[s];
    Json object{{"name", one.name},
                {"unit", one.unit},
                {"energy", s >= history.channel_count()},
                {"low", base64(one.low)}};
    if (history.group() > 1) object["high"] = base64(one.high);
    series.push_back(std::move(object));
  }
  Json bands = Json::array();
  for (const ReportHistory::Band& band : history.bands())
    bands.push_back({{"element", band.element},
                     {"front", shares(band.front, history)},
                     {"back", shares(band.back, history)}});
  Json object{{"samples", history.samples()},
              {"group", history.group()},
              {"groups", history.times().size()},
              {"end", history.end()},
              {"every", history.every()}};
  if (history.every() == 0.0) object["times"] = base64(history.times());
  object["series"] = std::move(series);
  object["bands"] = std::move(bands);
  return object;
}

/// The waterfall order by order, each over all windows.
Json waterfall_object(const OrderTracks& tracks) {
  if (tracks.time.size() < 2) return nullptr;
  Json channels = Json::array(), speeds = Json::array();
  for (const double speed : tracks.speed) speeds.push_back(to_rpm(speed));
  for (std::size_t c = 0; c < tracks.channels.size(); ++c) {
    std::vector<float> values;
    for (const std::vector<double>& line : tracks.amplitude[c])
      for (const double value : line) values.push_back(static_cast<float>(value));
    channels.push_back(
        {{"name", tracks.channels[c]}, {"unit", tracks.units[c]}, {"amplitude", base64(values)}});
  }
  return {{"orders", tracks.orders}, {"speed_rpm", std::move(speeds)}, {"channels", std::move(channels)}};
}

/// The nominal speed over time, for histories over speed; if nothing turns nominally, the speed of the
/// windows in which orders are tracked.
Json speeds_object(const System& system, const OrderTracks& tracks, double end) {
  constexpr int kPoints = 512;
  Json times = Json::array(), speeds = Json::array();
  const auto add = [&](double time, double speed) {
    times.push_back(time);
    speeds.push_back(to_rpm(speed));
  };
  if (tracks.shaft.empty())
    for (int i = 0; i <= kPoints; ++i) add(end * i / kPoints, system.reference()->at(end * i / kPoints).rate);
  else
    for (std::size_t w = 0; w < tracks.time.size(); ++w) add(tracks.time[w], tracks.speed[w]);
  return {
      {"shaft", text_or_null(tracks.shaft)}, {"time_s", std::move(times)}, {"speed_rpm", std::move(speeds)}};
}

}  // namespace

double report_interval(const RunRequest& request, const Method& method) {
  if (request.report_every) return *request.report_every;
  if (!(method.tolerance > 0.0)) return 0.0;
  const double duration = request.model.model_case.duration, about = duration / kRunSamples;
  const double cycle = cycle_of(request.model);
  if (!(cycle > 2.0 * about) || cycle > duration) return about;
  // A number of samples per cycle for which transforms are fast.
  return cycle / std::exp2(std::floor(std::log2(cycle / about)));
}

Json report_data(const RunRequest& request, const RunResult& result, const ReportHistory& history) {
  const ModelRequest& m = request.model;
  Json data;
  data["format"] = 2;
  add_origin(data);
  data["command"] = command_of(request, result);
  data["about"] = m.entry->summary;
  data["warning"] = warning_of(result);
  data["notes"] = notes_of(result);
  data["inputs"] = inputs_array(m.parameters);
  data["result"] = run_object(request, result);
  data["model"] = model_object(m.model_case.model, m.system);
  data["modes"] = Json::array();
  data["campbell"] = nullptr;
  double highest = 0.0;
  if (result.modes) {
    data["modes"] = modes_object(m.system, *result.modes);
    data["campbell"] = campbell_object(m.model_case.model, m.system, *result.modes, m.model_case.duration);
    if (result.modes->count() > 0) highest = kAboveModes * result.modes->frequency_Hz.back();
  }
  highest = std::max(highest, kAboveSpeed * m.system.reference_speed() / kTwoPi);
  data["history"] = history_object(history);
  data["waterfall"] = result.run_up ? waterfall_object(result.run_up->waterfall) : Json();
  data["speeds"] =
      result.run_up ? speeds_object(m.system, result.run_up->orders, result.summary.t_end) : Json();
  // A run-up has orders over speed instead (result.run_up).
  data["spectra"] = result.run_up
                        ? Json()
                        : spectra_object(history, result.span.from, spectrum_cycle(m),
                                         m.system.reference_speed(), highest > 0.0 ? highest : HUGE_VAL);
  return data;
}

}  // namespace drev::app
