#include <drev/core/units.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/modes/modes.hpp>
#include <drev/solvers/reduction/reduction_choice.hpp>
#include <drev/solvers/run/contact_statistics.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <sstream>

#include "core/dense/fourier.hpp"
#include "solvers/reduction/residual_vectors.hpp"
#include "solvers/reduction/truncation_error.hpp"

namespace drev {

namespace {

using Complex = std::complex<double>;

constexpr double kLeastGain = 1.5;
constexpr int kSamples = 1024;
constexpr int kMostModes = 80;       // modes looked at; half of them may be kept
constexpr double kDamping = 0.01;    // damping ratio, at resonance
constexpr double kStep = 25.0;       // cost of a product beside its unknowns, in unknowns
constexpr double kDensePart = 0.25;  // cost of an entry of a full matrix, in unknowns

/// Two turns of the reference shaft if it turns, else the run.
double spectrum_length(const System& system, double duration) {
  const double speed = system.reference_speed();
  return speed > 0.0 ? 2.0 * kTwoPi / speed : duration;
}

/// Estimated errors of a channel, relative, with the first m modes kept: one for each m < modes / 2.
class Predictor {
 public:
  Predictor(const System& system, const ModeSet& modes, double duration)
      : system_(system), modes_(modes), length_(spectrum_length(system, duration)) {
    const Eigen::MatrixXd loads = modes.vectors.transpose() * sampled_loads(system, length_, kSamples);
    FourierTransform transform;
    std::vector<double> samples(kSamples);
    for (Eigen::Index j = 0; loads.cols() > 0 && j < loads.rows(); ++j) {
      for (int i = 0; i < kSamples; ++i) samples[idx(i)] = loads(j, i);
      std::vector<Complex> lines;
      transform.forward(lines, samples);
      lines.resize(kSamples / 2);
      for (Complex& c : lines) c *= 2.0 / kSamples;
      lines_.push_back(std::move(lines));
      start_.push_back(std::abs(loads(j, 0)));
    }
  }

  std::vector<double> errors(const Channel& channel) const {
    Vector z, v;
    if (!modal_shares(system_, channel, modes_.vectors, z, v))
      throw ModelError({no_estimate(system_.name() + "/reduction", channel)});
    if (channel.force_of() >= 0) {
      const ScalarForce& law = *system_.scalars()[idx(channel.force_of())].force;
      z *= law.closed_stiffness();
      v *= law.closed_damping();
    }
    const int count = modes_.count();
    std::vector<double> lacks(idx(count), 0.0);
    std::vector<Complex> whole(kSamples / 2);
    for (int j = 0; j < static_cast<int>(lines_.size()); ++j) {
      const double omega = modes_.omega(j), w2 = omega * omega;
      for (std::size_t h = 0; h < whole.size(); ++h) {
        const double w = kTwoPi * static_cast<double>(h) / length_, r = w / omega;
        const Complex share = lines_[idx(j)][h] / w2 * Complex(z[j], w * v[j]) * (h == 0 ? 0.5 : 1.0);
        const Complex factor = 1.0 / Complex(1.0 - r * r, 2.0 * kDamping * r);
        whole[h] += share * factor;
        lacks[idx(j)] += std::abs(share) * std::abs(factor - 1.0);
      }
      lacks[idx(j)] += (std::abs(z[j]) + omega * std::abs(v[j])) * start_[idx(j)] / w2;
    }
    const double peak = largest(whole);
    // What lies beyond the modes looked at: as much as their upper half, unless they are all.
    const bool all = count == system_.size() - modes_.rigid_modes;
    double beyond = 0.0;
    for (int j = count / 2; j < count && !all; ++j) beyond += lacks[idx(j)];
    std::vector<double> errors(idx(count + 1), beyond);
    for (int m = count - 1; m >= 0; --m) errors[idx(m)] = errors[idx(m + 1)] + lacks[idx(m)];
    for (double& e : errors) e = peak > 0.0 ? e / peak : 0.0;
    return errors;
  }

