#include "solvers/periodic/order_content.hpp"

#include <drev/core/law/harmonic_load.hpp>
#include <drev/core/law/knotted_load.hpp>
#include <drev/core/law/law_force.hpp>
#include <drev/core/law/speed_scaled_load.hpp>
#include <drev/core/load.hpp>
#include <drev/core/units.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/dense/fourier.hpp"
#include "core/names/rounded_text.hpp"

namespace drev {

namespace {

using Complex = std::complex<double>;

constexpr double kSame = 1e-12;  // difference over the largest torque up to which loads are equal [-]
constexpr double kAngleRounding = 2e-15;  // of an angle that is moved, over the angle [-]
constexpr int kFewestSamples = 256;

LoadResponse at_angle(const LoadTerm& term, double angle, double speed, double t = 0.0,
                      double deviation = 0.0) {
  return term.load->evaluate(
      {.t = t, .nominal_angle = angle, .deviation = deviation, .speed = speed, .nominal_speed = speed});
}

/// Up to which difference values at a probe, moved by up to kMostTurns turns or not, are equal. size: of all values; steep: the slope
/// there, if it is known.
double rounding_at(const LoadProbes::Probe& probe, double size, double steep = 0.0) {
  const double angle = std::abs(probe.angle) + OrderContent::kMostTurns * kTwoPi;
  return kSame * size + kAngleRounding * angle * std::max(std::abs(steep), size / probe.width);
}

/// Whether a curve of a load repeats after an angle.
bool repeats_after(const SpeedScaledLoad& load, int curve, const LoadProbes& probes,
                   const std::vector<double>& values, double angle) {
  double size = 0.0;
  for (const double value : values) size = std::max(size, std::abs(value));
  for (std::size_t i = 0; i < values.size(); ++i)
    if (std::abs(load.curve(curve, probes.at[i].angle + angle) - values[i]) > rounding_at(probes.at[i], size))
      return false;
  return true;
}

}  // namespace

OrderContent::OrderContent(const System& system, std::vector<double> orders, std::vector<Finding>& findings)
    : system_(system), orders_(std::move(orders)) {
  const double some_speed = system.reference_speed() != 0.0 ? system.reference_speed() : 1.0;
  for (const LoadTerm& term : system.loads()) {
    if (system.node_map(term.node).prescribed >= 0) continue;  // the reaction carries it
    Source source;
    if (const Source* relative = family_source(term)) {
      source = *relative;
      source.scaled = dynamic_cast<const SpeedScaledLoad*>(term.load);
      source.relative = static_cast<int>(relative - sources_.data());
    } else {
      if (!dynamic_cast<const HarmonicLoad*>(term.load))
        source.probes = probes_of(*term.load, system.ratio(term.node) * some_speed, kMostTurns);
      if (!inspect(term, some_speed, source, findings)) continue;
    }
    follows_speed_ = follows_speed_ || source.called;
    loads_.push_back(&term);
    sources_.push_back(source);
  }
  content_.resize(loads_.size());
}

const OrderContent::Source* OrderContent::family_source(const LoadTerm& term) const {
  const auto* scaled = dynamic_cast<const SpeedScaledLoad*>(term.load);
  for (std::size_t l = 0; scaled && scaled->family().id && l < loads_.size(); ++l) {
    const auto* other = dynamic_cast<const SpeedScaledLoad*>(loads_[l]->load);
    if (other && other->family().id == scaled->family().id &&
        system_.ratio(loads_[l]->node) == system_.ratio(term.node))
      return &sources_[l];
  }
  return nullptr;
}

bool OrderContent::inspect(const LoadTerm& term, double at_speed, Source& source,
                           std::vector<Finding>& findings) const {
  const std::string place = system_.name() + "/" + system_.element_instances()[idx(index(term.element))].name;
  const auto refuse = [&](const std::string& why) {
    findings.push_back({place, "", "", "", why});
    return false;
  };
  const double ratio = system_.ratio(term.node), speed = ratio * at_speed;
  const std::string does_not_turn = "follows the angle of " + system_.node_names()[idx(term.node)] +
                                    ", which does not turn with the reference shaft";
  if (const auto* harmonics = dynamic_cast<const HarmonicLoad*>(term.load)) {
    source.constant = harmonics->orders().terms.empty();
    source.by_angle = source.harmonics = true;
    return source.constant || ratio != 0.0 || refuse(does_not_turn);
  }
  const SpeedScaledLoad* scaled = source.scaled = dynamic_cast<const SpeedScaledLoad*>(term.load);
  std::vector<LoadResponse> there;
  double size = 0.0;
  for (const LoadProbes::Probe& probe : source.probes.at) {
    there.push_back(at_angle(term, probe.angle, speed));
    size = std::max(size, std::abs(there.back().torque));
  }
  // Whether another way to evaluate the load gives the same torques, to rounding of the largest and of the angle.
  const auto same = [&](const auto& other) {
    for (std::size_t i = 0; i < there.size(); ++i) {
      const LoadProbes::Probe& probe = source.probes.at[i];
      if (std::abs(other(probe.angle).torque - there[i].torque) >
          rounding_at(probe, size, there[i].dtorque_dangle))
        return false;
    }
    return true;
  };
  bool in_time = !term.load->frequencies().empty() || !term.load->breakpoints().empty();
  constexpr std::array kTimes{0.0173, 0.291, 1.37, 11.3, 97.7};  // s
  std::size_t i = 0;
  in_time =
      in_time ||
      (!scaled && !same([&](double a) { return at_angle(term, a, speed, kTimes[i++ % kTimes.size()]); }));
  if (in_time)
    return refuse(
        "is a function of the time and has no orders; a sweep takes loads that follow the angle, such as "
        "engine_order_torque and cam_torque, and constant ones");
  source.table = term.load->table().has_value();
  source.called = !scaled && !source.table && term.load->depends_on_motion();
  const bool standing = same([&](double) { return at_angle(term, 0.0, speed); });
  // The curves of a load that is scaled by the speed count, whatever is left of them at this one.
  source.constant = ratio == 0.0 || (standing && !scaled);
  if (ratio == 0.0 && !standing) return refuse(does_not_turn);
  if (!source.constant && !source.table) {
    std::vector<std::vector<double>> curves(scaled ? scaled->speed_factors(speed).size() : 0);
    for (std::size_t k = 0; k < curves.size(); ++k)
      for (const LoadProbes::Probe& probe : source.probes.at)
        curves[k].push_back(scaled->curve(static_cast<int>(k), probe.angle));
    const auto repeats = [&](double angle) {
      for (std::size_t k = 0; k < curves.size(); ++k)
        if (!repeats_after(*scaled, static_cast<int>(k), source.probes, curves[k], angle)) return false;
      return scaled || same([&](double a) { return at_angle(term, a + angle, speed); });
    };
    const std::array turns{1, 2, 3, 4, 5, 6, 8, 10, 12, 15, kMostTurns};
    const auto* found = std::find_if(turns.begin(), turns.end(), [&](int n) { return repeats(n * kTwoPi); });
    // Rounding of the angle changes a steep load by more than the rounding of its torque.
    if (found == turns.end())
      return refuse("does not repeat within " + std::to_string(kMostTurns) + " turns of its node");
    source.turns = *found;
  }
  constexpr double kTurned = 0.3;  // rad
  source.by_angle = same([&](double a) { return at_angle(term, a - kTurned, speed, 0.0, kTurned); });
  return true;
}

/// Whether the load is another than at the speed for which its content is known. Of one that is called, this finds its properties
/// at the speed anew.
bool OrderContent::changes(std::size_t load, double speed, std::vector<Finding>& findings) {
  Source& source = sources_[load];
  const LoadTerm& term = *loads_[load];
  if (source.scaled) {
    if (source.relative >= 0) return !source.known || sources_[idx(source.relative)].changed;
    std::vector<double> factors = source.scaled->speed_factors(system_.ratio(term.node) * speed);
    const bool changes = !source.known || factors != source.factors;
    source.factors = std::move(factors);
    return changes;
  }
  if (!source.called) return !source.known;
  const double here = system_.ratio(term.node) * speed;
  Source found;
  // Knots do not follow the speed.
  found.probes = dynamic_cast<const KnottedLoad*>(term.load) && source.known
                     ? source.probes
                     : probes_of(*term.load, here, kMostTurns);
  for (std::size_t i = 0; i < found.probes.at.size(); ++i) {
    const LoadResponse r = at_angle(term, found.probes.at[i].angle, here, 0.173 * static_cast<double>(i));
    found.probed.insert(found.probed.end(), {r.torque, r.dtorque_dangle, r.dtorque_dspeed});
  }
  if (source.known && found.probes.at == source.probes.at && found.probed == source.probed) return false;
  if (!inspect(term, speed, found, findings)) return false;
  if (found.turns == source.turns) found.samples = source.samples;
  source = std::move(found);
  return true;
}

/// Takes the orders out of all lines. lines: harmonics over the node's own angle, counted forward; spacing:
/// order of line 1 per turn of the reference shaft.
void OrderContent::pick(const std::vector<Complex>& lines, double spacing, bool forward,
                        Content& content) const {
  double taken = 0.0;
  content.amplitudes.assign(orders_.size(), 0.0);
  for (std::size_t k = 0; k < orders_.size(); ++k) {
    const double line = orders_[k] / spacing;
    const double whole = std::round(line);
    if (whole < 1.0 || std::abs(line - whole) > kWholeLine * line ||
        whole >= static_cast<double>(lines.size()))
      continue;
    const Complex c = lines[static_cast<std::size_t>(whole)];
    if (std::abs(c) <= kNoLine * content.rms) continue;
    content.amplitudes[k] = forward ? c : std::conj(c);
    taken += 0.5 * std::norm(c);
  }
  content.left_out = std::sqrt(std::max(0.0, content.rms * content.rms - taken));
  if (content.left_out < 1e-7 * content.rms) content.left_out = 0.0;  // of the difference, rounding
}

int OrderContent::fewest_samples(const Source& source, double spacing) const {
  const double highest = orders_.empty() ? 1.0 : orders_.back();
  const double parts = source.probes.finest > 0.0 ? source.turns * kTwoPi / source.probes.finest : 0.0;
  int samples = std::max(kFewestSamples, source.samples);
  while (samples < std::max(8.0 * highest / spacing, 2.0 * parts) && samples < kMostSamples) samples *= 2;
  return samples;
}

double OrderContent::difference(const Content& coarse, const Content& fine) {
  double size = std::max(std::abs(fine.mean), fine.rms), difference = std::abs(fine.mean - coarse.mean);
  for (std::size_t k = 0; k < fine.amplitudes.size(); ++k) {
    size = std::max(size, std::abs(fine.amplitudes[k]));
    difference = std::max(difference, std::abs(fine.amplitudes[k] - coarse.amplitudes[k]));
  }
  return difference > 0.0 ? difference / size : 0.0;
}

OrderContent::Content OrderContent::of_table(const LoadTerm& term) const {
  const LoadTable table = *term.load->table();
  const double ratio = system_.ratio(term.node), spacing = kTwoPi / table.period * std::abs(ratio);
  const std::size_t knots = table.arguments.size();
  const auto next = [&](std::size_t i) { return i + 1 < knots ? i + 1 : 0; };
  Content content;
  content.node = term.node;
  double square = 0.0;
  std::vector<double> length(knots);
  for (std::size_t i = 0; i < knots; ++i) {
    length[i] = i + 1 < knots ? table.arguments[i + 1] - table.arguments[i]
                              : table.period - table.arguments[i] + table.arguments[0];
    content.mean += 0.5 * length[i] * (table.values[i] + table.values[next(i)]) / table.period;
  }
  for (std::size_t i = 0; i < knots; ++i) {
    const double a = table.values[i] - content.mean, b = table.values[next(i)] - content.mean;
    square += length[i] * (a * a + a * b + b * b) / (3.0 * table.period);
  }
  content.rms = std::sqrt(square);
  // Only the lines of the orders given.
  std::vector<Complex> lines;
  for (const double order : orders_) {
    const double line = std::round(order / spacing);
    if (line < 1.0 || std::abs(order / spacing - line) > kWholeLine * line || line > 1e7) continue;
    const auto m = static_cast<std::size_t>(line);
    if (lines.size() <= m) lines.resize(m + 1);
    const double wave = kTwoPi * line / table.period;
    Complex sum = 0.0;
    for (std::size_t i = 0; i < knots; ++i) {
      const double before = table.slopes[i > 0 ? i - 1 : knots - 1];
      sum += (table.slopes[i] - before) * std::polar(1.0, -wave * (table.arguments[i] - table.phase));
    }
    lines[m] = -2.0 / (table.period * wave * wave) * sum;
  }
  pick(lines, spacing, ratio > 0.0, content);
  return content;
}

/// The same for the actual and the nominal angle of the load: a slope that repeats with the angle has no
/// mean.
OrderContent::Content OrderContent::of_harmonics(const LoadTerm& term) const {
  const LoadOrders given = dynamic_cast<const HarmonicLoad&>(*term.load).orders();
  const double ratio = system_.ratio(term.node);
  Content content;
  content.node = term.node;
  content.mean = given.mean;
  content.amplitudes.assign(orders_.size(), 0.0);
  double square = 0.0, taken = 0.0;
  for (std::size_t i = 0; i < given.terms.size();) {
    const double order = given.terms[i].order * std::abs(ratio);
    Complex c = 0.0;
    for (const double same = given.terms[i].order; i < given.terms.size() && given.terms[i].order == same;
         ++i)
      c += Complex(given.terms[i].cosine, -given.terms[i].sine);
    square += 0.5 * std::norm(c);
    for (std::size_t k = 0; k < orders_.size(); ++k)
      if (std::abs(orders_[k] - order) <= kWholeLine * order) {
        content.amplitudes[k] = ratio > 0.0 ? c : std::conj(c);
        taken += 0.5 * std::norm(c);
      }
  }
  content.rms = std::sqrt(square);
  content.left_out = std::sqrt(std::max(0.0, square - taken));
  if (content.left_out < 1e-7 * content.rms) content.left_out = 0.0;  // of the difference, rounding
  return content;
}

OrderContent::Content OrderContent::of_samples(const LoadTerm& term, Source& source, double speed) const {
  const double ratio = system_.ratio(term.node);
  const double spacing = std::abs(ratio) / source.turns;
  FourierTransform transform;
  std::vector<LoadResponse> values;
  std::vector<double> torque;
  std::vector<Complex> lines;
  const auto sample = [&](int samples) {
    const std::vector<LoadResponse> half =
        std::move(values);  // every second new sample, except the first time
    values.resize(static_cast<std::size_t>(samples));
    for (int i = 0; i < samples; ++i)
      values[idx(i)] = !half.empty() && i % 2 == 0
                           ? half[idx(i / 2)]
                           : at_angle(term, source.turns * kTwoPi * i / samples, ratio * speed);
  };
  // Of every sample, or of every second one.
  const auto content_of = [&](int every) {
    Content content;
    content.node = term.node;
    double steepest = 0.0;
    const int samples = static_cast<int>(values.size()) / every;
    torque.resize(static_cast<std::size_t>(samples));
    double square = 0.0;
    for (int i = 0; i < samples; ++i) {
      const LoadResponse& r = values[idx(i * every)];
      torque[idx(i)] = r.torque;
      content.mean += r.torque / samples;
      content.angle_slope += r.dtorque_dangle / samples;
      content.speed_slope += r.dtorque_dspeed / samples;
      steepest = std::max(steepest, std::abs(r.dtorque_dangle));
    }
    // A load that repeats with the angle, nominal angle and deviation alike, has no mean slope, but the
    // samples of a curve with kinks have one.
    if (source.by_angle || std::abs(content.angle_slope) <= kSettled * steepest) content.angle_slope = 0.0;
    for (const double value : torque) square += (value - content.mean) * (value - content.mean) / samples;
    content.rms = std::sqrt(square);
    if (std::abs(content.mean) <= kNoLine * content.rms) content.mean = 0.0;
    transform.forward(lines, torque);
    lines.resize(static_cast<std::size_t>(samples) / 2);  // without the Nyquist line
    for (Complex& line : lines) line *= 2.0 / samples;
    pick(lines, spacing, ratio > 0.0, content);
    return content;
  };
  int samples = fewest_samples(source, spacing);
  sample(samples);
  Content coarse = content_of(2), content = content_of(1);
  while (samples < kMostSamples && difference(coarse, content) > kSettled) {
    sample(samples *= 2);
    coarse = std::exchange(content, content_of(1));
  }
  source.samples = samples;
  return content;
}

const std::vector<OrderContent::Content>& OrderContent::at(double speed) {
  if (speed == speed_) return content_;
  speed_ = 0.0;
  std::vector<Finding> findings;
  for (std::size_t l = 0; l < loads_.size(); ++l) {
    Source& source = sources_[l];
    source.changed = changes(l, speed, findings);
    if (!source.changed || !findings.empty()) continue;
    source.known = true;
    const LoadTerm& term = *loads_[l];
    const bool no_slope = source.by_angle || !term.load->depends_on_motion();
    if (source.constant) {
      const LoadResponse r = at_angle(term, 0.0, system_.ratio(term.node) * speed);
      content_[l] = {
          term.node, r.torque, r.dtorque_dangle, r.dtorque_dspeed, std::vector<Complex>(orders_.size()),
          0.0,       0.0};
    } else if (source.harmonics) {
      content_[l] = of_harmonics(term);
    } else if (source.table) {
      content_[l] = of_table(term);
    } else if (no_slope && source.scaled) {
      find_curves(l, speed);
      sum_curves(l);
    } else {
      content_[l] = of_samples(term, source, speed);
    }
  }
  if (!findings.empty()) {
    for (Source& source : sources_) source.known = false;
    for (Finding& finding : findings)
      finding.place += ", at " + rounded_text(to_rpm(std::abs(speed)), 9) + " rpm";
    throw ModelError(std::move(findings));
  }
  speed_ = speed;
  return content_;
}

void OrderContent::add_slopes(double speed, Vector* damping, Vector* stiffness) {
  for (const Content& load : at(speed)) {
    const NodeMap& map = system_.node_map(load.node);
    if (map.unknown < 0) continue;
    const auto slot = system_.diagonal_slots()[idx(map.unknown)];
    if (damping) (*damping)[slot] -= map.coeff * map.coeff * load.speed_slope;
    if (stiffness) (*stiffness)[slot] -= map.coeff * map.coeff * load.angle_slope;
  }
}

double reference_direction(const System& system) {
  if (!system.reference()) return 1.0;
  const double rate = system.reference()->at(0.0).rate;
  constexpr double kLater = 1e9;  // time at which a run-up from rest has ended [s]
  return rate < 0.0 || (rate == 0.0 && system.reference()->at(kLater).rate < 0.0) ? -1.0 : 1.0;
}

}  // namespace drev
