#include <drev/solvers/accuracy/accuracy.hpp>
#include <drev/solvers/periodic/periodic_response.hpp>

#include <algorithm>
#include <cmath>

#include "tests/stability/coverage/cover.hpp"
#include "tests/stability/coverage/reference_averages.hpp"
#include "tests/stability/coverage/to_drev.hpp"

namespace coverage {

namespace {

constexpr int kSamples = 96;  // of a period
constexpr int kMostPeriods = 3000;
constexpr Real kSettled = 1e-16L;    // change of the state over a period, relative
constexpr Real kRounding = 1e-13L;   // below it a change that does not fall any more is rounding
constexpr double kDouble = 1e-14;    // relative: less is not asked of an error in double precision
constexpr double kStill = 1e-9;      // of the largest of its unit: a channel that does not move
constexpr double kNothing = 1e-15;   // rad, N m, ...: the same
constexpr double kElsewhere = 1e-2;  // relative: the reference settled on another motion
constexpr int kOrders = 6;

/// The reference's settled motion over one period.
struct Settled {
  bool found = false;
  std::vector<std::vector<Real>> samples;  ///< [channel][time]
  std::vector<ReferencePeak> peaks;
  Real change = 0;  ///< of the state over the last period, and all that would follow it, relative
};

Settled settle(ReferenceModel model, const std::vector<ChannelId>& channels, Real period) {
  Settled s;
  Real before_last = 0;
  const Real start = model.t;
  for (int i = 1; i <= kMostPeriods && !s.found; ++i) {
    std::vector<Real> before = model.z, rate = model.v;
    run_reference(model, start + i * period, kFine, {});
    Real most = 0, scale = 0, most_v = 0, scale_v = 0;
    for (std::size_t u = 0; u < before.size(); ++u) {
      most = std::max(most, std::abs(model.z[u] - before[u])), scale = std::max(scale, std::abs(model.z[u]));
      most_v = std::max(most_v, std::abs(model.v[u] - rate[u])),
      scale_v = std::max(scale_v, std::abs(model.v[u]));
    }
    const Real last = s.change;
    before_last = last;
    s.change = std::max(scale > 0 ? most / scale : 0, scale_v > 0 ? most_v / scale_v : 0);
    s.found = s.change < kSettled || (i > 1 && s.change < kRounding && s.change > last / 2);
  }
  if (!s.found) return s;
  // What changes by a factor each period has so much left to go; a slow decay is not known better than this.
  s.change *= s.change < before_last ? std::min<Real>(before_last / (before_last - s.change), 1e8L) : 1e8L;
  const Real begin = model.t;
  int next = 0;
  s.samples.resize(channels.size());
  s.peaks.resize(channels.size());
  bool first = true;
  run_reference(model, begin + period, kFine, {[&](const ReferenceStep& step) {
                  for (std::size_t c = 0; c < channels.size(); ++c) {
                    const Poly y = step.model.channel(channels[c]);
                    ReferencePeak& p = s.peaks[c];
                    if (first) p.most = p.least = y.a[0];
                    for (const Real at : extremes(y, step.h))
                      p.most = std::max(p.most, y.value(at)), p.least = std::min(p.least, y.value(at));
                    for (int i = next; i < kSamples && begin + period * i / kSamples < step.t + step.h; ++i)
                      s.samples[c].push_back(y.value(begin + period * i / kSamples - step.t));
                  }
                  while (next < kSamples && begin + period * next / kSamples < step.t + step.h) ++next;
                  first = false;
                }});
  return s;
}

double series_value(const std::vector<std::complex<double>>& a, double turn) {
  double y = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n)
    y += (a[n] * std::polar(1.0, static_cast<double>(n) * turn)).real();
  return y;
}

double series_rate(const std::vector<std::complex<double>>& a, double omega) {
  double y = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n) y -= a[n].imag() * static_cast<double>(n) * omega;
  return y;
}

/// Starts where drev's response starts, so that both are of one branch if that is stable.
ReferenceModel start_on(const Spec& spec, const drev::PeriodicResponse& response,
                        const std::vector<ChannelId>& channels) {
  Spec beside = spec;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    if (channels[c].kind != ChannelId::Kind::angle) continue;
    Node& node = beside.nodes[static_cast<std::size_t>(channels[c].index)];
    node.angle = series_value(response.amplitudes[c], 0.0);
    node.speed = series_rate(response.amplitudes[c], static_cast<double>(kTurn) / response.period);
  }
  return ReferenceModel(beside);
}