 private:
  static double largest(const std::vector<Complex>& lines) {
    FourierTransform transform;
    std::vector<Complex> padded(kSamples / 2 + 1, 0.0);
    std::copy(lines.begin(), lines.end(), padded.begin());
    padded[0] *= 2.0;  // The inverse counts every other line twice.
    std::vector<double> values;
    transform.inverse(values, padded, kSamples);
    double most = 0.0;
    for (const double value : values) most = std::max(most, 0.5 * kSamples * std::abs(value));
    return most;
  }

  const System& system_;
  const ModeSet& modes_;
  double length_;
  std::vector<std::vector<Complex>> lines_;  // spectral lines of each mode
  std::vector<double> start_;
};

/// The highest frequency of a law that is not linear: its closed stiffness on the masses next to it [Hz].
double contact_frequency(const System& system) {
  const std::vector<double> masses = equivalent_masses(system);
  double highest = 0.0;
  for (std::size_t j = 0; j < masses.size(); ++j)
    if (masses[j] > 0.0)
      highest = std::max(highest, system.scalars()[j].force->closed_stiffness() / masses[j]);
  return to_hz(std::sqrt(highest));
}

double cost(const System& s) {
  const double n = s.size();
  return s.rows().rows() > 0 ? kStep + kDensePart * n * (n + s.loaded_rows()) : kStep + n;
}

}  // namespace

ReductionChoice choose_reduction(const System& system, double within,
                                 const std::vector<std::string>& channels, double duration) {
  std::vector<Finding> findings;
  ParameterCheck check(system.name() + "/reduction", findings);
  check.within("within", within, kReductionErrors.low, kReductionErrors.high, "");
  check.positive("duration", duration, "s");
  if (channels.empty()) check.fail("channels", "0", "", "must be at least one");
  if (!findings.empty()) throw ModelError(findings);
  ReductionChoice choice;
  const auto refuse = [&](std::string reason) {
    choice.reason = "not reduced: " + std::move(reason);
    return choice;
  };
  if (system.rows().rows() > 0) return refuse("it is a projected system already");
  if (const auto why = why_not_exact(system)) return refuse("exact propagation cannot be used: " + *why);
  const int elastic = system.elastic_mode_count();
  if (elastic < 2) return refuse("it has no mode to leave out");
  const ModeSet modes = solve_modes(system, {.count = std::min(elastic, kMostModes), .in_time = true});
  const Predictor predictor(system, modes, duration);
  std::vector<double> errors(idx(modes.count() + 1), 0.0);
  for (const Channel& channel : find_channels(system, channels)) {
    const std::vector<double> of_channel = predictor.errors(channel);
    for (std::size_t m = 0; m < errors.size(); ++m) errors[m] = std::max(errors[m], of_channel[m]);
  }
  const double contacts = contact_frequency(system) / std::pow(within, 0.25);
  int keep = 1;
  while (keep <= modes.count() / 2 &&
         (errors[idx(keep)] > within || modes.frequency_Hz[idx(keep)] < contacts))
    ++keep;
  std::ostringstream text;
  text.precision(2);
  if (keep > modes.count() / 2) {
    text << "more than " << modes.count() / 2 << " of " << elastic << " modes would be needed for "
         << 100.0 * within << " %";
    return refuse(text.str());
  }
  Reduction reduction = reduce(system, {.modes = keep, .static_accuracy = 0.5 * within});
  choice.error = errors[idx(keep)] + reduction.static_error;
  const auto work = [](const System& s) { return fastest_rate(s) * cost(s); };
  choice.gain = work(system) / work(reduction.system);
  text << choice.gain << " times the speed is predicted, and an error of " << 100.0 * choice.error << " %";
  if (choice.gain <= kLeastGain) return refuse(text.str());
  reduction.what += "; " + text.str();
  choice.reason = reduction.what;
  choice.reduction = std::move(reduction);
  return choice;
}

}  // namespace drev
