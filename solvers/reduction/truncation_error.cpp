#include "solvers/reduction/truncation_error.hpp"

#include <drev/solvers/modes/modes.hpp>

#include <algorithm>
#include <cmath>

#include "core/dense/factorization.hpp"

namespace drev {

namespace {

constexpr double kInSpan = 1e-9;  // part of a mode's kinetic energy that may lie outside the reduced space
constexpr double kOfLinear = 1.5, kOfContacts = 2.0;  // factors of the estimate
constexpr int kFollowed = 20;

/// Over h [s] of z'' + d z' + w2 z = f_0 + (f_1 - f_0) t/h.
void advance(double w2, double d, double f_0, double f_1, double h, double& z, double& v) {
  const double slope = (f_1 - f_0) / (h * w2), base = f_0 / w2 - d * slope / w2;
  const double delta = 0.5 * d, rest = w2 - delta * delta;
  const double a = z - base, b = v - slope;
  if (!(rest > 0.0)) {  // overdamped: it follows
    z = base + slope * h;
    v = slope;
    return;
  }
  const double w = std::sqrt(rest), decay = std::exp(-delta * h);
  const double c = decay * std::cos(w * h), s = decay * std::sin(w * h) / w;
  z = base + slope * h + a * (c + delta * s) + b * s;
  v = slope - a * w2 * s + b * (c - delta * s);
}

Vector shares(const std::vector<Entry>& row, const Eigen::MatrixXd& modes) {
  Vector sum = Vector::Zero(modes.cols());
  for (const Entry& e : row) sum += e.coeff * modes.row(e.index).transpose();
  return sum;
}

}  // namespace

bool modal_shares(const System& system, const Channel& channel, const Eigen::MatrixXd& modes, Vector& z,
                  Vector& v) {
  const int law = std::max(channel.force_of(), channel.deflection_of());
  if (law < 0 && !channel.is_linear()) return false;
  z = shares(law >= 0 ? system.scalars()[idx(law)].z : channel.z_row(), modes);
  v = shares(channel.v_row(), modes);
  if (channel.force_of() >= 0) v = z;
  return true;
}

Finding no_estimate(const std::string& place, const Channel& channel) {
  return {place, "channel", channel.name(), "",
          "is none whose error is estimated; take a deviation, a rate, a shaft's torque or a law's force or "
          "deflection"};
}

TruncationError::TruncationError(const System& full, const Reduction& reduction,
                                 const std::vector<std::string>& channels, int count)
    : full_(full), basis_(reduction.basis), assembler_(full) {
  const int elastic = full.elastic_mode_count();
  const int wanted =
      std::min(elastic, reduction.modes + (count > 0 ? count : kFollowed + 2 * reduction.modes));
  const ModeSet modes = solve_modes(full, {.count = wanted, .in_time = true});
  all_followed_ = wanted == elastic;
  // Modes that the reduced space holds leave nothing.
  const Eigen::MatrixXd& r = basis_;
  const Eigen::MatrixXd mass_r = assembler_.product(full.mass_values(), r);
  const CholeskyFactor reduced_mass(r.transpose() * mass_r);
  std::vector<int> followed;
  for (int j = 0; j < modes.count(); ++j) {
    const Vector share = mass_r.transpose() * modes.vectors.col(j);
    if (share.dot(reduced_mass.solve(share)) < 1.0 - kInSpan) followed.push_back(j);
  }
  const auto n = static_cast<Eigen::Index>(followed.size());
  modes_.resize(full.size(), n);
  lambda_.resize(n);
  for (Eigen::Index j = 0; j < n; ++j) {
    modes_.col(j) = modes.vectors.col(followed[static_cast<std::size_t>(j)]);
    lambda_[j] = std::pow(modes.omega(followed[static_cast<std::size_t>(j)]), 2);
  }
  by_mass_ = modes_.transpose() * mass_r;
  const Eigen::MatrixXd damped = assembler_.product(full.damping_values(), modes_);
  damping_ = modes_.cwiseProduct(damped).colwise().sum();
  by_damping_ = damped.transpose() * r - damping_.asDiagonal() * by_mass_;
  by_laws_ = Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(full.scalars().size()));
  for (std::size_t l = 0; l < full.scalars().size(); ++l)
    by_laws_.col(static_cast<Eigen::Index>(l)) = shares(full.scalars()[l].z, modes_);

