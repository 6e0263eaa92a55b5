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

#include "core/dense/fourier.hpp"

namespace drev {

namespace {

using Complex = std::complex<double>;

constexpr double kWholeLine = 1e-9;
constexpr double kSettled = 1e-9;  // error relative to the largest amplitude (or slope) [-]
constexpr double kSame = 1e-12;    // difference over the largest torque up to which loads are equal [-]
constexpr double kNoLine = 1e-13;  // amplitude relative to the rms that is rounding of the transform [-]
constexpr int kProbes = 24;        // number of angles at which dependence on time, speed and turns is tested
// Widest panel of the quadrature [rad of the node], and largest phase of the highest order over a panel
// [rad].
constexpr double kWidestPanel = 0.35, kPanelPhase = 2.5;
constexpr int kFewestSamples = 256, kMostSamples = 1 << 16;

LoadResponse at_angle(const LoadTerm& term, double angle, double speed, double t = 0.0,
                      double deviation = 0.0) {
  return term.load->evaluate(
      {.t = t, .nominal_angle = angle, .deviation = deviation, .speed = speed, .nominal_speed = speed});
}

/// Angles that no division of a turn into equal parts hits [rad].
double probe_angle(int i) { return 0.37 + 0.911 * i; }

}  // namespace

OrderContent::OrderContent(const System& system, std::vector<double> orders, std::vector<Finding>& findings)
    : system_(system), orders_(std::move(orders)) {
  for (const LoadTerm& term : system.loads()) {
    if (system.node_map(term.node).prescribed >= 0) continue;  // the reaction carries it
    Source source;
    if (const Source* relative = family_source(term)) {
      source = *relative;
      source.scaled = dynamic_cast<const SpeedScaledLoad*>(term.load);
      source.relative = static_cast<int>(relative - sources_.data());
    } else if (!inspect(term, source, findings))
      continue;
    follows_speed_ = follows_speed_ || source.follows_speed;
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

bool OrderContent::inspect(const LoadTerm& term, Source& source, std::vector<Finding>& findings) const {
  const std::string place = system_.name() + "/" + system_.element_instances()[idx(index(term.element))].name;
  const auto refuse = [&](const std::string& why) {
    findings.push_back({place, "", "", "", why});
    return false;
  };
  const double some_speed = system_.reference_speed() > 0.0 ? system_.reference_speed() : 1.0;
  const double ratio = system_.ratio(term.node), speed = ratio * some_speed;
  const std::string does_not_turn = "follows the angle of " + system_.node_names()[idx(term.node)] +
                                    ", which does not turn with the reference shaft";
  if (const auto* harmonics = dynamic_cast<const HarmonicLoad*>(term.load)) {
    source.constant = harmonics->orders().terms.empty();
    source.by_angle = source.harmonics = true;
    return source.constant || ratio != 0.0 || refuse(does_not_turn);
  }
  const SpeedScaledLoad* scaled = source.scaled = dynamic_cast<const SpeedScaledLoad*>(term.load);
  std::array<double, kProbes> torques{};
  double size = 0.0;
  for (int i = 0; i < kProbes; ++i) {
    torques[idx(i)] = at_angle(term, probe_angle(i), speed).torque;
    size = std::max(size, std::abs(torques[idx(i)]));
  }
  // Whether another way to evaluate the load gives the same torques, to rounding of the largest.
  const auto same = [&](const auto& other) {
    for (int i = 0; i < kProbes; ++i)
      if (std::abs(other(probe_angle(i)).torque - torques[idx(i)]) > kSame * size) return false;
    return true;
  };
  bool in_time = !term.load->frequencies().empty() || !term.load->breakpoints().empty();
  for (const double t : {0.0173, 0.291, 1.37, 11.3, 97.7})
    in_time = in_time || (!scaled && !same([&](double a) { return at_angle(term, a, speed, t); }));
  if (in_time)
    return refuse(
        "is a function of the time and has no orders; a sweep takes loads that follow the angle, such as "
        "engine_order_torque and cam_torque, and constant ones");
  for (const double factor : {0.5, 1.7, 3.1})
    source.follows_speed = source.follows_speed ||
                           (scaled ? scaled->speed_factors(factor * speed) != scaled->speed_factors(speed)
                                   : !same([&](double a) { return at_angle(term, a, factor * speed); }));
  const bool standing = same([&](double) { return at_angle(term, 0.0, speed); });
  source.constant = ratio == 0.0 || standing;
  if (ratio == 0.0 && !standing) return refuse(does_not_turn);
  source.table = term.load->table().has_value();
  if (!source.constant && !source.table) {
    bool repeats = false;
    for (const int turns : {1, 2, 3, 4, 5, 6, 8, 10, 12, 15, kMostTurns}) {
      repeats = same([&](double a) { return at_angle(term, a + turns * kTwoPi, speed); });
      // Rounding of the angle changes a steep load by more than the rounding of its torque.
      if (!repeats) continue;
      source.turns = turns;
      break;
    }
    if (!repeats)
      return refuse("does not repeat within " + std::to_string(kMostTurns) + " turns of its node");
  }
  constexpr double kTurned = 0.3;  // rad
  source.by_angle = same([&](double a) { return at_angle(term, a - kTurned, speed, 0.0, kTurned); });
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

int OrderContent::fewest_samples(double spacing) const {
  const double highest = orders_.empty() ? 1.0 : orders_.back();
  int samples = kFewestSamples;
  while (samples < 8.0 * highest / spacing && samples < kMostSamples) samples *= 2;
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
    // A load that repeats with the angle, nominal angle and deviation alike, has no mean slope, but the
    // samples of a curve with kinks have one.
    if (source.by_angle || std::abs(content.angle_slope) <= kSettled * steepest) content.angle_slope = 0.0;
    for (const double value : torque) square += (value - content.mean) * (value - content.mean) / samples;
    content.rms = std::sqrt(square);
    transform.forward(lines, torque);
    lines.resize(static_cast<std::size_t>(samples) / 2);  // without the Nyquist line
    for (Complex& line : lines) line *= 2.0 / samples;
    pick(lines, spacing, ratio > 0.0, content);
    return content;
  };
  if (source.samples > 0) return content_with(source.samples);
  int samples = fewest_samples(spacing);
  Content content = content_with(samples);
  while (samples < kMostSamples) {
    Content finer = content_with(2 * samples);
    if (difference(content, finer) <= kSettled) break;
    content = std::move(finer);
    samples *= 2;
  }
  source.samples = samples;
  return content;
}

/// Finds the curves of a load whose torque is a sum of curves scaled by the speed: from another load of its
/// family by rotation, by integration between their knots, or from samples.
void OrderContent::find_curves(std::size_t load, double speed) {
  Source& source = sources_[load];
  if (!source.curves.empty()) return;
  const LoadTerm& term = *loads_[load];
  const auto& scaled = dynamic_cast<const SpeedScaledLoad&>(*term.load);
  const double ratio = system_.ratio(term.node);
  if (source.relative >= 0 && sources_[idx(source.relative)].curves.empty()) source.relative = -1;
  if (source.relative >= 0) {
    const Source& relative = sources_[idx(source.relative)];
    const double behind = scaled.family().start - relative.scaled->family().start;
    source.curves = relative.curves;
    for (std::size_t k = 0; k < orders_.size(); ++k) {
      const Complex turned = std::polar(1.0, -orders_[k] / ratio * behind);
      for (Content& curve : source.curves) curve.amplitudes[k] *= turned;
    }
    return;
  }
  const auto count = static_cast<Eigen::Index>(scaled.speed_factors(ratio * speed).size());
  if (!integrate_curves(term, source, ratio * speed, count)) sample_curves(term, source, count);
}

bool OrderContent::integrate_curves(const LoadTerm& term, Source& source, double speed,
                                    Eigen::Index count) const {
  const auto* knotted = dynamic_cast<const KnottedLoad*>(term.load);
  const auto& load = dynamic_cast<const SpeedScaledLoad&>(*term.load);
  if (!knotted) return false;
  const double ratio = system_.ratio(term.node), period = source.turns * kTwoPi;
  const double highest = orders_.empty() ? 0.0 : orders_.back() / std::abs(ratio);
  const double widest = std::min(kWidestPanel, kPanelPhase / std::max(highest, kPanelPhase));
  // Only waves with a whole number of periods: a load that repeats contains no others.
  std::vector<std::pair<std::size_t, double>> waves;  // number of the order, order of the node's angle
  for (std::size_t k = 0; k < orders_.size(); ++k) {
    const double order = orders_[k] / std::abs(ratio), line = std::round(order * source.turns);
    if (line >= 1.0 && std::abs(order * source.turns - line) <= kWholeLine * line)
      waves.emplace_back(k, line / source.turns);
  }
  Vector means = Vector::Zero(count), values(count);
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(count, count);
  Eigen::MatrixXcd sums = Eigen::MatrixXcd::Zero(count, static_cast<Eigen::Index>(waves.size()));
  const auto point = [&](double angle, double weight) {
    for (Eigen::Index k = 0; k < count; ++k) values[k] = load.curve(static_cast<int>(k), angle);
    means += weight * values;
    products.noalias() += weight * values * values.transpose();
    double before = 0.0, spacing = 0.0;
    Complex wave = 1.0, step = 1.0;
    for (std::size_t i = 0; i < waves.size(); ++i) {
      if (waves[i].second - before != spacing) {
        spacing = waves[i].second - before;
        step = std::polar(1.0, -spacing * angle);
      }
      wave = {wave.real() * step.real() - wave.imag() * step.imag(),
              wave.real() * step.imag() + wave.imag() * step.real()};
      before = waves[i].second;
      for (Eigen::Index k = 0; k < count; ++k)
        sums(k, static_cast<Eigen::Index>(i)) += weight * values[k] * wave;
    }
  };
  constexpr double kAhead = 1e-9;  // step past a knot that was found [rad]
  for (double at = 0.0; at < period * (1.0 - kWholeLine);) {
    const double knot = std::max(knotted->piece(at, 1.0, speed).high, at + kAhead);
    const double next = knot < period * (1.0 - kWholeLine) ? knot : period;
    const int panels = static_cast<int>(std::ceil((next - at) / widest));
    const double half = 0.5 * (next - at) / panels;
    for (int p = 0; p < panels; ++p)
      for (std::size_t g = 0; g < kGaussPoints.size(); ++g)
        for (const double side : {-1.0, 1.0})
          point(at + half * (2 * p + 1 + side * kGaussPoints[g]), half * kGaussWeights[g] / period);
    at = next;
  }
  for (Eigen::Index k = 0; k < count; ++k) {
    Content content;
    content.mean = means[k];
    content.amplitudes.assign(orders_.size(), 0.0);
    content.rms = std::sqrt(std::max(0.0, products(k, k) - means[k] * means[k]));
    for (std::size_t i = 0; i < waves.size(); ++i) {
      const Complex c = 2.0 * sums(k, static_cast<Eigen::Index>(i));
      if (std::abs(c) > kNoLine * content.rms)
        content.amplitudes[waves[i].first] = ratio > 0.0 ? c : std::conj(c);
    }
    source.curves.push_back(std::move(content));
  }
  source.products = products - means * means.transpose();
  return true;
}

void OrderContent::sample_curves(const LoadTerm& term, Source& source, Eigen::Index count) const {
  const auto& load = dynamic_cast<const SpeedScaledLoad&>(*term.load);
  const double ratio = system_.ratio(term.node), spacing = std::abs(ratio) / source.turns;
  FourierTransform transform;
  Eigen::MatrixXd values;
  const auto curves_with = [&](int samples) {
    std::vector<Content> curves;
    std::vector<Complex> lines;
    std::vector<double> column(static_cast<std::size_t>(samples));
    const Eigen::MatrixXd half = std::move(values);  // every second new sample, except the first time
    values.resize(samples, count);
    for (Eigen::Index k = 0; k < count; ++k)
      for (int i = 0; i < samples; ++i)
        values(i, k) = half.size() > 0 && i % 2 == 0
                           ? half(i / 2, k)
                           : load.curve(static_cast<int>(k), source.turns * kTwoPi * i / samples);
    const Eigen::RowVectorXd means = values.colwise().mean();
    const Eigen::MatrixXd vary = values.rowwise() - means;
    for (Eigen::Index k = 0; k < count; ++k) {
      Content content;
      content.mean = means[k];
      content.rms = std::sqrt(vary.col(k).squaredNorm() / samples);
      std::copy_n(vary.col(k).data(), samples, column.begin());
      transform.forward(lines, column);
      lines.resize(static_cast<std::size_t>(samples) / 2);
      for (Complex& line : lines) line *= 2.0 / samples;
      pick(lines, spacing, ratio > 0.0, content);
      curves.push_back(std::move(content));
    }
    source.products = vary.transpose() * vary / samples;
    return curves;
  };
  int samples = fewest_samples(spacing);
  source.curves = curves_with(samples);
  while (samples < kMostSamples) {
    samples *= 2;
    const std::vector<Content> coarse = std::move(source.curves);
    source.curves = curves_with(samples);
    bool settled = true;
    for (std::size_t k = 0; k < coarse.size(); ++k)
      settled = settled && difference(coarse[k], source.curves[k]) <= kSettled;
    if (settled) break;
  }
}

/// The content of the load at a speed: the sum of its scaled curves. Loads of a family differ in phase only.
void OrderContent::sum_curves(std::size_t load, double speed) {
  Source& source = sources_[load];
  Content& sum = content_[load];
  const LoadTerm& term = *loads_[load];
  const bool first = source.relative < 0;
  if (first) source.factors = source.scaled->speed_factors(system_.ratio(term.node) * speed);
  const std::vector<double>& factors = first ? source.factors : sources_[idx(source.relative)].factors;
  sum.node = term.node;
  sum.amplitudes.resize(orders_.size());
  const auto orders = static_cast<Eigen::Index>(orders_.size());
  Eigen::Map<Eigen::VectorXcd> amplitudes(sum.amplitudes.data(), orders);
  for (std::size_t k = 0; k < factors.size(); ++k) {
    const Eigen::Map<const Eigen::VectorXcd> part(source.curves[k].amplitudes.data(), orders);
    if (k == 0)
      amplitudes = factors[k] * part;
    else
      amplitudes += factors[k] * part;
  }
  if (!first) {
    const Content& same = content_[idx(source.relative)];
    sum.mean = same.mean, sum.rms = same.rms, sum.left_out = same.left_out;
    return;
  }
  sum.mean = 0.0;
  double square = 0.0;
  for (std::size_t k = 0; k < factors.size(); ++k) {
    sum.mean += factors[k] * source.curves[k].mean;
    for (std::size_t j = 0; j < factors.size(); ++j)
      square += factors[k] * factors[j] *
                source.products(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(j));
  }
  sum.rms = std::sqrt(std::max(0.0, square));
  sum.left_out = std::sqrt(std::max(0.0, sum.rms * sum.rms - 0.5 * amplitudes.squaredNorm()));
  if (sum.left_out < 1e-7 * sum.rms) sum.left_out = 0.0;
}

const std::vector<OrderContent::Content>& OrderContent::at(double speed) {
  if (speed == speed_) return content_;
  speed_ = speed;
  for (std::size_t l = 0; l < loads_.size(); ++l) {
    Source& source = sources_[l];
    if (source.known) continue;
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
      sum_curves(l, speed);
    } else {
      content_[l] = of_samples(term, source, speed);
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
  constexpr double kLater = 1e9;  // time at which a run-up from rest has ended [s]
  return rate < 0.0 || (rate == 0.0 && system.reference()->at(kLater).rate < 0.0) ? -1.0 : 1.0;
}

}  // namespace drev
