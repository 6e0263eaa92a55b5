#include "solvers/speed_hold.hpp"

#include <drev/core/assembler.hpp>

#include <cmath>

#include "solvers/at_speed.hpp"
#include "solvers/periodic/mean_equilibrium.hpp"

namespace drev {

namespace {

constexpr double kCorrected = 0.5;  // part of the unbalanced torque that is taken up after a cycle
constexpr double kErrors = 10.0;    // tolerances that the error of a cycle's change of speed may be

}  // namespace

std::vector<FloatingPart> floating_parts_of(const System& system, const MeanEquilibrium& mean) {
  std::vector<FloatingPart> parts(mean.floating().size());
  for (std::size_t f = 0; f < parts.size(); ++f)
    if (system.ratio(system.node(mean.floating()[f])) != 0.0) parts[f] = {mean.rigid()[f], mean.balance()[f]};
  return parts;
}

SpeedHold::SpeedHold(const System& system, std::vector<FloatingPart> parts)
    : system_(system), speed_(system.reference() ? system.reference()->at(0.0).rate : 0.0) {
  const Assembler assembler(system);
  for (FloatingPart& of : parts) {
    Part& part = parts_.emplace_back();
    part.of = std::move(of);
    if (part.of.rigid.size() == 0) continue;
    const Vector inertia = assembler.product(system.mass_values(), part.of.rigid);
    part.inertia = part.of.rigid.dot(inertia);
    part.momentum = inertia / part.inertia;
    part.moves = value_along(part.of.balance, part.of.rigid);
  }
}

void SpeedHold::begin_cycle(const State& state) {
  for (Part& part : parts_) {
    if (part.inertia == 0.0) continue;
    part.angle = part.momentum.dot(state.z);
    part.rate = part.momentum.dot(state.v);
  }
}

Vector SpeedHold::end_cycle(State& state, double period, double tolerance) {
  Vector left = Vector::Zero(static_cast<Eigen::Index>(parts_.size()));
  Vector forces = Vector::Zero(system_.size());
  bool changed = false;
  for (std::size_t f = 0; f < parts_.size(); ++f) {
    Part& part = parts_[f];
    if (part.inertia == 0.0) continue;
    const double turned = part.momentum.dot(state.z) - part.angle, rate = part.momentum.dot(state.v);
    const double excess = part.inertia * (rate - part.rate) / period, over = excess - part.torque;
    const double least = kErrors * tolerance * part.inertia * std::abs(speed_) / period;
    if (std::abs(over) > least) left[static_cast<Eigen::Index>(f)] = over;
    const double change = std::abs(excess) > least ? -kCorrected * excess : 0.0;
    changed = changed || change != 0.0;
    const double begins = part.rate - turned / period - 0.5 * change / part.inertia * period;
    part.torque += change;
    if (part.of.balance.empty()) forces += part.torque * part.momentum;
    for (const Entry& e : part.of.balance) forces[e.index] += e.coeff * part.torque / part.moves;
    state.z -= turned * part.of.rigid;
    state.v += (begins - rate) * part.of.rigid;
  }
  if (changed) balanced_.emplace(at_speed(system_, speed_, forces));
  return left;
}

}  // namespace drev
