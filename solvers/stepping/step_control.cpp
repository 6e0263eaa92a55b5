#include "solvers/stepping/step_control.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace drev {

namespace {
constexpr double kSafety = 0.9;
constexpr double kLeastFactor = 0.2, kLargestFactor = 4.0;
constexpr double kFailureFactor = 0.25;
constexpr double kRounding = 8 * std::numeric_limits<double>::epsilon();
constexpr double kRateRounding = std::numeric_limits<double>::epsilon();  // rounding of v_1 - v_0
constexpr double kTooShort = 0.05;                                        // E with which the step grows
constexpr double kFallen = 0.5;                                           // part of E that is less
constexpr double kLeastError = 1e-6;                                      // as far as the controller looks
}  // namespace

StepControl::StepControl(const System& system, const Options& options)
    : system_(system), options_(options), kind_(static_cast<std::size_t>(system.size()), 0) {
  for (int node = 0; node < system.node_count(); ++node) {
    const NodeMap& map = system.node_map(node);
    if (map.unknown < 0) continue;
    kind_[idx(map.unknown)] = system.node_kind(node) == NodeKind::translational;
  }
  const Vector& direction = system.nominal_direction();
  if (system.rigid_mode_count(Contact::closed) == 1 && direction.norm() > 0.0 &&
      system.elastic_mode_count() > 0)
    rigid_ = direction.normalized();
  stiffness_.setZero(system.size());
  law_forces_.setZero(system.size());
  for (Eigen::Index i = 0; i < stiffness_.size(); ++i)
    stiffness_[i] = system.stiffness_values()[system.diagonal_slots()[static_cast<std::size_t>(i)]];
  for (const ScalarTerm& term : system.scalars())
    for (const Entry& e : term.z)
      stiffness_[e.index] += std::abs(term.force->closed_stiffness()) * e.coeff * e.coeff;
  set(options.first);
}

void StepControl::set(double h) {
  if (options_.on_grid) h = std::exp2(0.25 * std::floor(4.0 * std::log2(h) + 1e-9));
  h_ = std::min(h, options_.largest);
}

StepControl::Scales StepControl::with(const State& state, double part) const {
  Scales s = scales_;
  const bool floats = rigid_.size() > 0;
  const double c_z = floats ? rigid_.dot(state.z) : 0.0, c_v = floats ? rigid_.dot(state.v) : 0.0;
  for (Eigen::Index i = 0; i < state.z.size(); ++i) {
    const double r = floats ? rigid_[i] : 0.0;
    const std::size_t kind = static_cast<std::size_t>(kind_[static_cast<std::size_t>(i)]);
    s.z[kind] = std::max(s.z[kind], part * std::abs(state.z[i] - c_z * r));
    s.v[kind] = std::max(s.v[kind], part * std::abs(state.v[i] - c_v * r));
  }
  return s;
}

double StepControl::next(double remaining) const {
  if (h_ >= remaining * (1.0 - 1e-9)) return remaining;
  return h_ > 0.5 * remaining ? 0.5 * remaining : h_;
}

double StepControl::error(const State& end, const Vector& e_z, const Vector& e_v, double h) {
  const Scales s = with(end, 1.0);
  const int* outer = system_.pattern().outerIndexPtr();
  const int* inner = system_.pattern().innerIndexPtr();
  const double share = h * options_.tolerance / options_.duration;
  law_forces_.setZero();
  for (const ScalarTerm& term : system_.scalars()) {
    double size = 0.0;
    for (const Entry& e : term.z) size += std::abs(e.coeff * end.z[e.index]);
    size *= std::abs(term.force->closed_stiffness());
    for (const Entry& e : term.z) law_forces_[e.index] += std::abs(e.coeff) * size;
  }
  // beyond_rounding, beyond_solved: what exceeds the rounding of forces on the bare inertia, and on what an implicit step
  // sets against them, about J + h/4 C + h^2/16 K. Long beside a stiff mode the first is more than the step leaves of it.
  double worst = 0.0, beyond_rounding = 0.0, beyond_solved = 0.0;
  const auto take = [&](double e, double rounding, double solved, double scale) {
    if (!(scale > 0.0)) return;
    worst = std::max(worst, e / scale);
    beyond_rounding = std::max(beyond_rounding, (e - rounding) / scale);
    beyond_solved = std::max(beyond_solved, (e - solved) / scale);
  };
  for (Eigen::Index i = 0; i < e_z.size(); ++i) {
    if (!std::isfinite(e_z[i]) || !std::isfinite(e_v[i])) return std::numeric_limits<double>::infinity();
    double force = law_forces_[i];  // of z, and of (z_1 - z_0)/h as a rate
    for (int k = outer[i]; k < outer[i + 1]; ++k)
      force += (std::abs(system_.stiffness_values()[k]) + 2.0 / h * std::abs(system_.damping_values()[k])) *
               std::abs(end.z[inner[k]]);
    const auto unknown = static_cast<std::size_t>(i);
    const int slot = system_.diagonal_slots()[unknown];
    const double inertia = system_.mass_values()[slot];
    const double solved =
        inertia + 0.25 * h * system_.damping_values()[slot] + 0.0625 * h * h * stiffness_[i];
    const double of_z = kRounding * std::abs(end.z[i]), of_v = kRateRounding * std::abs(end.v[i]);
    const double of_force = kRounding * h * force;
    const auto kind = static_cast<std::size_t>(kind_[unknown]);
    take(std::abs(e_z[i]), of_z, of_z, s.z[kind]);
    take(std::abs(e_v[i]), of_v + of_force / inertia, of_v + of_force / solved, s.v[kind]);
  }
  const bool rounding = worst > share ? beyond_rounding <= share : beyond_solved <= kTooShort * share;
  return rounding ? std::min(kTooShort, worst / share) : worst / share;
}

void StepControl::accepted(double h, double error, bool as_planned) {
  const double q = options_.order, e = std::max(error, kLeastError);
  double factor = kSafety * std::pow(e, -0.7 / q) * std::pow(last_error_, 0.4 / q);
  factor = std::clamp(factor, kLeastFactor, after_rejection_ ? 1.0 : kLargestFactor);
  after_rejection_ = false;
  // A step that was cut says little about longer ones.
  if (!as_planned) return set(std::max(h * factor, h_));
  last_error_ = e;
  const bool shorter_helps = e <= 1.0 || e < kFallen * last_above_;
  last_above_ = e > 1.0 ? e : 0.0;
  set(shorter_helps ? h * factor : std::max(h, h * factor));
}

void StepControl::rejected(double h, double error) {
  const double q = options_.order;
  after_rejection_ = true;
  last_above_ = error;
  set(h * std::clamp(kSafety * std::pow(error, -1.0 / q), kLeastFactor, 0.8));
}

void StepControl::failed(double h) {
  after_rejection_ = true;
  set(kFailureFactor * h);
}

void StepControl::shorten(double h) {
  after_rejection_ = true;
  set(0.5 * h);
}

}  // namespace drev
