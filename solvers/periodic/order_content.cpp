#include "solvers/periodic/order_content.hpp"

#include <drev/core/law/speed_scaled_load.hpp>
#include <drev/core/load.hpp>
#include <drev/core/units.hpp>

#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/FFT>

namespace drev {

namespace {

using Complex = std::complex<double>;

constexpr double kWholeLine = 1e-9;
constexpr double kSettled = 1e-9;  // of the largest amplitude
constexpr double kSame = 1e-12;    // of the largest torque: the load is one and the same
constexpr double kNoLine = 1e-13;  // of the rms: rounding of the transform
constexpr int kProbes = 24;        // angles at which a load is asked whether time, speed and turns matter
constexpr int kFewestSamples = 256, kMostSamples = 1 << 16;

LoadResponse at_angle(const LoadTerm& term, double angle, double speed, double t = 0.0,
                      double deviation = 0.0) {
  return term.load->evaluate(
      {.t = t, .nominal_angle = angle, .deviation = deviation, .speed = speed, .nominal_speed = speed});
}

/// Angles that no even division of a turn hits.
double probe_angle(int i) { return 0.37 + 0.911 * i; }

/// Largest difference between two ways to ask a load, over its largest torque; slopes count too.
template <class First, class Second>
bool same_everywhere(const First& first, const Second& second) {
  double size = 0.0, difference = 0.0;
  for (int i = 0; i < kProbes; ++i) {
    const LoadResponse a = first(probe_angle(i)), b = second(probe_angle(i));
    size = std::max({size, std::abs(a.torque), std::abs(b.torque)});
    difference = std::max(difference, std::abs(a.torque - b.torque));
  }
  return difference <= kSame * size;
}

}  // namespace

OrderContent::OrderContent(const System& system, std::vector<double> orders, std::vector<Finding>& findings)
    : system_(system), orders_(std::move(orders)) {
  const double some_speed = system.reference_speed() > 0.0 ? system.reference_speed() : 1.0;
  for (const LoadTerm& term : system.loads()) {
    if (system.node_map(term.node).prescribed >= 0) continue;  // carried by the reaction
    const std::string place = system.name() + "/" + system.element_instances()[idx(index(term.element))].name;
    const double ratio = system.ratio(term.node), speed = ratio * some_speed;
    const auto now = [&](double angle) { return at_angle(term, angle, speed); };
    const auto refuse = [&](const std::string& why) { findings.push_back({place, "", "", "", why}); };
    Source source;
    bool in_time = !term.load->frequencies().empty() || !term.load->breakpoints().empty();
    for (const double t : {0.0173, 0.291, 1.37, 11.3, 97.7})
      in_time = in_time || !same_everywhere(now, [&](double a) { return at_angle(term, a, speed, t); });
    if (in_time) {
      refuse(
          "is a function of the time and has no orders; a sweep takes loads that follow the angle, such as "
          "engine_order_torque and cam_torque, and constant ones");
      continue;
    }
    for (const double factor : {0.5, 1.7, 3.1})
      source.follows_speed = source.follows_speed || !same_everywhere(now, [&](double a) {
                               return at_angle(term, a, factor * speed);
                             });
    follows_speed_ = follows_speed_ || source.follows_speed;
    source.constant =
        ratio == 0.0 || same_everywhere(now, [&](double) { return at_angle(term, 0.0, speed); });
    if (ratio == 0.0 && !same_everywhere(now, [&](double) { return at_angle(term, 0.0, speed); })) {
      refuse("follows the angle of " + system.node_names()[idx(term.node)] +
             ", which does not turn with the reference shaft");
      continue;
    }
    if (!source.constant && !term.load->table()) {
      bool repeats = false;
      for (const int turns : {1, 2, 3, 4, 5, 6, 8, 10, 12, 15, kMostTurns}) {
        repeats = same_everywhere(now, [&](double a) { return at_angle(term, a + turns * kTwoPi, speed); });
        // Rounding of the angle itself moves a steep load by more than its own rounding.
        if (!repeats) continue;
        source.turns = turns;
        break;
      }
      if (!repeats) {
        refuse("does not repeat within " + std::to_string(kMostTurns) + " turns of its node");
        continue;
      }
    }
    constexpr double kTurned = 0.3;  // rad
    source.by_angle = same_everywhere([&](double a) { return at_angle(term, a + kTurned, speed); },
                                      [&](double a) { return at_angle(term, a, speed, 0.0, kTurned); });
    loads_.push_back(&term);
    sources_.push_back(source);
  }
  content_.resize(loads_.size());
}

/// lines: of the node's own angle, forward; spacing: order of line 1 a turn of the reference shaft.
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
  // Only the lines that are asked for.
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

OrderContent::Content OrderContent::of_samples(const LoadTerm& term, Source& source, double speed) const {
  const double ratio = system_.ratio(term.node);
  const double spacing = std::abs(ratio) / source.turns;
  const double highest = orders_.empty() ? 1.0 : *std::max_element(orders_.begin(), orders_.end());
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  std::vector<double> torque;
  std::vector<Complex> lines;
  const auto content_with = [&](int samples) {
    Content content;
    content.node = term.node;
    double steepest = 0.0;
    torque.resize(static_cast<std::size_t>(samples));
    double square = 0.0;
    for (int i = 0; i < samples; ++i) {
      const LoadResponse r = at_angle(term, source.turns * kTwoPi * i / samples, ratio * speed);
      torque[static_cast<std::size_t>(i)] = r.torque;
      content.mean += r.torque / samples;
      content.angle_slope += r.dtorque_dangle / samples;
      content.speed_slope += r.dtorque_dspeed / samples;
      steepest = std::max(steepest, std::abs(r.dtorque_dangle));
    }
    // What repeats with the angle itself, nominal and deviation alike, has no mean slope; samples of a curve with
    // kinks have.
    if (source.by_angle || std::abs(content.angle_slope) <= kSettled * steepest) content.angle_slope = 0.0;
    for (const double value : torque) square += (value - content.mean) * (value - content.mean) / samples;
    content.rms = std::sqrt(square);
    fft.fwd(lines, torque);
    lines.resize(static_cast<std::size_t>(samples) / 2);  // without the one at half of the sampling rate
    for (Complex& line : lines) line *= 2.0 / samples;
    pick(lines, spacing, ratio > 0.0, content);
    return content;
  };
  if (source.samples > 0) return content_with(source.samples);
  int samples = kFewestSamples;
  while (samples < 8.0 * highest / spacing && samples < kMostSamples) samples *= 2;
  Content content = content_with(samples);
  while (samples < kMostSamples) {
    Content finer = content_with(2 * samples);
    double size = 0.0, difference = 0.0;
    for (std::size_t k = 0; k < orders_.size(); ++k) {
      size = std::max(size, std::abs(finer.amplitudes[k]));
      difference = std::max(difference, std::abs(finer.amplitudes[k] - content.amplitudes[k]));
    }
    difference = std::max(difference, std::abs(finer.mean - content.mean));
    if (difference <= kSettled * std::max({size, std::abs(finer.mean), finer.rms})) break;
    content = std::move(finer);
    samples *= 2;
  }
  source.samples = samples;
  return content;
}

OrderContent::Content OrderContent::of_curves(const LoadTerm& term, Source& source, double speed) const {
  const auto& load = dynamic_cast<const SpeedScaledLoad&>(*term.load);
  const double ratio = system_.ratio(term.node), spacing = std::abs(ratio) / source.turns;
  const std::vector<double> factors = load.speed_factors(ratio * speed);
  const auto count = static_cast<Eigen::Index>(factors.size());
  if (source.curves.empty()) {
    Eigen::MatrixXd values(kMostSamples, count);
    Eigen::FFT<double> fft;
    fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
    std::vector<Complex> lines;
    std::vector<double> column(static_cast<std::size_t>(kMostSamples));
    for (Eigen::Index k = 0; k < count; ++k) {
      Content content;
      for (int i = 0; i < kMostSamples; ++i)
        values(i, k) = load.curve(static_cast<int>(k), source.turns * kTwoPi * i / kMostSamples);
      content.mean = values.col(k).mean();
      values.col(k).array() -= content.mean;
      content.rms = std::sqrt(values.col(k).squaredNorm() / kMostSamples);
      std::copy_n(values.col(k).data(), kMostSamples, column.begin());
      fft.fwd(lines, column);
      lines.resize(static_cast<std::size_t>(kMostSamples) / 2);
      for (Complex& line : lines) line *= 2.0 / kMostSamples;
      pick(lines, spacing, ratio > 0.0, content);
      source.curves.push_back(std::move(content));
    }
    source.products = values.transpose() * values / kMostSamples;
  }
  Content sum;
  sum.node = term.node;
  sum.amplitudes.assign(orders_.size(), 0.0);
  const Eigen::Map<const Vector> f(factors.data(), count);
  sum.rms = std::sqrt(std::max(0.0, f.dot(source.products * f)));
  double taken = 0.0;
  const auto curve = [&](Eigen::Index k) -> const Content& {
    return source.curves[static_cast<std::size_t>(k)];
  };
  for (Eigen::Index k = 0; k < count; ++k) sum.mean += f[k] * curve(k).mean;
  for (std::size_t o = 0; o < orders_.size(); ++o) {
    for (Eigen::Index k = 0; k < count; ++k) sum.amplitudes[o] += f[k] * curve(k).amplitudes[o];
    taken += 0.5 * std::norm(sum.amplitudes[o]);
  }
  sum.left_out = std::sqrt(std::max(0.0, sum.rms * sum.rms - taken));
  if (sum.left_out < 1e-7 * sum.rms) sum.left_out = 0.0;
  return sum;
}

const std::vector<OrderContent::Content>& OrderContent::at(double speed) {
  for (std::size_t l = 0; l < loads_.size(); ++l) {
    Source& source = sources_[l];
    if (source.known) continue;
    const LoadTerm& term = *loads_[l];
    if (source.constant) {
      const LoadResponse r = at_angle(term, 0.0, system_.ratio(term.node) * speed);
      content_[l] = {
          term.node, r.torque, r.dtorque_dangle, r.dtorque_dspeed, std::vector<Complex>(orders_.size()),
          0.0,       0.0};
    } else {
      const bool no_slope = source.by_angle || !term.load->depends_on_motion();
      const bool scaled = no_slope && dynamic_cast<const SpeedScaledLoad*>(term.load) != nullptr;
      content_[l] = term.load->table() ? of_table(term)
                    : scaled           ? of_curves(term, source, speed)
                                       : of_samples(term, source, speed);
    }
    source.known = !source.follows_speed;
  }
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
  constexpr double kLater = 1e9;  // s: a run-up from rest has ended
  return rate < 0.0 || (rate == 0.0 && system.reference()->at(kLater).rate < 0.0) ? -1.0 : 1.0;
}

}  // namespace drev