void compare_response(const drev::PeriodicResponse& r, const Settled& truth,
                      const std::vector<ChannelId>& channels, const std::string& where, Table& table) {
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const double largest = static_cast<double>(truth.peaks[c].amplitude());
    double of_kind = 0.0;
    for (std::size_t other = 0; other < channels.size(); ++other)
      if (unit(channels[other].kind) == unit(channels[c].kind))
        of_kind = std::max(of_kind, static_cast<double>(truth.peaks[other].amplitude()));
    if (!(largest > std::max(kStill * of_kind, kNothing))) continue;
    const double known = 10.0 * static_cast<double>(truth.change) * largest;
    double worst = -1.0, value = 0.0, at = 0.0;
    for (int i = 0; i < kSamples; ++i) {
      const double y = series_value(r.amplitudes[c], 2.0 * M_PI * i / kSamples);
      const double reference = static_cast<double>(truth.samples[c][static_cast<std::size_t>(i)]);
      if (std::abs(y - reference) > worst) worst = std::abs(y - reference), value = y, at = reference;
    }
    const std::string name = where + " " + channels[c].name;
    const double stated = std::max(r.error, kDouble) * largest;
    table.add("periodic response: motion [" + std::string(to_text(channels[c].kind)) + "]",
              {name, value, stated, at, known});
    table.add("periodic response: peak [" + std::string(to_text(channels[c].kind)) + "]",
              {name, r.peaks[c].amplitude(), stated, largest, known});
    for (int n = 0; n <= kOrders && n < static_cast<int>(r.amplitudes[c].size()); ++n) {
      std::complex<Real> sum = 0;  // of samples: aliased, of both alike
      std::complex<double> same = 0;
      for (int i = 0; i < kSamples; ++i) {
        const Real turn = kTurn * i / kSamples;
        sum += truth.samples[c][static_cast<std::size_t>(i)] * std::polar<Real>(1, -n * turn);
        same += series_value(r.amplitudes[c], static_cast<double>(turn)) *
                std::polar(1.0, -n * static_cast<double>(turn));
      }
      const double factor = (n == 0 ? 1.0 : 2.0) / kSamples;
      table.add("periodic response: order amplitude",
                {name + " order " + std::to_string(n), std::abs(same) * factor, stated,
                 static_cast<double>(std::abs(sum)) * factor, known});
    }
  }
}

/// The spec, started on the reference's settled motion.
Spec settled_start(const Spec& spec, const Settled& settled, const std::vector<ChannelId>& channels) {
  Spec started = spec;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    Node& node = started.nodes[static_cast<std::size_t>(channels[c].index)];
    if (channels[c].kind == ChannelId::Kind::angle) node.angle = static_cast<double>(settled.samples[c][0]);
    if (channels[c].kind == ChannelId::Kind::speed) node.speed = static_cast<double>(settled.samples[c][0]);
  }
  for (const Gear& g : spec.gears)  // follows its first node
    started.nodes[static_cast<std::size_t>(g.b)].angle = started.nodes[static_cast<std::size_t>(g.b)].speed =
        0.0;
  return started;
}

/// Orders of run_to_accuracy: amplitudes of the last two of four periods of a settled motion.
void compare_orders(const Spec& given, const std::vector<ChannelId>& channels, std::size_t which,
                    Table& table) {
  Spec spec = given;
  spec.duration = 4.0 * spec.period;
  const ChannelId& channel = channels[which % channels.size()];
  const drev::AccuracyResult r = drev::run_to_accuracy(to_drev(spec), {.accuracy = 1e-7,
                                                                       .t_end = spec.duration,
                                                                       .deflection = channel.name,
                                                                       .cycle = spec.period,
                                                                       .method = {.name = "exact"},
                                                                       .most_seconds = 5.0});
  if (!r.summary.ok() || r.horizon < spec.duration) return;
  const auto averages = [&](const ReferencePrecision& precision) {
    ReferenceModel model(spec);
    Averages all({channel}, 2 * static_cast<Real>(spec.period), spec.duration, kTurn / spec.period, 64);
    run_reference(model, spec.duration, precision, {std::ref(all)});
    return all;
  };
  const Averages fine = averages(kFine), check = averages(kCheck);
  for (const drev::Figure& f : r.figures) {
    if (f.kind != drev::Estimate::Kind::estimate || !f.name.starts_with("amplitude of order ")) continue;
    const int order = std::atoi(f.name.c_str() + 19);
    if (order < 1 || order > 64) continue;
    const Real truth = std::abs(fine.amplitude(0, order));
    if (truth < kNothing && f.value < kNothing) continue;
    table.add("accuracy: order amplitude [" + std::string(to_text(channel.kind)) + "]",
              {spec.name + " (" + spec.family + ") " + channel.name + " " + f.name, f.value, f.error,
               static_cast<double>(truth),
               2.0 * static_cast<double>(std::abs(truth - std::abs(check.amplitude(0, order))))});
  }
}

}  // namespace

void cover_periodic(const Spec& spec, int harmonics, Table& table) {
  const ReferenceModel model(spec);
  const std::vector<ChannelId>& channels = model.channels();
  std::vector<std::string> names;
  for (const ChannelId& id : channels) names.push_back(id.name);
  const drev::PeriodicResponse r = drev::solve_periodic(
      to_drev(spec), {.period = spec.period, .harmonics = harmonics, .tolerance = 1e-6, .channels = names});
  const std::string where = spec.name + " (" + spec.family + "), harmonics " + std::to_string(r.harmonics);
  if (!r.found) {
    table.add_note("periodic response not found: " + where + ": " + r.reason);
  } else {
    const Settled truth = settle(start_on(spec, r, channels), channels, spec.period);
    double off = 0.0, scale = 0.0;
    for (std::size_t c = 0; c < channels.size() && truth.found; ++c)
      if (channels[c].kind == ChannelId::Kind::angle) {
        off = std::max(
            off, std::abs(series_value(r.amplitudes[c], 0.0) - static_cast<double>(truth.samples[c][0])));
        scale = std::max(scale, static_cast<double>(truth.peaks[c].amplitude()));
      }
    if (!truth.found)
      table.add_note("the reference does not settle: " + where);
    else if (off > kElsewhere * scale && r.error < 0.1 * kElsewhere)
      table.add_note("the reference settles on another motion: " + where);
    else
      compare_response(r, truth, channels, where, table);
    if (truth.found)
      compare_orders(settled_start(spec, truth, channels), channels,
                     static_cast<std::size_t>(harmonics) + spec.nodes.size(), table);
  }
}

}  // namespace coverage