  std::vector<Finding> findings;
  const std::vector<Channel> of_full = find_channels(full, channels);
  const std::vector<Channel> of_reduced = find_channels(reduction.system, channels);
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const Channel& channel = of_full[c];
    Watched w{.name = channels[c], .channel = of_reduced[c], .law = channel.force_of()};
    if (!modal_shares(full, channel, modes_, w.z, w.v))
      findings.push_back(no_estimate(full.name() + "/reduction error", channel));
    watched_.push_back(std::move(w));
  }
  asked_ = watched_.size();
  for (int l = 0; l < static_cast<int>(full.scalars().size()); ++l)
    if (linear_pieces(full.scalars()[idx(l)]).size() != 1)
      watched_.push_back({.law = l, .z = by_laws_.col(l), .v = by_laws_.col(l)});
  if (!findings.empty()) throw ModelError(findings);
  z_ = modes_.transpose() * assembler_.product(full.mass_values(), full.initial_deviation());
  v_ = modes_.transpose() * assembler_.product(full.mass_values(), full.initial_rate());
}

Vector TruncationError::force(const EvaluatedState& point) {
  const State& y = point.state;
  const Vector z = basis_ * y.z, v = basis_ * y.v;
  Vector p;
  assembler_.set_time(y.t);
  assembler_.external(z, v, p);
  Vector f = modes_.transpose() * p - by_damping_ * y.v;
  for (std::size_t l = 0; l < full_.scalars().size(); ++l) {
    double x = 0.0, x_dot = 0.0;
    const ScalarTerm& term = full_.scalars()[l];
    for (const Entry& e : term.z) x += e.coeff * z[e.index], x_dot += e.coeff * v[e.index];
    f -= (point.responses[l].y - term.force->closed_stiffness() * x) *
         by_laws_.col(static_cast<Eigen::Index>(l));
  }
  return f;
}

void TruncationError::start(const Assembler& assembler, const EvaluatedState& point) {
  force_ = force(point);
  watch(assembler, point);
}

void TruncationError::step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) {
  const double h = to.state.t - from.state.t;
  const Vector next = force(to);
  for (Eigen::Index j = 0; j < z_.size(); ++j)
    advance(lambda_[j], damping_[j], force_[j], next[j], h, z_[j], v_[j]);
  force_ = next;
  watch(assembler, to);
}

void TruncationError::watch(const Assembler& assembler, const EvaluatedState& point) {
  const Vector e_z = z_ - by_mass_ * point.state.z, e_v = v_ - by_mass_ * point.state.v;
  const Eigen::Index upper = z_.size() - z_.size() / 2;
  for (Watched& w : watched_) {
    const double slope = w.law >= 0 ? point.responses[idx(w.law)].dy_dx : 1.0;
    const double damper = w.law >= 0 ? point.responses[idx(w.law)].dy_dx_dot : 1.0;
    const Vector e = slope * w.z.cwiseProduct(e_z) + damper * w.v.cwiseProduct(e_v);
    const double value =
        w.channel ? w.channel->evaluate(assembler, point.state) : point.responses[idx(w.law)].y;
    w.peak = std::max(w.peak, std::abs(value));
    w.all = std::max(w.all, std::abs(e.sum()));
    w.upper = std::max(w.upper, std::abs(e.tail(upper).sum()));
  }
}

std::vector<Figure> TruncationError::estimates() const {
  const double factor = watched_.size() > asked_ ? kOfContacts : kOfLinear;
  const auto error = [&](const Watched& w) { return factor * (w.all + (all_followed_ ? 0.0 : w.upper)); };
  // Forces of laws by the roots of their energies, F^2/k.
  double worst = 0.0, largest = 0.0;
  for (std::size_t i = asked_; i < watched_.size(); ++i) {
    const Watched& w = watched_[i];
    const double k = full_.scalars()[idx(w.law)].force->closed_stiffness();
    if (!(k > 0.0)) continue;
    worst = std::max(worst, error(w) / std::sqrt(k));
    largest = std::max(largest, w.peak / std::sqrt(k));
  }
  const double of_laws = largest > 0.0 ? worst / largest : 0.0;
  std::vector<Figure> all;
  for (std::size_t i = 0; i < asked_; ++i) {
    const Watched& w = watched_[i];
    all.push_back({{w.peak, std::max(error(w), of_laws * w.peak)}, w.name, w.channel->unit(), w.peak});
  }
  return all;
}

}  // namespace drev
