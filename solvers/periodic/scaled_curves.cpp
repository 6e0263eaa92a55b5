// Orders of a load whose torque is a sum of curves scaled by the speed (SpeedScaledLoad).
#include <drev/core/law/knotted_load.hpp>
#include <drev/core/law/law_force.hpp>
#include <drev/core/law/speed_scaled_load.hpp>
#include <drev/core/load.hpp>
#include <drev/core/units.hpp>

#include <algorithm>
#include <cmath>

#include "core/dense/fourier.hpp"
#include "solvers/periodic/order_content.hpp"

namespace drev {

namespace {

using Complex = std::complex<double>;

// Widest panel of the quadrature [rad of the node], and largest phase of the highest order over a panel
// [rad].
constexpr double kWidestPanel = 0.35, kPanelPhase = 2.5;

}  // namespace

/// Finds the curves of a load whose torque is a sum of curves scaled by the speed: from another load of its
/// family by rotation, by integration between their knots, or from samples.
void OrderContent::find_curves(std::size_t load, double speed) {
  Source& source = sources_[load];
  if (!source.curves.empty()) return;
  const LoadTerm& term = *loads_[load];
  const auto& scaled = dynamic_cast<const SpeedScaledLoad&>(*term.load);
  const double ratio = system_.ratio(term.node);
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
  int samples = fewest_samples(source, spacing);
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
void OrderContent::sum_curves(std::size_t load) {
  Source& source = sources_[load];
  Content& sum = content_[load];
  const LoadTerm& term = *loads_[load];
  const bool first = source.relative < 0;
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

}  // namespace drev
